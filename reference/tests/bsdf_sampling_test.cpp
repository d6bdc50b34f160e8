// SPDX-License-Identifier: MIT
// BSDF samplers: each one has the density that it states, and its weights are f cos / density.
#include <gtest/gtest.h>

#include "reference/tests/sphere_grid.h"
#include "reference/tests/statistics.h"
#include "reference/tests/test_materials.h"

namespace rtrays::reference {
namespace {

using Distribution = BxdfComponent::Distribution;

constexpr int samples = 100000;
const Eigen::Vector2d no_uv = Eigen::Vector2d::Zero();

/// Returns a direction at `degrees` from the normal; above 90 it is below the surface.
Vec3 view(double degrees) {
    const double theta = degrees * pi / 180.0;
    return {std::sin(theta) * std::cos(0.7), std::sin(theta) * std::sin(0.7), std::cos(theta)};
}

/// Returns a sampler that omits delta events, because the density omits them as well.
DirectionSampler sampler_of(const Bsdf &bsdf, const Vec3 &wo) {
    return [&bsdf, wo](Rng &rng) -> std::optional<Vec3> {
        const auto sample = bsdf.sample(wo, no_uv, rng);
        return sample && !sample->delta ? std::optional<Vec3>(sample->wi) : std::nullopt;
    };
}

DirectionDensity density_of(const Bsdf &bsdf, const Vec3 &wo) {
    return [&bsdf, wo](const Vec3 &wi) { return bsdf.pdf_w(wi, wo, no_uv); };
}

TEST(BsdfSampling, directions_have_the_density_claimed) {
    std::vector<Comparison> suite;
    Rng rng(81, 0, 0);
    for (const TestMaterial &material : rough_materials()) {
        const Bsdf bsdf = make_bsdf(material.components);
        for (const double degrees : {0.0, 35.0, 65.0, 85.0, 130.0}) {
            const Vec3 wo = view(degrees);
            const SamplerCheck check =
                check_sampler(sampler_of(bsdf, wo), density_of(bsdf, wo), samples, rng);
            EXPECT_LT(check.total, 1.0 + 5e-5) << material.name << " " << degrees;
            suite.push_back({material.name + " " + std::to_string(degrees), check.p_value});
        }
    }
    EXPECT_EQ(holm_rejected(suite), std::vector<std::string>{});
}

struct SharpLobe {
    const char *name;
    BxdfComponent component;
    Eigen::Vector2d width;  ///< width of the distribution of slopes
};

TEST(BsdfSampling, sharp_lobes_have_the_density_claimed) {
    const auto ggx = Distribution::ggx, beckmann = Distribution::beckmann;
    const std::vector<SharpLobe> lobes = {
        {"blinn 2048", blinn(2048), {0.03, 0.03}},
        {"blinn 1e7", blinn(1e7), {4e-4, 4e-4}},
        {"ward 1e-4", ward(1e-4, 1e-4), {1e-4, 1e-4}},
        {"ward 1e-4 0.01", ward(1e-4, 0.01), {1e-4, 0.01}},
        {"ggx 1e-3 1e-4", microfacet(ggx, 1e-3, 1e-4), {1e-3, 1e-4}},
        {"beckmann 1e-4", microfacet(beckmann, 1e-4, 1e-4), {1e-4, 1e-4}},
        {"beckmann 0.02 0.01", microfacet(beckmann, 0.02, 0.01), {0.02, 0.01}},
    };
    std::vector<Comparison> suite;
    Rng rng(82, 0, 0);
    for (const SharpLobe &lobe : lobes) {
        const Bsdf bsdf = make_bsdf({lobe.component});
        for (const double degrees : {0.0, 35.0, 65.0}) {
            const Vec3 wo = view(degrees);
            const SamplerCheck check = check_sharp_sampler(
                sampler_of(bsdf, wo), density_of(bsdf, wo), wo, lobe.width, samples, rng);
            EXPECT_LT(check.total, 1.0 + 5e-5);
            EXPECT_GT(check.total, 0.9);  // the cells cover the lobe
            suite.push_back(
                {lobe.name + std::string(" ") + std::to_string(degrees), check.p_value});
        }
    }
    EXPECT_EQ(holm_rejected(suite), std::vector<std::string>{});
}

TEST(BsdfSampling, the_chi_square_test_sees_two_percent) {
    // Tests a wrong sampler against the stated density. Its lobe is 2 % rougher, or a selection
    // probability is 2 % off.
    const auto ggx = Distribution::ggx, beckmann = Distribution::beckmann;
    const std::vector<
        std::tuple<const char *, std::vector<BxdfComponent>, std::vector<BxdfComponent>>>
        planted = {
            {"blinn", {blinn(64 * 1.02)}, {blinn(64)}},
            {"ward", {ward(0.3 * 1.02, 0.1)}, {ward(0.3, 0.1)}},
            {"ggx", {microfacet(ggx, 0.2 * 1.02, 0.2)}, {microfacet(ggx, 0.2, 0.2)}},
            {"beckmann", {microfacet(beckmann, 0.2 * 1.02, 0.2)}, {microfacet(beckmann, 0.2, 0.2)}},
            {"refraction",
             {rough_refraction(beckmann, 0.3, 1.5 * 1.02)},
             {rough_refraction(beckmann, 0.3, 1.5)}},
            {"composite", {lambert(0.51), blinn(64)}, {lambert(0.5), blinn(64)}},
        };
    Rng rng(83, 0, 0);
    for (const auto &[name, wrong, claimed] : planted) {
        const Bsdf sampled = make_bsdf(wrong), stated = make_bsdf(claimed);
        const Vec3 wo = view(35.0);
        const SamplerCheck check =
            check_sampler(sampler_of(sampled, wo), density_of(stated, wo), 20 * samples, rng);
        EXPECT_LT(check.p_value, 0.01 * family_alpha) << name;
    }
    // Oren and Nayar's directions do not depend on sigma, so here the density is wrong instead.
    const Bsdf rough = make_bsdf({oren_nayar(0.5)});
    const DirectionDensity claimed = density_of(rough, view(35.0));
    const auto tilted = [&](const Vec3 &wi) { return claimed(wi) * (wi.x() > 0.0 ? 1.02 : 0.98); };
    const SamplerCheck check =
        check_sampler(sampler_of(rough, view(35.0)), tilted, 20 * samples, rng);
    EXPECT_LT(check.p_value, 0.01 * family_alpha);
}

TEST(BsdfSampling, weights_are_value_times_cosine_over_density) {
    Rng rng(84, 0, 0);
    for (const TestMaterial &material : rough_materials()) {
        const Bsdf bsdf = make_bsdf(material.components);
        for (const double degrees : {5.0, 60.0, 89.0, 89.999, 120.0}) {
            const Vec3 wo = view(degrees);
            for (int i = 0; i < 2000; ++i) {
                const auto sample = bsdf.sample(wo, no_uv, rng);
                if (!sample || sample->delta) {
                    continue;
                }
                ASSERT_NEAR(sample->wi.norm(), 1.0, 1e-12) << material.name;
                ASSERT_TRUE(sample->weight.allFinite() && (sample->weight >= 0.0).all())
                    << material.name;
                const double pdf = bsdf.pdf_w(sample->wi, wo, no_uv);
                ASSERT_NEAR(pdf / sample->pdf_w, 1.0, 1e-9) << material.name;
                const Spectrum weight =
                    bsdf.evaluate(sample->wi, wo, no_uv) * std::abs(sample->wi.z()) / pdf;
                ASSERT_TRUE((weight - sample->weight).abs().maxCoeff() <= 1e-9 * weight.maxCoeff())
                    << material.name << " " << degrees;
            }
        }
    }
}

}  // namespace
}  // namespace rtrays::reference
