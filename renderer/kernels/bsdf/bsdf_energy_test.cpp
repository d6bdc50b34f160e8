// SPDX-License-Identifier: MIT
// Tests properties of all BSDFs: energy conservation, reciprocity, agreement of sampling and
// evaluation, finite values, and smooth limits.
#include <gtest/gtest.h>

#include "renderer/testing/bsdf_cases.h"

namespace rtrays {
namespace {

constexpr float infinity = std::numeric_limits<float>::infinity();

std::vector<TestMaterial> materials() {
    std::vector<TestMaterial> all = {
        {"lambert", {component(BXDF_LAMBERT)}},
        {"oren_nayar 0.1", {oren_nayar(0.1f)}},
        {"oren_nayar pi/4", {oren_nayar(0.7853982f)}},
        {"oren_nayar pi/2", {oren_nayar(1.5707963f)}},
        {"blinn 1", {blinn(1)}},
        {"blinn 64", {blinn(64)}},
        {"blinn 2048", {blinn(2048)}},
        {"ward 0.3", {rough(BXDF_WARD, 0.3f, 0.3f)}},
        {"ward 1", {rough(BXDF_WARD, 1.0f, 1.0f)}},
        {"ward 0.05, 0.3", {rough(BXDF_WARD, 0.05f, 0.3f)}},
        {"ward_original 0.3", {rough(BXDF_WARD_ORIGINAL, 0.3f, 0.3f)}},
        {"plastic",
         {with_eta(component(BXDF_LAMBERT), 1.5f, FRESNEL_DIELECTRIC | BXDF_FLAG_COMPLEMENT),
          with_eta(component(BXDF_IDEAL_REFLECTION), 1.5f, FRESNEL_DIELECTRIC)}},
        car_paint(false),
        car_paint(true),
        {"disney_diffuse 0", {disney_diffuse(0, 0)}},
        {"disney_diffuse 1", {disney_diffuse(1, 0)}},
        {"disney_diffuse 0.5, flat", {disney_diffuse(0.5f, 0.75f)}},
        {"disney_sheen", {component(BXDF_DISNEY_SHEEN)}},
        {"disney_clearcoat 0.1", {rough(BXDF_DISNEY_CLEARCOAT, 0.1f, 0.1f)}},
        {"disney_clearcoat 0.02", {rough(BXDF_DISNEY_CLEARCOAT, 0.02f, 0.02f)}},
        coated("smooth coat", 0, 0, 1, false),
        coated("smooth coat, nonlinear", 0, 0, 0.8f, true),
    };
    for (const uint distribution : {0u, BXDF_FLAG_BECKMANN}) {
        const std::string name = distribution != 0 ? "beckmann " : "ggx ";
        all.push_back(
            {name + "reflection 1", {rough(BXDF_MICROFACET_REFLECTION, 1, 1, distribution)}});
        all.push_back({name + "reflection 0.1, 0.5",
                       {rough(BXDF_MICROFACET_REFLECTION, 0.1f, 0.5f, distribution)}});
        all.push_back(
            {name + "refraction 0.4",
             {with_eta(rough(BXDF_MICROFACET_REFRACTION, 0.4f, 0.4f, distribution), 1.5f)},
             MATERIAL_BOUNDARY});
        all.push_back(coated(name + "coat 0.1", 0.1, distribution, 1, false));
        all.push_back(coated(name + "coat 1", 1, distribution, 1, true));
        all.push_back(rough_glass(name + "glass 0.3", 0.3f, 0.3f, distribution));
        all.push_back(rough_glass(name + "glass 0.02, 0.1", 0.02f, 0.1f, distribution));
    }
    return all;
}

float eta_of(const TestMaterial &material, const SurfaceFrame &frame) {
    return (material.flags & MATERIAL_BOUNDARY) == 0 ? 1.0f
           : frame.front != 0u                       ? 1.5f
                                                     : 1.0f / 1.5f;
}

/// Fraction of the power arriving along wo that the material scatters, and its standard error.
/// Transmitted radiance is used without its factor 1 / eta^2, which does not change power.
struct Albedo {
    double mean = 0, error = 0;
};

Albedo albedo(const TestMaterial &material, const SurfaceFrame &frame) {
    constexpr uint32_t count = 50'000;
    const float eta = eta_of(material, frame);
    double sum = 0, squares = 0;
    for (uint32_t i = 0; i < count; ++i) {
        const uint4 w = bsdf_words(i, 1000);
        const BsdfSample s =
            material.sample(frame, uniform_float(w.x), uniform_float(w.y), uniform_float(w.z));
        const float scale = dot(s.wi, frame.ns) < 0.0f ? eta * eta : 1.0f;
        const double value = s.pdf_w > 0.0f ? static_cast<double>(s.weight.x * scale) : 0.0;
        sum += value;
        squares += value * value;
    }
    const double mean = sum / count;
    return {mean, std::sqrt(std::max(squares / count - mean * mean, 0.0) / count)};
}

// White furnace test. Original models that cannot conserve energy are exempt by name and must
// exceed the bound.
TEST(Energy, NoMaterialScattersMoreThanArrives) {
    const std::vector<std::pair<std::string, double>> exempt = {{"oren_nayar 0.1", 1.012},
                                                                {"disney_diffuse 1", 1.57},
                                                                {"disney_diffuse 0.5, flat", 1.25},
                                                                {"ward_original 0.3", infinity}};
    for (const TestMaterial &material : materials()) {
        const auto found = std::find_if(exempt.begin(), exempt.end(),
                                        [&](const auto &e) { return e.first == material.name; });
        double largest = 0;
        for (const double theta : {0.0, 30.0, 60.0, 80.0, 89.0, 89.999}) {
            for (const bool front : {true, false}) {
                if (!front && (material.flags & MATERIAL_BOUNDARY) == 0) {
                    continue;  // the back equals the front
                }
                const Albedo a = albedo(material, tilted_frame(theta, 0.6, front));
                const double bound = found == exempt.end() ? 1.0 : found->second;
                EXPECT_LE(a.mean, bound + 4.5 * a.error + 1e-6)
                    << material.name << " at " << theta << (front ? "" : " from behind");
                largest = std::max(largest, a.mean - 4.5 * a.error);
            }
        }
        if (found != exempt.end()) {
            EXPECT_GT(largest, 1.0) << material.name << " needs no exemption";
        }
    }
}

TEST(Energy, WhiteLambertScattersAll) {
    EXPECT_NEAR(albedo({"lambert", {component(BXDF_LAMBERT)}}, tilted_frame(60)).mean, 1.0, 1e-6);
}

/// Returns the albedo of Oren and Nayar's qualitative model (1994, eq. 30) seen at the angle theta.
/// The positive part of cos(phi) integrates to 2. The integral over theta_i is the sum of one below
/// theta and one above.
double oren_nayar_albedo(double sigma, double theta) {
    const double variance = sigma * sigma, s = std::sin(theta);
    const double a = 1 - 0.5 * variance / (variance + 0.33),
                 b = 0.45 * variance / (variance + 0.09);
    return a + b * 2 / pi *
                   (s * (theta - s * std::cos(theta)) / 2 + std::tan(theta) * (1 - s * s * s) / 3);
}

// The mean weight is computed over a regular grid of random numbers. Such a quadrature detects an
// error of 2 % in either coefficient.
TEST(Energy, OrenNayarHasTheAlbedoOfItsClosedForm) {
    constexpr int steps = 400;
    constexpr double tolerance = 2e-4;
    const auto found = [&](float sigma, double degrees) {
        const TestMaterial material = {"oren_nayar", {oren_nayar(sigma)}};
        const SurfaceFrame frame = tilted_frame(degrees);
        double sum = 0;
        for (int i = 0; i < steps * steps; ++i) {
            const auto u = static_cast<float>((i / steps + 0.5) / steps);
            const auto v = static_cast<float>((i % steps + 0.5) / steps);
            const BsdfSample sample = material.sample(frame, 0.5f, u, v);
            sum += sample.pdf_w > 0.0f ? static_cast<double>(sample.weight.x) : 0.0;
        }
        return sum / (steps * steps);
    };
    for (const float sigma : {0.0f, 0.1f, 0.5f, 0.7853982f, 1.5707963f}) {
        for (const double degrees : {0.0, 25.0, 60.0, 80.0}) {
            EXPECT_NEAR(found(sigma, degrees),
                        oren_nayar_albedo(static_cast<double>(sigma), degrees * pi / 180),
                        tolerance)
                << sigma << ' ' << degrees;
        }
    }
    EXPECT_GT(std::abs(found(0.51f, 0) - oren_nayar_albedo(0.5, 0)), 10 * tolerance);
    const double a = oren_nayar_albedo(0.5, 0);
    EXPECT_GT(0.02 * std::min(a, oren_nayar_albedo(0.5, pi / 3) - a), 5 * tolerance);
}

/// Returns the mean weight of `material` over a regular grid of random numbers.
double mean_weight(const TestMaterial &material, const SurfaceFrame &frame, float select) {
    constexpr int steps = 400;
    double sum = 0;
    for (int i = 0; i < steps * steps; ++i) {
        const auto u = static_cast<float>((i / steps + 0.5) / steps);
        const auto v = static_cast<float>((i % steps + 0.5) / steps);
        const BsdfSample sample = material.sample(frame, select, u, v);
        sum += sample.pdf_w > 0.0f ? static_cast<double>(sample.weight.x) : 0.0;
    }
    return sum / (steps * steps);
}

// A white base returns all light that passes a smooth coat, after any number of reflections.
TEST(Energy, AWhiteBaseUnderASmoothCoatScattersAll) {
    for (const bool nonlinear : {false, true}) {
        const TestMaterial material = coated("white", 0, 0, 1, nonlinear);
        for (const double degrees : {0.0, 60.0, 85.0}) {
            const Albedo a = albedo(material, tilted_frame(degrees));
            EXPECT_NEAR(a.mean, 1.0, 4.5 * a.error + 1e-4) << degrees;
        }
    }
    // The share of light reflected back, r = 0.5963, from the ratio of both models: for the base
    // alone it is (1 - r) / (1 - rho r).
    const auto base = [](bool nonlinear) {
        TestMaterial material = coated("grey", 0, 0, 0.5f, nonlinear);
        material.components.erase(material.components.begin());
        return mean_weight(material, tilted_frame(30), 0.5f);
    };
    EXPECT_NEAR(base(true) / base(false), (1 - 0.5963) / (1 - 0.5 * 0.5963), 1e-4);
}

// Sampling of visible microfacets is independent of the quadrature of the coat.
TEST(Energy, CoatsTransmitWhatTheirMicrofacetsRefract) {
    for (const uint distribution : {0u, BXDF_FLAG_BECKMANN}) {
        for (const float alpha : {0.05f, 0.3f, 1.0f}) {
            const TestMaterial refraction = {
                "refraction",
                {with_eta(rough(BXDF_MICROFACET_REFRACTION, alpha, alpha, distribution), 1.5f,
                          FRESNEL_DIELECTRIC | BXDF_FLAG_COMPLEMENT)},
                MATERIAL_BOUNDARY};
            const Coat coat{1.5, static_cast<double>(alpha),
                            distribution != 0 ? BxdfComponent::Distribution::beckmann
                                              : BxdfComponent::Distribution::ggx};
            for (const double degrees : {0.0, 60.0, 85.0}) {
                const double refracted =
                    1.5 * 1.5 * mean_weight(refraction, tilted_frame(degrees), 0.5f);
                EXPECT_NEAR(refracted, coat_transmittance(coat, std::cos(degrees * pi / 180)), 1e-3)
                    << alpha << ' ' << degrees;
            }
        }
    }
}

TEST(Energy, InterpolatedTransmittancesHaveTheirErrorBound) {
    for (const uint distribution : {0u, BXDF_FLAG_BECKMANN}) {
        for (const double alpha : {1e-4, 0.01, 0.1, 1.0}) {
            const TestMaterial material = coated("coat", alpha, distribution, 1, false);
            SceneView view{};
            view.coat_transmittances = material.coat_transmittances.data();
            const Coat coat{1.5, alpha,
                            distribution != 0 ? BxdfComponent::Distribution::beckmann
                                              : BxdfComponent::Distribution::ggx};
            for (uint32_t i = 0; i < COAT_NODES - 1; ++i) {
                const double root = (i + 0.5) / (COAT_NODES - 1), c = root * root;
                const float3 w = make_float3(static_cast<float>(std::sqrt((1 - c) * (1 + c))), 0.0f,
                                             static_cast<float>(c));
                EXPECT_NEAR(static_cast<double>(
                                ::coat_transmittance(&view, &material.components.back(), w)),
                            coat_transmittance(coat, c), 5e-4)
                    << alpha << ' ' << c;
            }
        }
    }
}

// As Mitsuba 3.9.1's principled BSDF has them, with no other lobe: white, of roughness 0.7.
TEST(Disney, ComponentsHaveMitsubasValues) {
    const struct {
        float3 wo, wi;
        double diffuse, flat, sheen, coat, glossy_coat;
    } rows[] = {
        {make_float3(0.3f, 0.1f, 0.8f), make_float3(-0.5f, 0.4f, 0.6f), 0.218023, 0.19823,
         3.27821e-05, 0.00340318, 0.00187105},
        {make_float3(0.9f, 0.0f, 0.2f), make_float3(0.8f, 0.3f, 0.1f), 0.0675907, 0.0843765,
         1.59274e-10, 3.89243e-05, 2.00371e-05},
        {make_float3(0.9f, 0.0f, 0.2f), make_float3(-0.8f, 0.1f, 0.25f), 0.077319, 0.111049,
         0.064101, 0.0139634, 0.00844262},
    };
    const float3 n = make_float3(0, 0, 1);
    for (const auto &row : rows) {
        const SurfaceFrame frame =
            make_surface_frame(n, n, make_float3(1, 0, 0), make_float2(0, 0), normalize(row.wo));
        const auto expect_value = [&](const BxdfRecord &record, double wanted) {
            const TestMaterial material = {"disney", {record}};
            EXPECT_NEAR(static_cast<double>(material.evaluate(frame, normalize(row.wi)).f_cos.x),
                        wanted, 2e-5 * wanted + 1e-11)
                << record.kind;
        };
        const auto coat = [](float alpha) {
            return with_eta(rough(BXDF_DISNEY_CLEARCOAT, alpha, alpha), 0.04f, FRESNEL_SCHLICK);
        };
        expect_value(disney_diffuse(0.7f, 0), row.diffuse);
        expect_value(disney_diffuse(0.7f, 0.4f), row.flat);
        expect_value(component(BXDF_DISNEY_SHEEN), row.sheen);
        expect_value(coat(0.1f), row.coat);
        expect_value(coat(0.0109f), row.glossy_coat);
    }
}

// At normal incidence, wo.m is positive for all normals. A distribution whose area projects to 1
// and that loses light only through shadowing keeps nearly all light.
TEST(Energy, NarrowLobesScatterNearlyAll) {
    for (const uint kind : {BXDF_WARD, BXDF_MICROFACET_REFLECTION}) {
        const TestMaterial material = {"narrow", {rough(kind, 0.02f, 0.02f)}};
        EXPECT_NEAR(albedo(material, tilted_frame(30)).mean, 1.0, 2e-3);
    }
    EXPECT_NEAR(albedo({"blinn", {blinn(1e4f)}}, tilted_frame(30)).mean, 1.0, 2e-3);
    const TestMaterial glass = rough_glass("glass", 0.02f, 0.02f, BXDF_FLAG_BECKMANN);
    EXPECT_NEAR(albedo(glass, tilted_frame(30)).mean, 1.0, 2e-3);
    EXPECT_NEAR(albedo(glass, tilted_frame(30, 0.6, false)).mean, 1.0, 2e-3);
}

// The printed car paint multiplies Lambert by 1 - F(wo) only. For light from a grazing angle, the
// scattered fraction exceeds 1. The symmetric car paint stays below 1.
TEST(Energy, PrintedCarPaintIsNotReciprocal) {
    const auto adjoint = [](const TestMaterial &material) {  // light along wi, gathered over all wo
        const SurfaceFrame grazing = tilted_frame(85);
        const float cosine = dot(grazing.wo, grazing.ns);
        double sum = fresnel_dielectric(cosine, squared_sine_of(cosine), 1.5f);  // the coat
        constexpr uint32_t count = 20'000;
        for (uint32_t i = 0; i < count; ++i) {
            const uint4 w = bsdf_words(i, 1001);
            const float3 local = sample_cosine_hemisphere(uniform_float(w.x), uniform_float(w.y));
            SurfaceFrame frame = grazing;
            frame.wo = normalize(frame.x * local.x + frame.y * local.y + frame.ns * local.z);
            const double f = static_cast<double>(material.evaluate(frame, grazing.wo).f_cos.x /
                                                 dot(grazing.wo, frame.ns));
            sum += f * pi / count;
        }
        return sum;
    };
    EXPECT_GT(adjoint(car_paint(true)), 1.3);
    EXPECT_LT(adjoint(car_paint(false)), 1.0);
}

TEST(Energy, AllButThePrintedCarPaintAreReciprocal) {
    for (const TestMaterial &material : materials()) {
        if (material.name == "car paint as printed") {
            continue;
        }
        for (const double theta : {10.0, 60.0, 85.0}) {
            const SurfaceFrame frame = tilted_frame(theta);
            int compared = 0;
            for (uint32_t i = 0; i < 2000; ++i) {
                const uint4 w = bsdf_words(i, 1002);
                const BsdfSample s = material.sample(frame, uniform_float(w.x), uniform_float(w.y),
                                                     uniform_float(w.z));
                if (!(s.pdf_w > 0.0f && s.pdf_w < infinity) ||
                    std::abs(dot(s.wi, frame.ns)) < 1e-3f) {
                    continue;
                }
                // Reciprocity holds for radiance over the squared index of its medium (Veach 1997,
                // section 5.2).
                const float eta = dot(s.wi, frame.ns) < 0.0f ? eta_of(material, frame) : 1.0f;
                const SurfaceFrame back =
                    make_surface_frame(frame.ng, frame.ns, frame.x, frame.uv, s.wi);
                const double forth = static_cast<double>(material.evaluate(frame, s.wi).f_cos.x /
                                                         std::abs(dot(s.wi, frame.ns)));
                const double other = static_cast<double>(material.evaluate(back, frame.wo).f_cos.x /
                                                         std::abs(dot(frame.wo, frame.ns)));
                const double scale = static_cast<double>(eta * eta);
                ASSERT_NEAR(forth * scale, other, 2e-3 * other + 1e-6)
                    << material.name << " at " << theta;
                ++compared;
            }
            EXPECT_TRUE(compared > 500 || material.name.rfind("car paint", 0) == 0)
                << material.name;
        }
    }
}

TEST(Sample, AgreesWithEvaluation) {
    for (const TestMaterial &material : materials()) {
        for (const double theta : {0.0, 50.0, 80.0, 89.9}) {
            for (const bool front : {true, false}) {
                const SurfaceFrame frame = tilted_frame(theta, 2.1, front);
                for (uint32_t i = 0; i < 1000; ++i) {
                    const uint4 w = bsdf_words(i, 1003);
                    const BsdfSample s = material.sample(frame, uniform_float(w.x),
                                                         uniform_float(w.y), uniform_float(w.z));
                    if (!(s.pdf_w > 0.0f && s.pdf_w < infinity)) {
                        continue;
                    }
                    ASSERT_NEAR(length(s.wi), 1.0f, 1e-6f);
                    // Rounding of the world direction matters next to the horizon and in narrow
                    // lobes.
                    if (std::abs(dot(s.wi, frame.ns)) > 1e-3f) {
                        const BsdfValue value = material.evaluate(frame, s.wi);
                        ASSERT_NEAR(value.pdf_w / s.pdf_w, 1.0f, 5e-3f)
                            << material.name << " at " << theta;
                        ASSERT_NEAR(value.f_cos.x / value.pdf_w / s.weight.x, 1.0f, 1e-3f)
                            << material.name << " at " << theta;
                    }
                }
            }
        }
    }
}

// Rough boundaries converge to smooth ones as roughness vanishes.
TEST(Limits, NarrowLobesBecomeDeltas) {
    for (const bool front : {true, false}) {
        const SurfaceFrame frame = tilted_frame(front ? 50 : 30, 0.6, front);
        const TestMaterial smooth = {"glass",
                                     {with_eta(component(BXDF_IDEAL_REFRACTION), 1.5f)},
                                     MATERIAL_BOUNDARY | MATERIAL_DELTA};
        const float3 refracted = smooth.sample(frame, 0, 0, 0).wi;
        const float3 mirrored = 2.0f * dot(frame.ns, frame.wo) * frame.ns - frame.wo;
        const auto expect_close = [&](const TestMaterial &material, float3 direction) {
            float3 mean = make_float3(0, 0, 0);
            double weight = 0;
            constexpr int count = 10'000;
            for (uint32_t i = 0; i < count; ++i) {
                const uint4 w = bsdf_words(i, 1004);
                const BsdfSample s = material.sample(frame, uniform_float(w.x), uniform_float(w.y),
                                                     uniform_float(w.z));
                mean += s.wi / count;
                weight += static_cast<double>(s.weight.x) / count;
            }
            EXPECT_LT(length(mean - direction), 5e-4f) << material.name;  // GGX has long tails
            return weight;
        };
        for (const uint distribution : {0u, BXDF_FLAG_BECKMANN}) {
            const double reflected = expect_close(
                {"reflection", {rough(BXDF_MICROFACET_REFLECTION, 1e-4f, 1e-4f, distribution)}},
                mirrored);
            EXPECT_NEAR(reflected, 1.0, 1e-4);
            const TestMaterial rough_refraction = {
                "refraction",
                {with_eta(rough(BXDF_MICROFACET_REFRACTION, 1e-4f, 1e-4f, distribution), 1.5f)},
                MATERIAL_BOUNDARY};
            const double passed = expect_close(rough_refraction, refracted);
            EXPECT_NEAR(passed, static_cast<double>(smooth.sample(frame, 0, 0, 0).weight.x), 1e-3);
        }
        EXPECT_NEAR(expect_close({"blinn", {blinn(1e7f)}}, mirrored), 1.0, 2e-3);
        EXPECT_NEAR(expect_close({"ward", {rough(BXDF_WARD, 1e-4f, 1e-4f)}}, mirrored), 1.0, 2e-3);
    }
}

// Covers the largest exponent, the smallest roughness, grazing directions, and both ends of the
// range of random numbers.
TEST(Limits, NothingIsEverInfiniteOrNegative) {
    const auto finite = [](float3 v) {
        return std::isfinite(v.x) && std::isfinite(v.y) && std::isfinite(v.z);
    };
    std::vector<TestMaterial> all = materials();
    all.push_back({"blinn 1e7", {blinn(1e7f)}});
    all.push_back({"blinn 0.001", {blinn(1e-3f)}});
    all.push_back({"disney_clearcoat 0.001", {rough(BXDF_DISNEY_CLEARCOAT, 1e-3f, 1e-3f)}});
    for (const uint kind :
         {BXDF_WARD, BXDF_WARD_ORIGINAL, BXDF_MICROFACET_REFLECTION, BXDF_MICROFACET_REFRACTION}) {
        for (const uint distribution : {0u, BXDF_FLAG_BECKMANN}) {
            for (const float eta : {1.5f, 1.0f, 1.00001f, 0.3f}) {
                all.push_back({"narrow",
                               {with_eta(rough(kind, 1e-4f, 1.0f, distribution), eta)},
                               MATERIAL_BOUNDARY});
                all.push_back({"narrowest",
                               {with_eta(rough(kind, 1e-4f, 1e-4f, distribution), eta)},
                               MATERIAL_BOUNDARY});
            }
        }
    }
    const std::array<float, 6> ends = {0.0f, 0x1p-24f, 0.25f, 0.5f, 0.75f, 1.0f - 0x1p-24f};
    for (const TestMaterial &material : all) {
        for (const double theta : {0.0, 1e-3, 41.81, 89.999, 89.99999, 89.9999999, 90.0, 90.0001}) {
            for (const bool front : {true, false}) {
                const SurfaceFrame frame = tilted_frame(theta, 0.0, front);
                for (const float u : ends) {
                    for (const float v : ends) {
                        const BsdfSample s = material.sample(frame, u, v, u);
                        ASSERT_TRUE(finite(s.wi) && finite(s.weight) && s.pdf_w >= 0.0f)
                            << material.name << ' ' << theta;
                        ASSERT_NEAR(length(s.wi), 1.0f, 1e-6f);
                        ASSERT_GE(s.weight.x, 0.0f);
                        // The sampled direction, opposite to wo, along wo, and near the horizon.
                        for (const float3 wi : {s.wi, -frame.wo, frame.wo,
                                                normalize(frame.x + 1e-7f * frame.ns), -frame.x}) {
                            const BsdfValue value = material.evaluate(frame, wi);
                            ASSERT_TRUE(finite(value.f_cos) && std::isfinite(value.pdf_w))
                                << material.name << ' ' << theta;
                            ASSERT_GE(value.pdf_w, 0.0f);
                            ASSERT_GE(value.f_cos.x, 0.0f);
                            ASSERT_TRUE(value.f_cos.x == 0.0f || value.pdf_w > 0.0f)
                                << material.name << ' ' << theta;
                        }
                    }
                }
            }
        }
    }
}

TEST(SurfaceFrame, PutsBothNormalsOnTheViewersSide) {
    for (uint32_t i = 0; i < 10'000; ++i) {
        const uint4 a = bsdf_words(i, 1005), b = bsdf_words(i, 1006);
        const auto direction = [](uint x, uint y) {
            return normalize(sample_uniform_sphere(uniform_float(x), uniform_float(y)));
        };
        const float3 ng = direction(a.x, a.y), ns = direction(a.z, a.w), wo = direction(b.x, b.y);
        const float3 tangent = i % 3 == 0   ? make_float3(0, 0, 0)
                               : i % 3 == 1 ? 1e-25f * direction(b.z, b.w)
                                            : ns * 1e20f;
        const SurfaceFrame frame = make_surface_frame(ng, ns, tangent, make_float2(0, 0), wo);
        ASSERT_EQ(frame.front, dot(ng, wo) >= 0.0f ? 1u : 0u);
        ASSERT_GE(dot(frame.ng, wo), 0.0f);
        ASSERT_GT(dot(frame.ns, wo), 0.0f);
        ASSERT_GE(dot(frame.ns, frame.ng), -1e-6f);
        ASSERT_NEAR(dot(frame.x, frame.y), 0.0f, 1e-6f);
        ASSERT_NEAR(dot(frame.x, frame.ns), 0.0f, 1e-6f);
        ASSERT_NEAR(dot(frame.y, frame.ns), 0.0f, 1e-6f);
        ASSERT_NEAR(length(frame.x), 1.0f, 1e-6f);
        ASSERT_NEAR(length(frame.y), 1.0f, 1e-6f);
        if (i % 3 == 1 && length(cross(normalize(tangent * 1e25f), frame.ns)) > 0.02f) {
            ASSERT_GT(dot(frame.x, tangent * 1e25f), 0.0f);
            ASSERT_NEAR(dot(frame.y, tangent * 1e25f), 0.0f, 1e-4f);
        }
    }
}

TEST(SurfaceFrame, DropsDirectionsBetweenTheTwoHorizons) {
    const float3 ng = make_float3(0, 0, 1), ns = normalize(make_float3(0.6f, 0, 0.8f)),
                 wo = normalize(make_float3(0.3f, 0.1f, 1));
    const SurfaceFrame frame =
        make_surface_frame(ng, ns, make_float3(0, 0, 0), make_float2(0, 0), wo);
    for (const TestMaterial &material : materials()) {
        uint32_t lost = 0;
        for (uint32_t i = 0; i < 20'000; ++i) {
            const uint4 w = bsdf_words(i, 1007);
            const BsdfSample s =
                material.sample(frame, uniform_float(w.x), uniform_float(w.y), uniform_float(w.z));
            // The weight is that of camera paths. Light paths also continue where it is 0.
            if (s.pdf_w > 0.0f && s.weight.x > 0.0f) {
                ASSERT_GT(dot(frame.ng, s.wi) * dot(frame.ns, s.wi), 0.0f) << material.name;
            } else {
                ++lost;
            }
        }
        EXPECT_EQ(material.evaluate(frame, normalize(make_float3(1, 0, -0.1f))).f_cos.x, 0.0f)
            << material.name;
        EXPECT_EQ(material.evaluate(frame, normalize(make_float3(1, 0, -0.1f))).pdf_w, 0.0f)
            << material.name;
        if (material.name == "lambert") {
            EXPECT_GT(lost, 0u);
        }
    }
}

TEST(Material, MayDifferByItsSide) {
    BxdfRecord in_front = component(BXDF_IDEAL_REFLECTION), behind = component(BXDF_LAMBERT);
    in_front.flags |= BXDF_FLAG_FRONT_ONLY;
    behind.flags |= BXDF_FLAG_BACK_ONLY;
    const TestMaterial silvered = {"silvered", {in_front, behind}};
    const TestMaterial mirror = {"mirror", {component(BXDF_IDEAL_REFLECTION)}, MATERIAL_DELTA};
    const TestMaterial diffuse = {"diffuse", {component(BXDF_LAMBERT)}};
    for (const bool front : {true, false}) {
        const SurfaceFrame frame = tilted_frame(40, 0.6, front);
        const TestMaterial &same = front ? mirror : diffuse;
        for (const float select : {0.0f, 0.4f, 0.9f}) {
            const BsdfSample found = silvered.sample(frame, select, 0.3f, 0.6f);
            const BsdfSample expected = same.sample(frame, select, 0.3f, 0.6f);
            EXPECT_EQ(found.pdf_w, expected.pdf_w);
            EXPECT_EQ(found.weight.x, expected.weight.x);
            EXPECT_EQ(found.wi.x, expected.wi.x);
        }
        EXPECT_EQ(silvered.evaluate(frame, frame.ns).f_cos.x,
                  same.evaluate(frame, frame.ns).f_cos.x);
        EXPECT_EQ(silvered.evaluate(frame, frame.ns).pdf_w, same.evaluate(frame, frame.ns).pdf_w);
    }
}

TEST(Material, OneSidedIsBlackFromBehind) {
    const TestMaterial wall = {"wall", {component(BXDF_LAMBERT)}, MATERIAL_ONE_SIDED};
    for (const bool front : {true, false}) {
        const SurfaceFrame frame = tilted_frame(40, 0.6, front);
        EXPECT_EQ(wall.evaluate(frame, frame.ns).f_cos.x > 0.0f, front);
        EXPECT_EQ(wall.evaluate(frame, frame.ns).pdf_w > 0.0f, front);
        EXPECT_EQ(wall.sample(frame, 0.5f, 0.5f, 0.5f).pdf_w > 0.0f, front);
    }
    // The flag does not apply to a boundary, because light that enters must leave again.
    TestMaterial glass = rough_glass("glass", 0.1f, 0.1f, 0);
    glass.flags |= MATERIAL_ONE_SIDED;
    EXPECT_GT(glass.sample(tilted_frame(10, 0.6, false), 0.5f, 0.5f, 0.5f).pdf_w, 0.0f);
    // A material without components is black.
    const TestMaterial black = {"black", {}};
    EXPECT_EQ(black.sample(tilted_frame(10), 0.5f, 0.5f, 0.5f).pdf_w, 0.0f);
    EXPECT_EQ(black.evaluate(tilted_frame(10), tilted_frame(10).ns).f_cos.x, 0.0f);
}

}  // namespace
}  // namespace rtrays
