// SPDX-License-Identifier: MIT
// Tests of dielectric coats: closed forms of smooth coats, limits, and values of Mitsuba.
#include "renderer/scene/cores/coat.h"

#include <gtest/gtest.h>

#include <boost/math/quadrature/gauss.hpp>
#include <cmath>

#include "renderer/import/json/scene_json.h"

namespace rtrays {
namespace {

using Distribution = BxdfComponent::Distribution;

constexpr Distribution distributions[] = {Distribution::ggx, Distribution::beckmann};

/// Returns the reflectance of a smooth boundary of index n > 1 for diffuse light from outside
/// (Walsh 1926; Duntley 1942).
double diffuse_from_outside(double n) {
    const double n2 = n * n, n4 = n2 * n2;
    return 0.5 + (n - 1) * (3 * n + 1) / (6 * (n + 1) * (n + 1)) +
           n2 * (n2 - 1) * (n2 - 1) / std::pow(n2 + 1, 3) * std::log((n - 1) / (n + 1)) -
           2 * n * n2 * (n2 + 2 * n - 1) / ((n2 + 1) * (n4 - 1)) +
           8 * n4 * (n4 + 1) / ((n2 + 1) * (n4 - 1) * (n4 - 1)) * std::log(n);
}

/// Returns the mean of the transmittance over diffuse light from outside.
double diffuse_transmittance(const Coat &coat) {
    const auto integrand = [&](double root) {
        const double c = root * root;
        return 2 * c * coat_transmittance(coat, c) * 2 * root;
    };
    return boost::math::quadrature::gauss<double, 30>::integrate(integrand, 0.0, 1.0);
}

TEST(Coat, SmoothCoatsHaveTheirClosedForms) {
    EXPECT_NEAR(diffuse_from_outside(1.5), 0.0918, 5e-5);
    for (const double eta : {1.1, 1.5, 3.0}) {
        const Coat coat{eta, 0};
        EXPECT_NEAR(diffuse_transmittance(coat), 1 - diffuse_from_outside(eta), 1e-5) << eta;
        // As much passes from inside, by area of directions: n^2 |cos| dw is invariant.
        EXPECT_NEAR(coat_diffuse_reflectance(coat),
                    1 - (1 - diffuse_from_outside(eta)) / (eta * eta), 1e-5)
            << eta;
    }
    EXPECT_NEAR(coat_transmittance({1.5, 0}, 1), 0.96, 1e-12);
    EXPECT_EQ(coat_transmittance({1.5, 0}, 0), 0);
    EXPECT_EQ(coat_inner_reflectance({1.5, 0}, 0.7), 1);  // total reflection
}

TEST(Coat, RoughCoatsApproachSmoothOnes) {
    for (const Distribution distribution : distributions) {
        const Coat coat{1.5, 1e-4, distribution};
        for (const double cosine : {0.05, 0.3, 0.9, 1.0}) {
            EXPECT_NEAR(coat_transmittance(coat, cosine), coat_transmittance({1.5, 0}, cosine),
                        2e-4)
                << cosine;
        }
        EXPECT_NEAR(coat_diffuse_reflectance(coat), coat_diffuse_reflectance({1.5, 0}), 2e-4);
    }
}

// What passes from outside and what passes from inside is equal, by reciprocity. Without the light
// that microfacets mask, the inner reflectance is 1 minus what passes.
TEST(Coat, NothingPassesThatIsAlsoReflected) {
    for (const Distribution distribution : distributions) {
        for (const double alpha : {0.05, 0.3, 1.0}) {
            const Coat coat{1.5, alpha, distribution};
            const double passes = diffuse_transmittance(coat) / (1.5 * 1.5);
            const double lost = 1 - passes - coat_diffuse_reflectance(coat);
            EXPECT_GT(lost, -1e-4) << alpha;
            EXPECT_LT(lost, alpha < 0.1 ? 0.02 : 0.6) << alpha;
        }
    }
}

// As Mitsuba 3.9.1 tabulates them for int_ior = 1.5: transmittance at normal incidence and at a
// cosine of 0.2. It has 32 x 32 nodes and Walter's fit of Beckmann's masking.
TEST(Coat, AgreesWithMitsuba) {
    const struct {
        double alpha;
        Distribution distribution;
        double normal, oblique;
    } rows[] = {{0.1, Distribution::beckmann, 0.95999, 0.67939},
                {0.5, Distribution::beckmann, 0.95856, 0.83942},
                {0.1, Distribution::ggx, 0.95956, 0.71532},
                {0.5, Distribution::ggx, 0.94019, 0.69708}};
    for (const auto &row : rows) {
        const Coat coat{1.5, row.alpha, row.distribution};
        EXPECT_NEAR(coat_transmittance(coat, 1), row.normal, 8e-4) << row.alpha;
        EXPECT_NEAR(coat_transmittance(coat, 0.2), row.oblique, 2e-3) << row.alpha;
    }
}

/// Returns the components of a material in a scene file.
std::vector<BxdfComponent> components(const std::string &material) {
    return parse_scene_json(
               R"({"version": 1, "film": {"width": 8, "height": 8}, "nodes": [
        {"name": "eye", "camera": {"type": "pinhole", "fov": 60, "fov_axis": "x"}}, {"name": "a",
        "geometry": {"type": "sphere"}, "material": )" +
                   material + "}]}",
               "in.json", "in")
        .materials()
        .component;
}

TEST(Coat, MaterialsHaveACoatAndABase) {
    const auto rough = components(R"({"type": "coated_diffuse", "reflectance": [0.25, 0.5, 1],
        "eta": 1.5, "roughness": 0.25, "distribution": "beckmann", "nonlinear": true})");
    ASSERT_EQ(rough.size(), 2u);
    EXPECT_EQ(rough[0].kind, BxdfComponent::Kind::microfacet_reflection);
    EXPECT_EQ(rough[0].fresnel, BxdfComponent::Fresnel::dielectric);
    EXPECT_EQ(rough[1].kind, BxdfComponent::Kind::coated_lambert);
    EXPECT_EQ(rough[1].weight, Rgb(0.25f, 0.5f, 1.0f));
    EXPECT_TRUE(rough[1].nonlinear);
    EXPECT_LT(rough[1].inner_reflectance, 0);  // that of the coat
    for (const BxdfComponent &part : rough) {
        EXPECT_EQ(part.alpha, Eigen::Vector2d(0.25, 0.25));
        EXPECT_EQ(part.distribution, Distribution::beckmann);
        EXPECT_EQ(part.eta[0], 1.5);
    }
    const auto given = components(R"({"type": "composite", "components": [{"bxdf": "coated_lambert",
        "weight": [1, 1, 1], "eta": 1.25, "inner_reflectance": 0.25}]})");
    EXPECT_EQ(given[0].inner_reflectance, 0.25);
    EXPECT_FALSE(given[0].nonlinear);
    EXPECT_EQ(given[0].alpha, Eigen::Vector2d(0, 0));
}

}  // namespace
}  // namespace rtrays
