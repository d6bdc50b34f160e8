// SPDX-License-Identifier: MIT
// A compiled scene with lights of every type and a guide, for tests of guided emission.
#pragma once

#include "renderer/testing/light_paths.h"

#include <cmath>
#include <random>
#include <string>
#include <utility>
#include <vector>

#include "renderer/compile/emission_guide.h"

namespace rtrays {

/// The scene of light_scene.h, with a rectangular light before its sky.
inline CompiledScene compile_guided_scene(SphereSampling sphere_sampling = SphereSampling::cone) {
    std::string text = light_scene_text();
    text.insert(text.find(R"({"name": "sky")"),
                R"({"name": "panel", "geometry": {"type": "rectangle"}, "material": "black",
            "transform": [{"scale": [0.4, 0.3, 1]}, {"rotate": {"axis": [1, 0.4, 0.2], "degrees": 77}}, {"translate": [-0.5, 2.2, -1]}],
            "light": {"type": "diffuse_area", "radiance": [3, 5, 1]}},)");
    CompileSettings settings;
    settings.sphere_sampling = sphere_sampling;
    return compile_scene(parse_scene_json(text, "guided", "guided"), settings);
}

/// Returns the index of the rectangular light, which is the last mesh.
inline uint32_t panel_of(const CompiledScene &scene) {
    uint32_t found = light_of(scene, LIGHT_MESH);
    for (uint32_t i = found; i < scene.lights.size(); ++i) {
        found = scene.lights[i].kind == LIGHT_MESH ? i : found;
    }
    return found;
}

/// Returns moments over many orders of magnitude, some of them 0, for all lights of a scene.
inline EmissionMoments random_moments(const CompiledScene &scene, uint32_t seed) {
    std::mt19937 random(seed);
    EmissionMoments moments(scene.lights.size());
    for (size_t i = 0; i < moments.size(); ++i) {
        moments[i].resize(takes_guide_table(scene, i) ? GUIDE_BINS : 1);
        for (double &moment : moments[i]) {
            moment = random() % 8 == 0 ? 0.0 : std::exp(static_cast<double>(random() % 1000) / 160);
        }
    }
    return moments;
}

/// Returns moments with all of a light's weight in one bin.
inline EmissionMoments one_bin(const CompiledScene &scene, size_t bin) {
    EmissionMoments moments(scene.lights.size());
    for (size_t i = 0; i < moments.size(); ++i) {
        if (takes_guide_table(scene, i)) {
            moments[i].resize(GUIDE_BINS);
            moments[i][bin] = 1;
        }
    }
    return moments;
}

/// A scene and a guide for it.
struct GuidedScene {
    CompiledScene scene;
    EmissionMoments moments;
    EmissionGuide guide;

    GuidedScene(CompiledScene compiled, EmissionMoments by_light)
        : scene(std::move(compiled)),
          moments(std::move(by_light)),
          guide(make_guide(scene, moments)) {}

    SceneView view() const {
        SceneView guided = view_of(scene);
        guided.emission_guide = guide.words.data();
        return guided;
    }

    /// Returns the density of a bin over the unit square, from the moments in double precision.
    double density(size_t light, size_t bin) const {
        double sum = 0;
        for (const double moment : moments[light]) {
            sum += std::sqrt(moment);
        }
        return takes_guide_table(scene, light)
                   ? 0.75 * GUIDE_BINS * std::sqrt(moments[light][bin]) / sum + 0.25
                   : 1.0;
    }

    /// Samples emission from a given light.
    EmissionSample emit_from(uint32_t light, uint32_t i) const {
        uint4 a = words(i, 0);
        a.x = guide.words[light] - 1u;
        const SceneView guided = view();
        return sample_emission(&guided, a, words(i, 1));
    }

    /// Returns the light's record as device functions see it.
    LightRecord record(uint32_t light) const {
        const SceneView guided = view();
        return light_at(&guided, light);
    }

    /// Returns the bin of a direction by the definition of the table, in double precision.
    size_t bin_of(uint32_t light, const Eigen::Vector3d &d) const {
        const LightRecord &record = scene.lights[light];
        double u = 0.5 - 0.5 * d.z(), x = d.x(), y = d.y();
        if (record.kind == LIGHT_MESH || record.kind == LIGHT_DISC) {
            x = d.dot(Eigen::Vector3f(record.axis_x).cast<double>());
            y = d.dot(Eigen::Vector3f(record.axis_y).cast<double>());
            u = 1 - std::pow(d.dot(Eigen::Vector3f(record.axis_z).cast<double>()), 2);
        }
        const double turn = std::atan2(y, x) / (2 * pi);
        const auto index = [](double value, uint32_t count) {
            return std::min(static_cast<uint32_t>(std::max(value, 0.0) * count), count - 1);
        };
        return index(u, GUIDE_ROWS) * GUIDE_COLUMNS +
               index(turn < 0 ? turn + 1 : turn, GUIDE_COLUMNS);
    }
};

}  // namespace rtrays
