// SPDX-License-Identifier: MIT
// BSDFs: white furnaces, reciprocity, and the sides of a surface.
#include <gtest/gtest.h>

#include "reference/tests/sphere_grid.h"
#include "reference/tests/statistics.h"
#include "reference/tests/test_materials.h"
#include "renderer/base/error.h"
#include "renderer/base/statistics.h"

namespace rtrays::reference {
namespace {

using Distribution = BxdfComponent::Distribution;

constexpr double quadrature_error = 1e-4;
const Eigen::Vector2d no_uv = Eigen::Vector2d::Zero();

Vec3 at(double degrees) {
    const double theta = degrees * pi / 180.0;
    return {std::sin(theta) * std::cos(0.7), std::sin(theta) * std::sin(0.7), std::cos(theta)};
}

/// Returns the factor that converts radiance to energy. Radiance is compressed by eta^-2 on the
/// side of the lower index.
double energy_factor(const TestMaterial &material, const Vec3 &wi, const Vec3 &wo) {
    if (wi.z() * wo.z() > 0.0) {
        return 1.0;
    }
    const double eta = material.components.back().eta[0];
    return wo.z() > 0.0 ? square(eta) : 1.0 / square(eta);
}

/// Returns the energy that leaves when 1 arrives along wo, including delta events.
double albedo(const TestMaterial &material, const Bsdf &bsdf, const Vec3 &wo) {
    double total = integrate_sphere(
        [&](const Vec3 &wi) {
            return bsdf.evaluate(wi, wo, no_uv).maxCoeff() * std::abs(wi.z()) *
                   energy_factor(material, wi, wo);
        },
        quadrature_error);
    for (const BxdfComponent &component : material.components) {
        if (component.kind == BxdfComponent::Kind::ideal_reflection) {
            total += Fresnel(component).evaluate(std::abs(wo.z()), false).maxCoeff();
        }
    }
    return total;
}

TEST(BsdfEnergy, no_surface_reflects_more_than_it_receives) {
    for (const TestMaterial &material : rough_materials()) {
        if (!material.conserves_energy) {
            continue;
        }
        const Bsdf bsdf = make_bsdf(material.components);
        for (const double degrees : {0.0, 30.0, 60.0, 80.0, 88.0, 110.0, 160.0}) {
            const double value = albedo(material, bsdf, at(degrees));
            EXPECT_LE(value, 1.0 + quadrature_error) << material.name << " " << degrees;
            EXPECT_GT(value, 0.0) << material.name << " " << degrees;
        }
    }
}

TEST(BsdfEnergy, the_originals_that_cannot_are_as_far_off_as_known) {
    const auto value = [](const std::vector<BxdfComponent> &components, double degrees) {
        const TestMaterial material{"", components};
        return albedo(material, make_bsdf(components), at(degrees));
    };
    // The albedo of the qualitative model slightly exceeds 1.
    EXPECT_NEAR(value({oren_nayar(0.1)}, 88.0), 1.008, 0.004);
    // The original form diverges as 1 / sqrt(cos): tenfold at a hundredth of the angle to the
    // horizon.
    const double diverging = value({ward(0.3, 0.3, false)}, 89.9999);
    EXPECT_GT(diverging, 5.0);
    EXPECT_NEAR(diverging / value({ward(0.3, 0.3, false)}, 89.99), 10.0, 0.1);
    EXPECT_LE(value({ward(0.3, 0.3, true)}, 89.9999), 1.0);
}

/// Returns the albedo of Oren and Nayar's qualitative model (1994, eq. 30) seen at the angle theta.
/// The positive part of cos(phi) integrates to 2 over the azimuth. Therefore the factor of B is 2 /
/// pi times the integral over theta_i of sin(max) tan(min) cos(theta_i) sin(theta_i). The integral
/// has two parts, with theta_i below and above theta.
double oren_nayar_albedo(double sigma, double theta) {
    const double variance = square(sigma);
    const double a = 1.0 - 0.5 * variance / (variance + 0.33),
                 b = 0.45 * variance / (variance + 0.09);
    const double s = std::sin(theta), below = s * 0.5 * (theta - s * std::cos(theta)),
                 above = std::tan(theta) * (1.0 - s * s * s) / 3.0;
    return a + b * 2.0 / pi * (below + above);
}

TEST(BsdfEnergy, oren_nayar_has_the_albedo_of_its_closed_form) {
    for (const double sigma : {0.0, 0.1, 0.5, 0.25 * pi, 0.5 * pi}) {
        for (const double degrees : {0.0, 25.0, 60.0, 80.0, 130.0}) {
            const TestMaterial material{"", {oren_nayar(sigma)}};
            const double found = albedo(material, make_bsdf(material.components), at(degrees));
            const double theta = std::min(degrees, 180.0 - degrees) * pi / 180.0;
            EXPECT_NEAR(found, oren_nayar_albedo(sigma, theta), 2.0 * quadrature_error)
                << sigma << " " << degrees;
        }
    }
    // An error of 2 % in either coefficient or in sigma is at least five times the tolerance.
    const double theta = 60.0 * pi / 180.0, a = oren_nayar_albedo(0.5, 0.0);
    EXPECT_GT(0.02 * std::min(a, oren_nayar_albedo(0.5, theta) - a), 10.0 * quadrature_error);
    EXPECT_GT(oren_nayar_albedo(0.5, 0.0) - oren_nayar_albedo(0.51, 0.0), 20.0 * quadrature_error);
}

// All light that passes a smooth coat leaves a white base, after any number of reflections. The
// coat of index 1.5 reflects 0.5963 of diffuse light from below (Walsh 1926).
TEST(BsdfEnergy, coated_bases_have_the_albedo_of_their_closed_form) {
    const auto base = [](double weight, bool nonlinear) {
        const TestMaterial material{
            "", {coated_lambert(BxdfComponent::Distribution::ggx, 0.0, weight, nonlinear)}};
        return albedo(material, make_bsdf(material.components), at(40.0));
    };
    const double passes = 1.0 - fresnel_dielectric(std::cos(40.0 * pi / 180.0), 1.5);
    for (const bool nonlinear : {false, true}) {
        EXPECT_NEAR(base(1.0, nonlinear), passes, 3.0 * quadrature_error);
    }
    EXPECT_NEAR(base(0.5, false), 0.5 * passes, 3.0 * quadrature_error);
    EXPECT_NEAR(base(0.5, true), 0.5 * passes * (1.0 - 0.5963) / (1.0 - 0.5 * 0.5963),
                3.0 * quadrature_error);
}

// As Mitsuba 3.9.1's principled BSDF has them, with no other lobe: white, of roughness 0.7.
TEST(BsdfEnergy, disney_components_have_mitsubas_values) {
    const Vec3 wo = Vec3(0.9, 0.0, 0.2).normalized(), wi = Vec3(-0.8, 0.1, 0.25).normalized();
    const auto value = [&](const BxdfComponent &component) {
        return make_bsdf({component}).evaluate(wi, wo, Eigen::Vector2d(0.0, 0.0))[0] * wi.z();
    };
    EXPECT_NEAR(value(disney_diffuse(0.7, 0.0)), 0.077319, 1e-6);
    EXPECT_NEAR(value(disney_diffuse(0.7, 0.4)), 0.111049, 1e-6);
    EXPECT_NEAR(value(disney_sheen()), 0.064101, 1e-6);
    EXPECT_NEAR(value(disney_clearcoat(0.1)), 0.0139634, 2e-7);
    EXPECT_NEAR(value(disney_clearcoat(0.0109)), 0.00844262, 2e-7);
}

TEST(BsdfEnergy, sampled_weights_have_the_albedo_as_their_mean) {
    constexpr int samples = 200000;
    std::vector<Comparison> suite;
    Rng rng(85, 0, 0);
    for (const TestMaterial &material : rough_materials()) {
        const Bsdf bsdf = make_bsdf(material.components);
        for (const double degrees : {20.0, 70.0, 140.0}) {
            const Vec3 wo = at(degrees);
            double sum = 0.0, squares = 0.0;
            for (int i = 0; i < samples; ++i) {
                const auto sample = bsdf.sample(wo, no_uv, rng);
                const double weight =
                    sample ? sample->weight[0] * energy_factor(material, sample->wi, wo) : 0.0;
                sum += weight;
                squares += square(weight);
            }
            // The expected mean of the red channel.
            const double expected =
                integrate_sphere(
                    [&](const Vec3 &wi) {
                        return bsdf.evaluate(wi, wo, no_uv)[0] * std::abs(wi.z()) *
                               energy_factor(material, wi, wo);
                    },
                    quadrature_error) +
                (material.components[0].kind == BxdfComponent::Kind::ideal_reflection
                     ? Fresnel(material.components[0]).evaluate(std::abs(wo.z()), false)[0]
                     : 0.0);
            const double mean = sum / samples;
            const double deviation =
                std::sqrt(std::max(squares / samples - square(mean), 0.0) / samples);
            // The quadrature error matters if all weights are equal, so that the variance is
            // rounding error.
            suite.push_back(
                {material.name + " " + std::to_string(degrees),
                 normal_p_value((mean - expected) / std::hypot(deviation, quadrature_error))});
        }
    }
    EXPECT_EQ(holm_rejected(suite), std::vector<std::string>{});
}

TEST(BsdfReciprocity, exchanging_the_directions_changes_nothing_but_eta_squared) {
    Rng rng(86, 0, 0);
    for (const TestMaterial &material : rough_materials()) {
        const Bsdf bsdf = make_bsdf(material.components);
        double largest = 0.0;
        int compared = 0;
        for (int i = 0; i < 20000; ++i) {
            const Vec3 wo =
                Vec3(rng.uniform() - 0.5, rng.uniform() - 0.5, rng.uniform() - 0.5).normalized();
            const Vec3 wi =
                Vec3(rng.uniform() - 0.5, rng.uniform() - 0.5, rng.uniform() - 0.5).normalized();
            const Spectrum forth = bsdf.evaluate(wi, wo, no_uv) * energy_factor(material, wi, wo);
            const Spectrum back = bsdf.evaluate(wo, wi, no_uv);
            if (forth.maxCoeff() + back.maxCoeff() < 1e-100) {
                continue;
            }
            ++compared;
            largest = std::max(largest, ((forth - back).abs() / (forth + back)).maxCoeff());
        }
        EXPECT_GT(compared, 1000) << material.name;
        if (material.reciprocal) {
            // The error is largest for half vectors of directions that nearly cancel.
            EXPECT_LT(largest, 1e-7) << material.name;
        } else {
            EXPECT_GT(largest, 0.1) << material.name;  // the exemption is justified
        }
    }
}

TEST(Bsdf, one_sided_materials_are_black_from_behind_and_boundaries_are_not) {
    Rng rng(87, 0, 0);
    const Bsdf one_sided = make_bsdf({lambert(0.5), ideal_reflection()}, false);
    EXPECT_TRUE((one_sided.evaluate(at(100.0), at(120.0), no_uv) == 0.0).all());
    EXPECT_EQ(one_sided.pdf_w(at(100.0), at(120.0), no_uv), 0.0);
    EXPECT_FALSE(one_sided.sample(at(120.0), no_uv, rng));
    EXPECT_GT(one_sided.evaluate(at(10.0), at(20.0), no_uv)[0], 0.0);
    const Bsdf plain = make_bsdf({lambert(0.5)}, false);
    EXPECT_TRUE((plain.evaluate(at(100.0), at(120.0), no_uv) == 0.0).all());
    EXPECT_TRUE(make_bsdf(smooth_glass(1.5), false).sample(at(120.0), no_uv, rng));
    EXPECT_FALSE(make_bsdf({}).sample(at(20.0), no_uv, rng));  // black
    EXPECT_TRUE(make_bsdf({}).is_delta());
}

TEST(Bsdf, materials_may_differ_by_side) {
    Rng rng(88, 0, 0);
    BxdfComponent front = lambert(0.5), back = lambert(0.25);
    front.side = BxdfComponent::Side::front;
    back.side = BxdfComponent::Side::back;
    const Bsdf two = make_bsdf({front, back});
    EXPECT_EQ(two.evaluate(at(10.0), at(20.0), no_uv)[0], 0.5 * inv_pi);
    EXPECT_EQ(two.evaluate(at(100.0), at(120.0), no_uv)[0], 0.25 * inv_pi);
    EXPECT_NEAR(two.sample(at(120.0), no_uv, rng)->weight[0], 0.25, 1e-12);
    const Bsdf one = make_bsdf({back});
    EXPECT_EQ(one.evaluate(at(10.0), at(20.0), no_uv)[0], 0.0);
    EXPECT_FALSE(one.sample(at(20.0), no_uv, rng));
    BxdfComponent window = ideal_refraction(1.5);
    window.side = BxdfComponent::Side::front;
    EXPECT_THROW(make_bsdf({window}), Error);
}

TEST(Bsdf, thin_plates_pass_light_straight_through) {
    BxdfComponent mirrored = ideal_reflection(), passed = ideal_refraction(1.0);
    for (BxdfComponent *part : {&mirrored, &passed}) {
        part->fresnel = BxdfComponent::Fresnel::thin_dielectric;
        part->eta = {1.0, 1.5, 1.5};
    }
    passed.complement = true;
    const Bsdf plate = make_bsdf({mirrored, passed});
    Rng rng(89, 0, 0);
    for (const double degrees : {0.0, 60.0, 120.0}) {
        const Vec3 wo = at(degrees);
        const double r = fresnel_dielectric(std::abs(wo.z()), 1.5);
        constexpr int samples = 20000;
        int through = 0;
        for (int i = 0; i < samples; ++i) {
            const auto sample = plate.sample(wo, no_uv, rng);
            ASSERT_TRUE(sample);
            ASSERT_NEAR(sample->weight[0], 1.0, 1e-12);
            if (sample->wi.z() * wo.z() < 0.0) {
                ++through;
                ASSERT_LT((sample->wi + wo).norm(), 1e-12);
            }
        }
        const double expected = (1.0 - r) / (1.0 + r);
        EXPECT_NEAR(through, samples * expected,
                    4.0 * std::sqrt(samples * expected * (1.0 - expected)));
    }
    passed.eta[0] = 1.5;
    EXPECT_THROW(make_bsdf({passed}), Error);
}

TEST(Bsdf, smooth_glass_obeys_snell_and_fresnel) {
    constexpr int samples = 100000;
    Rng rng(88, 0, 0);
    const Bsdf glass = make_bsdf(smooth_glass(1.5));
    EXPECT_TRUE(glass.is_delta());
    std::vector<Comparison> suite;
    // The last is beyond the critical angle.
    for (const double degrees : {30.0, 80.0, 150.0, 120.0}) {
        const Vec3 wo = at(degrees);
        const double eta = wo.z() > 0.0 ? 1.5 : 1.0 / 1.5;
        const double reflectance = fresnel_dielectric(std::abs(wo.z()), eta);
        int reflected = 0;
        for (int i = 0; i < samples; ++i) {
            const auto sample = glass.sample(wo, no_uv, rng);
            ASSERT_TRUE(sample && sample->delta);
            if (sample->wi.z() * wo.z() > 0.0) {
                ++reflected;
                ASSERT_NEAR((sample->wi - Vec3(-wo.x(), -wo.y(), wo.z())).norm(), 0.0, 1e-14);
                ASSERT_NEAR(sample->weight[0], 1.0, 1e-12);
            } else {
                ASSERT_NEAR((eta * sample->wi.head<2>() + wo.head<2>()).norm(), 0.0, 1e-14);
                ASSERT_NEAR(sample->weight[0], 1.0 / square(eta), 1e-12);
            }
        }
        const double deviation = std::sqrt(samples * reflectance * (1.0 - reflectance));
        if (deviation > 0.0) {
            suite.push_back({std::to_string(degrees),
                             normal_p_value((reflected - samples * reflectance) / deviation)});
        } else {
            EXPECT_EQ(reflected, samples);
        }
    }
    EXPECT_EQ(holm_rejected(suite), std::vector<std::string>{});
}

TEST(Bsdf, a_texture_of_roughness_scales_it) {
    auto image = std::make_shared<TextureImage>();
    image->width = image->height = 1;
    image->floats = {0.5f, 0.5f, 0.5f};
    TextureArrays textures;
    textures.name = {"roughness"};
    textures.image = {image};
    textures.filter = {TextureArrays::Filter::bilinear};
    textures.wrap = {TextureArrays::Wrap::repeat};
    textures.uv_scale = {{1, 1}};
    textures.uv_offset = {{0, 0}};
    const Vec3 wo = Vec3(0.3, 0.2, 0.8).normalized(), wi = Vec3(-0.5, 0.1, 0.7).normalized();
    const auto value = [&](BxdfComponent component, bool textured, bool squared) {
        if (textured) {
            component.roughness_texture = 0;
            component.roughness_squared = squared;
        }
        return make_bsdf({component}, true, textures)
            .evaluate(wi, wo, Eigen::Vector2d(0.5, 0.5))[0];
    };
    const auto ggx = BxdfComponent::Distribution::ggx;
    const double expected = value(microfacet(ggx, 0.1, 0.2), false, false);
    EXPECT_GT(expected, 0);
    EXPECT_NEAR(value(microfacet(ggx, 0.2, 0.4), true, false), expected, 1e-9 * expected);
    EXPECT_NEAR(value(microfacet(ggx, 0.4, 0.8), true, true), expected, 1e-9 * expected);
    EXPECT_NEAR(value(ward(0.2, 0.4), true, false), value(ward(0.1, 0.2), false, false), 1e-9);
}

TEST(Bsdf, refuses_parameters_out_of_range) {
    BxdfComponent component = lambert(1.5);
    EXPECT_THROW(make_bsdf({component}), Error);
    EXPECT_THROW(make_bsdf({ward(0.0, 0.1)}), Error);
    EXPECT_THROW(make_bsdf({blinn(0.0)}), Error);
    EXPECT_THROW(make_bsdf({oren_nayar(-0.1)}), Error);
    EXPECT_THROW(make_bsdf({ideal_refraction(0.0)}), Error);
    component = lambert(0.5);
    component.texture = 3;
    EXPECT_THROW(make_bsdf({component}), Error);
    EXPECT_THROW(make_bsdf(std::vector<BxdfComponent>(17, lambert(0.01))), Error);
}

}  // namespace
}  // namespace rtrays::reference
