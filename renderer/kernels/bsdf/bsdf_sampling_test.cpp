// SPDX-License-Identifier: MIT
// Compares the sampler of every BSDF with its density, using chi-square tests and the device code
// compiled for the host. Samples lost below the horizon form one cell.
//
// Each case has a level of 0.01 over the number of cases (Bonferroni). A case that scatters 60 % of
// its samples must also reject a density that is 2 % off. Other cases have too few samples for
// that.
#include <gtest/gtest.h>

#include "renderer/testing/bsdf_cases.h"

namespace rtrays {
namespace {

constexpr uint32_t sample_count = 500'000;

/// A material that is seen at some angles, in degrees. `width` is that of its lobe, in radians.
struct SamplingCase {
    TestMaterial material;
    double width;
    std::vector<double> angles;
    bool front = true;
    bool refracting = false;
};

std::vector<SamplingCase> sampling_cases() {
    const std::vector<double> all = {0.0, 45.0, 80.0, 89.0, 89.999};
    const std::vector<double> steep = {0.0, 60.0, 80.0};
    const uint reflection = BXDF_MICROFACET_REFLECTION, refraction = BXDF_MICROFACET_REFRACTION;
    std::vector<SamplingCase> cases = {
        {{"lambert", {component(BXDF_LAMBERT)}}, 1.0, {30.0, 89.999}},
        {{"oren_nayar pi/2", {oren_nayar(1.5707963f)}}, 1.0, {60.0, 89.999}},
        {{"blinn 1", {blinn(1)}}, 1.0, all},
        {{"blinn 64", {blinn(64)}}, 0.3, all},
        {{"blinn 2048", {blinn(2048)}}, 0.05, {0.0, 60.0, 89.0}},
        {{"blinn 1e7", {blinn(1e7f)}}, 8e-4, steep},
        {{"ward 0.3", {rough(BXDF_WARD, 0.3f, 0.3f)}}, 0.5, all},
        {{"ward 0.1, 0.4", {rough(BXDF_WARD, 0.1f, 0.4f)}}, 0.4, all},
        {{"ward 0.0001", {rough(BXDF_WARD, 1e-4f, 2e-4f)}}, 2e-4, steep},
        {{"ward_original 0.3", {rough(BXDF_WARD_ORIGINAL, 0.3f, 0.3f)}}, 0.5, {45.0, 89.999}},
        {{"ward_original 0.01, 0.1", {rough(BXDF_WARD_ORIGINAL, 0.01f, 0.1f)}}, 0.1, {0.0, 80.0}},
        {{"plastic",
          {weighted(component(BXDF_LAMBERT), 0.5f),
           weighted(with_eta(blinn(512), 1.5f, FRESNEL_DIELECTRIC), 0.5f)}},
         0.3,
         {30.0, 85.0}},
        {car_paint(false), 1.0, {45.0, 88.0}},
        {{"disney_clearcoat 0.1", {rough(BXDF_DISNEY_CLEARCOAT, 0.1f, 0.1f)}},
         0.3,
         {0.0, 60.0, 89.0}},
        {{"disney_clearcoat 0.001", {rough(BXDF_DISNEY_CLEARCOAT, 1e-3f, 1e-3f)}}, 0.01, {30.0}},
        {coated("coat", 0.3, 0, 0.8f, true), 0.6, {30.0, 88.0}},
    };
    for (const uint distribution : {0u, BXDF_FLAG_BECKMANN}) {
        const std::string name = distribution != 0 ? "beckmann " : "ggx ";
        const auto add = [&](uint kind, float x, float y, std::vector<double> angles,
                             bool front = true) {
            TestMaterial material = {name +
                                         (kind == reflection ? "reflection "
                                          : front            ? "refraction "
                                                             : "refraction from behind ") +
                                         std::to_string(x) + ", " + std::to_string(y),
                                     {with_eta(rough(kind, x, y, distribution), 1.5f)},
                                     kind == refraction ? MATERIAL_BOUNDARY : 0u};
            cases.push_back({material, 2.0 * static_cast<double>(std::max(x, y)), std::move(angles),
                             front, kind == refraction});
        };
        add(reflection, 1.0f, 1.0f, all);
        add(reflection, 0.5f, 0.1f, all);
        add(reflection, 0.01f, 0.01f, {0.0, 70.0, 89.999});
        add(reflection, 1e-4f, 1e-4f, {0.0, 70.0});
        add(refraction, 0.7f, 0.7f, all);
        add(refraction, 0.1f, 0.3f, all);
        add(refraction, 1e-3f, 1e-3f, {0.0, 70.0});
        add(refraction, 0.7f, 0.7f, {0.0, 30.0, 60.0, 89.999}, false);
        add(refraction, 0.1f, 0.3f, {0.0, 30.0, 41.81, 60.0},
            false);  // 41.81 is the critical angle
        cases.push_back({rough_glass(name + "glass", 0.3f, 0.3f, distribution), 0.6, {50.0}});
        cases.push_back({rough_glass(name + "glass from behind", 0.2f, 0.2f, distribution),
                         0.4,
                         {41.0},
                         false});
    }
    return cases;
}

TEST(BsdfSampling, FollowsItsDensity) {
    const std::vector<SamplingCase> cases = sampling_cases();
    size_t tests = 0;
    for (const SamplingCase &c : cases) {
        tests += c.angles.size();
    }
    const double level = 0.01 / static_cast<double>(tests);
    uint32_t block = 0;
    size_t planted = 0;
    for (const SamplingCase &c : cases) {
        for (const double angle : c.angles) {
            ++block;
            const SurfaceFrame frame = tilted_frame(angle, 0.6, c.front);
            // The lobe's centre is the mirror direction or the refracted direction, or the horizon
            // under total internal reflection.
            const float3 wo = to_local(frame, frame.wo);
            float3 local = reflect_about(wo, make_float3(0, 0, 1));
            if (c.refracting) {
                const float eta = c.front ? 1.5f : 1.0f / 1.5f;
                const float cosine = std::max(refracted_cosine(wo.z, squared_sine(wo), eta), 0.0f);
                local = normalize(make_float3(-wo.x / eta, -wo.y / eta, -cosine));
            }
            const float3 centre = frame.x * local.x + frame.y * local.y + frame.ns * local.z;
            const DirectionGrid grid(centre, frame.ns, c.width);
            SampledDirections directions;
            for (uint32_t i = 0; i < sample_count; ++i) {
                const uint4 w = bsdf_words(i, block);
                const BsdfSample s = c.material.sample(frame, uniform_float(w.x),
                                                       uniform_float(w.y), uniform_float(w.z));
                directions.add(grid, s.wi, s.pdf_w);
            }
            const ChiSquare result = test_directions(c.material, frame, grid, directions);
            EXPECT_GT(result.p, level) << c.material.name << " at " << angle << " degrees, lost "
                                       << directions.observed.back();
            if (result.scattered > 0.6) {
                EXPECT_LT(result.planted, level)
                    << c.material.name << " at " << angle << " degrees";
                ++planted;
            }
        }
    }
    EXPECT_GT(planted, tests / 2);
}

}  // namespace
}  // namespace rtrays
