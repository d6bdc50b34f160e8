// SPDX-License-Identifier: MIT
// Tests light paths at shading normals that differ much from the geometric normal, using the device
// code compiled for the host. They must bring to the camera what camera paths see there.
#include <gtest/gtest.h>

#include "renderer/testing/bsdf_cases.h"
#include "renderer/testing/mapped_triangle.h"

namespace rtrays {
namespace {

constexpr uint32_t sample_count = 400'000;

/// A surface with unit normals, both on the front. The shading normal is that of the vertices or
/// that of a map.
struct Surface {
    float3 ng, ns;
    const MappedTriangle *mapped = nullptr;

    SurfaceFrame frame(float3 wo) const {
        if (mapped != nullptr) {
            return mapped->frame(wo);
        }
        return make_surface_frame(ng, ns, make_float3(0.2f, 0.1f, 0.9f), make_float2(0, 0), wo);
    }
    bool between_horizons(float3 w) const { return dot(ng, w) * dot(ns, w) < 0.0f; }
};

/// Mean and squared standard error of samples.
struct Estimate {
    double sum = 0, squares = 0, count = 0;

    void add(double value) {
        sum += value;
        squares += value * value;
        ++count;
    }
    double mean() const { return sum / count; }
    double error2() const { return (squares / count - mean() * mean()) / (count - 1); }
};

/// Importance of all directions, and of those between the horizons.
struct Importance {
    Estimate all, between;

    void add(const Surface &surface, float3 w, double value) {
        all.add(value);
        between.add(surface.between_horizons(w) ? value : 0.0);
    }
};

/// Returns f |cos(ns, light)| of radiance from `light` to `w`, as a camera path has it, with the
/// quotient of geometric cosines that makes it the importance of a light path.
double importance_of(const TestMaterial &material, const Surface &surface, float3 light, float3 w) {
    const BsdfValue value = material.evaluate(surface.frame(w), light);
    return static_cast<double>(value.f_cos.x) * std::abs(static_cast<double>(dot(surface.ng, w))) /
           std::abs(static_cast<double>(dot(surface.ng, light)));
}

/// Samples light paths that arrive from `light`.
Importance by_light_paths(const TestMaterial &material, const Surface &surface, float3 light,
                          uint32_t block) {
    const SurfaceFrame frame = surface.frame(light);
    Importance importance;
    for (uint32_t i = 0; i < sample_count; ++i) {
        const uint4 words = bsdf_words(i, block);
        const BsdfSample s = material.sample(frame, uniform_float(words.x), uniform_float(words.y),
                                             uniform_float(words.z));
        const bool ended = !(s.pdf_w > 0.0f && s.pdf_w < std::numeric_limits<float>::infinity());
        if (!ended && i % 100 == 0) {
            EXPECT_NEAR(material.light_path_pdf_w(frame, s.wi) / s.pdf_w, 1.0f, 2e-3f)
                << material.name;
        }
        importance.add(
            surface, s.wi,
            ended ? 0.0
                  : importance_of(material, surface, light, s.wi) / static_cast<double>(s.pdf_w));
    }
    return importance;
}

/// Samples all directions uniformly.
Importance by_all_directions(const TestMaterial &material, const Surface &surface, float3 light,
                             uint32_t block) {
    Importance importance;
    for (uint32_t i = 0; i < sample_count; ++i) {
        const uint4 words = bsdf_words(i, block);
        const float3 w = sample_uniform_sphere(uniform_float(words.x), uniform_float(words.y));
        importance.add(surface, w, 4 * pi * importance_of(material, surface, light, w));
    }
    return importance;
}

/// Returns the unit vector in the x-z plane at `degrees` from +z.
float3 at_angle(double degrees) {
    return make_float3(static_cast<float>(std::sin(degrees * pi / 180)), 0.0f,
                       static_cast<float>(std::cos(degrees * pi / 180)));
}

/// Compares light paths with camera paths on four surfaces, with the normals of vertices or of
/// maps.
void expect_equal_light(bool mapped) {
    const std::vector<TestMaterial> materials = {
        {"lambert", {component(BXDF_LAMBERT)}},
        {"plastic",
         {weighted(component(BXDF_LAMBERT), 0.5f),
          weighted(with_eta(blinn(8), 1.5f, FRESNEL_DIELECTRIC), 0.5f)}},
        {"ggx", {rough(BXDF_MICROFACET_REFLECTION, 0.6f, 0.6f)}},
        rough_glass("glass", 0.6f, 0.6f, 0)};
    const std::vector<std::pair<double, double>> angles = {{60, 0}, {30, 10}, {45, -60}, {60, 75}};
    // Two means of each case share a family-wise level of 0.01 (two-sided, Bonferroni, 32 tests).
    constexpr double limit = 3.8;
    uint32_t block = 0;
    double largest_share = 0;
    for (const TestMaterial &material : materials) {
        const bool refracts = (material.flags & MATERIAL_BOUNDARY) != 0;
        for (const auto &[tilt, light_angle] : angles) {
            MappedTriangle triangle;
            triangle.set_texel(at_angle(tilt));
            triangle.map.flags = NORMAL_MAP_SHADOWING;
            const Surface surface = {make_float3(0, 0, 1), at_angle(tilt),
                                     mapped ? &triangle : nullptr};
            const float3 light = at_angle(light_angle);
            const Importance sampled = by_light_paths(material, surface, light, ++block),
                             expected = by_all_directions(material, surface, light, ++block);
            for (const auto &[a, b] : {std::pair(sampled.all, expected.all),
                                       std::pair(sampled.between, expected.between)}) {
                // Rough glass refracts into a cone. Its mirror image need not contain all
                // directions between the horizons, so light paths may bring less, but never more.
                const double surplus = a.mean() - b.mean();
                // Both are 0 where the map reverses its tilt for all directions between.
                EXPECT_LE(refracts ? surplus : std::abs(surplus),
                          limit * std::sqrt(a.error2() + b.error2()) + 1e-4 * b.mean())
                    << material.name << ", normals at " << tilt << ", light at " << light_angle;
            }
            EXPECT_LT(std::sqrt(sampled.all.error2()), 0.02 * sampled.all.mean())
                << "statistical power";
            largest_share = std::max(largest_share, expected.between.mean() / expected.all.mean());
        }
    }
    EXPECT_GT(largest_share, 0.2) << "much of the light leaves between the horizons";
}

TEST(LightPaths, BringTheLightThatCameraPathsSee) {
    expect_equal_light(false);
}

TEST(LightPaths, BringTheLightOfSurfacesWithNormalMaps) {
    expect_equal_light(true);
}

}  // namespace
}  // namespace rtrays
