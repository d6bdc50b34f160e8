// SPDX-License-Identifier: MIT
// Materials, directions and the chi-square test of the BSDF tests. All features of BSDFs are
// compiled in.
#pragma once

// Must precede all device code.
#include "testing/all_features.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <string>
#include <vector>

#include "renderer/compile/compile_scene.h"
#include "renderer/kernels/bsdf/bsdf.h"
#include "renderer/kernels/sampling/random.h"
#include "renderer/scene/cores/coat.h"
#include "renderer/testing/chi_square.h"
#include "renderer/testing/direction_grid.h"

namespace rtrays {

/// A material with its components, and the device functions applied to it.
struct TestMaterial {
    std::string name;
    std::vector<BxdfRecord> components;
    uint flags = 0;
    std::vector<float> coat_transmittances{};
    std::vector<TextureRecord> textures{};
    std::vector<uint> texels{};

    MaterialRecord record() const { return {0, static_cast<uint>(components.size()), flags, 0}; }
    BsdfValue evaluate(const SurfaceFrame &frame, float3 wi) const {
        const MaterialRecord material = record();
        const SceneView view = view_of(material);
        return bsdf_evaluate(&view, 0, frame, wi);
    }
    BsdfSample sample(const SurfaceFrame &frame, float select, float u, float v) const {
        const MaterialRecord material = record();
        const SceneView view = view_of(material);
        return bsdf_sample(&view, 0, frame, select, u, v);
    }
    float light_path_pdf_w(const SurfaceFrame &frame, float3 w) const {
        const MaterialRecord material = record();
        const SceneView view = view_of(material);
        return ::light_path_pdf_w(&view, 0, frame, w);
    }

  private:
    /// Returns the view of a scene that has this material alone.
    SceneView view_of(const MaterialRecord &material) const {
        SceneView view{};
        view.materials = &material;
        view.components = components.data();
        view.coat_transmittances = coat_transmittances.data();
        view.textures = textures.data();
        view.texels = texels.data();
        return view;
    }
};

inline BxdfRecord component(uint kind, uint flags = 0) {
    BxdfRecord record{};
    record.kind = kind;
    record.flags = flags;
    record.texture = NO_TEXTURE;
    std::fill_n(record.weight, 3, 1.0f);
    std::fill_n(record.eta, 3, 1.0f);
    record.alpha_x = record.alpha_y = 1.0f;
    return record;
}

inline BxdfRecord oren_nayar(float sigma) {
    BxdfRecord record = component(BXDF_OREN_NAYAR);
    record.parameter = sigma;
    return record;
}

inline BxdfRecord blinn(float exponent) {
    BxdfRecord record = component(BXDF_BLINN);
    record.parameter = exponent;
    return record;
}

inline BxdfRecord rough(uint kind, float alpha_x, float alpha_y, uint flags = 0) {
    BxdfRecord record = component(kind, flags);
    record.alpha_x = alpha_x;
    record.alpha_y = alpha_y;
    return record;
}

inline BxdfRecord disney_diffuse(float roughness, float flatness) {
    BxdfRecord record = component(BXDF_DISNEY_DIFFUSE);
    record.parameter = roughness;
    record.k[0] = flatness;
    return record;
}

inline BxdfRecord with_eta(BxdfRecord record, float eta, uint flags = 0) {
    std::fill_n(record.eta, 3, eta);
    record.flags |= flags;
    return record;
}

inline BxdfRecord weighted(BxdfRecord record, float weight) {
    std::fill_n(record.weight, 3, weight);
    return record;
}

inline TestMaterial rough_glass(const std::string &name, float alpha_x, float alpha_y,
                                uint distribution) {
    return {name,
            {with_eta(rough(BXDF_MICROFACET_REFLECTION, alpha_x, alpha_y, distribution), 1.5f,
                      FRESNEL_DIELECTRIC),
             with_eta(rough(BXDF_MICROFACET_REFRACTION, alpha_x, alpha_y, distribution), 1.5f,
                      FRESNEL_DIELECTRIC | BXDF_FLAG_COMPLEMENT)},
            MATERIAL_BOUNDARY};
}

/// Car paint, thesis (3.55): a coat over a Lambert reflector. The version with `printed` follows
/// the printed formula, which is not symmetric.
inline TestMaterial car_paint(bool printed) {
    const uint printed_flag = printed ? BXDF_FLAG_FRESNEL_OF_WO : 0;
    return {printed ? "car paint as printed" : "car paint",
            {with_eta(component(BXDF_IDEAL_REFLECTION), 1.5f, FRESNEL_DIELECTRIC),
             with_eta(component(BXDF_LAMBERT), 1.5f,
                      FRESNEL_DIELECTRIC | BXDF_FLAG_COMPLEMENT | printed_flag)}};
}

/// A base of reflectance `colour` under a coat of index 1.5, with the reflection of the coat. It is
/// compiled as materials of scenes are.
inline TestMaterial coated(const std::string &name, double alpha, uint distribution, float colour,
                           bool nonlinear) {
    MaterialArrays arrays;
    arrays.name = {name};
    arrays.first_component = {0};
    arrays.component_count = {2};
    arrays.two_sided = {1};
    BxdfComponent surface;
    surface.kind = alpha > 0 ? BxdfComponent::Kind::microfacet_reflection
                             : BxdfComponent::Kind::ideal_reflection;
    surface.fresnel = BxdfComponent::Fresnel::dielectric;
    BxdfComponent base;
    base.kind = BxdfComponent::Kind::coated_lambert;
    base.weight.setConstant(colour);
    base.nonlinear = nonlinear;
    for (BxdfComponent *part : {&surface, &base}) {
        set_coat({1.5, alpha,
                  distribution != 0 ? BxdfComponent::Distribution::beckmann
                                    : BxdfComponent::Distribution::ggx},
                 *part);
        arrays.component.push_back(*part);
    }
    CompiledScene compiled;
    SceneArrays scene;
    scene.materials = arrays;
    compile_materials(scene, compiled);
    return {name, compiled.components, compiled.materials[0].flags, compiled.coat_transmittances};
}

/// Returns the frame of a tilted surface that is seen at `theta` degrees from its normal, on its
/// front or its back.
inline SurfaceFrame tilted_frame(double theta, double phi = 0.6, bool front = true) {
    const float3 n = normalize(make_float3(0.3f, -0.8f, -0.5f));
    const Frame axes = frame_from_tangent(n, make_float3(0.2f, 0.1f, 0.9f));
    const double t = theta * pi / 180;
    const double z = front ? std::cos(t) : -std::cos(t);
    const float3 local =
        make_float3(static_cast<float>(std::sin(t) * std::cos(phi)),
                    static_cast<float>(std::sin(t) * std::sin(phi)), static_cast<float>(z));
    return make_surface_frame(n, n, axes.x, make_float2(0, 0), normalize(to_world(axes, local)));
}

inline uint4 bsdf_words(uint32_t sample, uint32_t block) {
    return random_words(17, 0, 5, sample, block);
}

/// Sample counts of a sampler per cell of a grid. The last entry counts deltas and samples without
/// a direction, which were lost below the horizon.
struct SampledDirections {
    std::vector<uint64_t> observed = std::vector<uint64_t>(DirectionGrid::cells + 1);

    void add(const DirectionGrid &grid, float3 wi, float pdf_w) {
        const bool direction = pdf_w > 0.0f && pdf_w < std::numeric_limits<float>::infinity();
        ++observed[static_cast<size_t>(direction ? grid.cell(wi) : DirectionGrid::cells)];
    }
};

/// The p-value of sampled directions against the material's density, and the p-value against a
/// density with a planted error of 2 %. The planted density is multiplied by 1.02 on one side of
/// the plane of incidence and by 0.98 on the other, which keeps the total.
struct ChiSquare {
    double p, planted;
    double scattered;  ///< share of the samples with a direction and a finite density
};

inline ChiSquare test_directions(const TestMaterial &material, const SurfaceFrame &frame,
                                 const DirectionGrid &grid, const SampledDirections &directions) {
    const auto count = static_cast<double>(
        std::accumulate(directions.observed.begin(), directions.observed.end(), uint64_t{0}));
    std::vector<double> expected(directions.observed.size()), wrong(directions.observed.size());
    double rest = count;
    for (int cell = 0; cell < DirectionGrid::cells; ++cell) {
        // The quadrature may miss a sliver above the horizon. The added constant makes such a cell
        // rare instead of impossible, and rare cells are pooled.
        const double e = 1e-3 + count * grid.integral(cell, [&](float3 wi) {
            return static_cast<double>(material.evaluate(frame, wi).pdf_w);
        });
        const auto k = static_cast<size_t>(cell);
        expected[k] = e;
        wrong[k] =
            e *
            (cell % DirectionGrid::azimuth_cells < DirectionGrid::azimuth_cells / 2 ? 1.02 : 0.98);
        rest -= e;
    }
    std::vector<uint64_t> observed = directions.observed;
    if (count - rest < 50) {  // nearly all samples have no direction
        return {observed.back() + 100 > static_cast<uint64_t>(count) ? 1.0 : 0.0, 0, 0};
    }
    // A rest below 0.1 % is rounding error and does not get a cell of its own. Next to the horizon,
    // float cannot evaluate a density more exactly: with alpha = 0.01 and 0.001 degrees it
    // integrates to 1 - 2e-4.
    if (rest < 1e-3 * count) {
        if (static_cast<double>(observed.back()) > 2e-3 * count) {
            return {0, 1, 1};
        }
        observed.pop_back();
        expected.pop_back();
        wrong.pop_back();
    } else {
        expected.back() = wrong.back() = rest;
    }
    return {chi_square_p(observed, expected), chi_square_p(observed, wrong), 1 - rest / count};
}

}  // namespace rtrays
