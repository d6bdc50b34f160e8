// SPDX-License-Identifier: MIT
#include "renderer/integrators/unseen_light.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>

namespace rtrays {

namespace {

using LightKind = LightArrays::Kind;

bool is_infinite(LightKind kind) {
    return kind == LightKind::dome || kind == LightKind::environment;
}

bool is_delta(LightKind kind) {
    return kind == LightKind::point || kind == LightKind::spot || kind == LightKind::directional;
}

/// The surfaces and lights that decide which classes of light paths a scene may have.
struct Contents {
    bool ideal = false;  ///< a surface is an ideal mirror or smooth glass
    bool other = false;  ///< a surface scatters light in any other way
    bool plane = false;  ///< a surface is unbounded
    /// Names of lights, quoted.
    std::vector<std::string> all, infinite, parallel, delta, hittable;
};

void add_material(const MaterialArrays &materials, uint32_t material, Contents &contents) {
    const auto first = materials.component.begin() + materials.first_component[material];
    for (auto it = first; it != first + materials.component_count[material]; ++it) {
        const bool ideal = it->kind == BxdfComponent::Kind::ideal_reflection ||
                           it->kind == BxdfComponent::Kind::ideal_refraction;
        if (it->weight.maxCoeff() > 0.0f) {
            (ideal ? contents.ideal : contents.other) = true;
        }
    }
}

Contents contents_of(const SceneArrays &scene) {
    Contents contents;
    for (const uint32_t material : scene.meshes.material) {
        add_material(scene.materials, material, contents);
    }
    for (size_t i = 0; i < scene.shapes.kind.size(); ++i) {
        add_material(scene.materials, scene.shapes.material[i], contents);
        contents.plane = contents.plane || scene.shapes.kind[i] == ShapeArrays::Kind::plane;
    }
    for (size_t i = 0; i < scene.lights.kind.size(); ++i) {
        if (!(scene.lights.radiance[i].maxCoeff() > 0.0f)) {
            continue;
        }
        const LightKind kind = scene.lights.kind[i];
        const std::string name = "'" + scene.lights.name[i] + "'";
        contents.all.push_back(name);
        (is_delta(kind) ? contents.delta : contents.hittable).push_back(name);
        if (is_infinite(kind)) {
            contents.infinite.push_back(name);
        }
        if (is_infinite(kind) || kind == LightKind::directional) {
            contents.parallel.push_back(name);
        }
    }
    return contents;
}

/// Returns the lights whose light takes paths of a class, without those classes that every
/// algorithm with random numbers sees.
std::vector<std::string> lights_of(PathClass path, const Contents &contents, uint32_t events) {
    const auto lights_if = [&](bool possible, uint32_t least_events,
                               const std::vector<std::string> &lights) {
        return possible && events >= least_events ? lights : std::vector<std::string>();
    };
    const bool both = contents.ideal && contents.other;
    switch (path) {
        case PathClass::infinite_lights:
            return contents.infinite;
        case PathClass::infinite_light_outside:
            return lights_if(contents.plane && contents.other, 1, contents.parallel);
        case PathClass::mirrors:
            return lights_if(contents.ideal, 1, contents.other ? contents.all : contents.hittable);
        case PathClass::delta_light_caustics:
            return lights_if(both, 2, contents.delta);
        case PathClass::mirrored_delta_light_caustics:
            return lights_if(both, 3, contents.delta);
        case PathClass::mirrored_light_of_delta_light_caustics:
            return lights_if(both, 4, contents.delta);
        case PathClass::area_lights:
        case PathClass::direct_light:
        case PathClass::diffuse_reflection:
        case PathClass::caustics:
        case PathClass::mirrored_caustics:
        case PathClass::nearly_specular:
            break;
    }
    return {};
}

/// Returns whether another class says more: mirrors contain the mirror images of caustics, and
/// without caustics their mirror images are missing, too.
bool is_implied(const Sight &sight, PathClass path) {
    const bool mirrored = path == PathClass::mirrored_delta_light_caustics ||
                          path == PathClass::mirrored_light_of_delta_light_caustics;
    return mirrored && (sight.of(PathClass::mirrors) == Visibility::no ||
                        sight.of(PathClass::delta_light_caustics) == Visibility::no);
}

/// Returns whether `other` sees all that `sight` sees, and class `path` besides.
bool sees_more(const Sight &other, const Sight &sight, PathClass path) {
    return other.of(path) == Visibility::yes &&
           std::all_of(std::begin(path_classes), std::end(path_classes),
                       [&](const Named<PathClass> &row) {
                           return sight.of(row.value) == Visibility::no ||
                                  other.of(row.value) == Visibility::yes;
                       });
}

/// Returns "a", "a and b" or "a, b and 7 more".
std::string listing(const std::vector<std::string> &names) {
    const size_t shown = names.size() > 3 ? 2 : names.size() - 1;
    const std::string last =
        names.size() > 3 ? fmt::format("{} more", names.size() - 2) : names.back();
    const std::vector<std::string> first(names.begin(),
                                         names.begin() + static_cast<std::ptrdiff_t>(shown));
    return first.empty() ? last : fmt::format("{} and {}", fmt::join(first, ", "), last);
}

}  // namespace

std::vector<std::string> unseen_light(const Algorithm &algorithm, const SceneArrays &scene,
                                      uint32_t max_depth) {
    if (!algorithm.is_random) {
        return {};
    }
    const Contents contents = contents_of(scene);
    if (contents.all.empty()) {
        return {
            fmt::format("the scene has no light, so {} renders it black; ray_casting and "
                        "whitted light it from the camera",
                        algorithm.name)};
    }
    const uint32_t events = max_depth > 0 ? max_depth : UINT32_MAX;
    std::vector<std::string> sentences;
    for (const auto &[path, text] : path_classes) {
        const std::vector<std::string> lights = lights_of(path, contents, events);
        if (algorithm.sees.of(path) != Visibility::no || lights.empty() ||
            is_implied(algorithm.sees, path)) {
            continue;
        }
        std::vector<std::string> others;
        for (const Algorithm *other : all_algorithms()) {
            if (sees_more(other->sees, algorithm.sees, path)) {
                others.emplace_back(other->name);
            }
        }
        sentences.push_back(
            fmt::format("{} does not see {} (here {}); {}", algorithm.name, text, listing(lights),
                        others.empty() ? "no algorithm does"
                                       : listing(others) + (others.size() > 1 ? " do" : " does")));
    }
    return sentences;
}

std::string lights_not_hit(const SceneArrays &scene) {
    const Contents contents = contents_of(scene);
    return contents.delta.empty() ? "" : listing(contents.delta);
}

}  // namespace rtrays
