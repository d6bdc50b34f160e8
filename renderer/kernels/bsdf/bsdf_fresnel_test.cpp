// SPDX-License-Identifier: MIT
// Tests Fresnel terms against closed forms and double precision, and ideal reflection and
// refraction.
#include <gtest/gtest.h>

#include <array>
#include <complex>

#include "renderer/testing/bsdf_cases.h"

namespace rtrays {
namespace {

/// Returns the Fresnel reflectance for a complex index (Born and Wolf 1999, 1.5.2). k = 0 gives a
/// dielectric.
double fresnel_double(double cosine, double eta, double k) {
    const std::complex<double> n(eta, k);
    const std::complex<double> cos_t = std::sqrt((n - 1.0) * (n + 1.0) + cosine * cosine) / n;
    const double perpendicular = std::norm((cosine - n * cos_t) / (cosine + n * cos_t));
    const double parallel = std::norm((n * cosine - cos_t) / (n * cosine + cos_t));
    return 0.5 * (perpendicular + parallel);
}

float dielectric(float cosine, float eta) {
    return fresnel_dielectric(cosine, squared_sine_of(cosine), eta);
}

std::vector<float> cosines() {
    std::vector<float> values = {0.0f,    1e-10f, 1e-7f, 1e-5f,
                                 1.7e-5f, 1e-3f,  1.0f,  std::nextafter(1.0f, 0.0f)};
    for (int i = 1; i < 200; ++i) {
        values.push_back(static_cast<float>(i) / 200.0f);
    }
    return values;
}

TEST(Fresnel, DielectricHasItsClosedValues) {
    EXPECT_NEAR(dielectric(1.0f, 1.5f), 0.04f, 1e-7f);
    EXPECT_NEAR(dielectric(1.0f, 1.0f / 1.5f), 0.04f, 1e-7f);
    EXPECT_EQ(dielectric(0.0f, 1.5f), 1.0f);
    // At Brewster's angle, tan = eta, the parallel component is 0 and the other component is
    // ((1 - eta^2) / (1 + eta^2))^2.
    const double eta = 1.5, brewster = 1 / std::sqrt(1 + eta * eta),
                 r = (1 - eta * eta) / (1 + eta * eta);
    EXPECT_NEAR(dielectric(static_cast<float>(brewster), 1.5f), 0.5 * r * r, 1e-7);
    // An index of 1 reflects nothing at any angle.
    for (const float c : cosines()) {
        EXPECT_EQ(dielectric(c, 1.0f), c > 0.0f ? 0.0f : 1.0f);
    }
}

TEST(Fresnel, AgreesWithDoublePrecision) {
    for (const float c : cosines()) {
        for (const float eta : {1.0001f, 1.3f, 1.5f, 1.9f, 2.4f, 10.0f}) {
            EXPECT_NEAR(dielectric(c, eta),
                        fresnel_double(static_cast<double>(c), static_cast<double>(eta), 0), 2e-6)
                << c << ' ' << eta;
        }
        for (const float eta : {0.05f, 0.2f, 1.0f, 1.5f, 3.0f, 1e4f}) {
            for (const float k : {0.0f, 1e-3f, 0.6f, 3.9f, 7.0f, 1e4f}) {
                // An index below 1 has a critical angle. Next to it, an ulp of the cosine changes
                // the result by its square root.
                if (!(k == 0.0f && (eta < 1.0f || c == 0.0f))) {
                    EXPECT_NEAR(fresnel_conductor(c, eta, k),
                                fresnel_double(static_cast<double>(c), static_cast<double>(eta),
                                               static_cast<double>(k)),
                                eta < 1.0f ? 2e-5 : 3e-6)
                        << c << ' ' << eta << ' ' << k;
                }
            }
        }
    }
}

// The reflectance along a refracted direction equals that along the incident direction.
TEST(Fresnel, DielectricIsReciprocal) {
    for (const float c : cosines()) {
        const float cos_t = refracted_cosine(c, squared_sine_of(c), 1.5f);
        EXPECT_NEAR(dielectric(c, 1.5f), dielectric(cos_t, 1.0f / 1.5f), c < 1e-3f ? 5e-3f : 2e-4f)
            << c;
    }
}

TEST(Fresnel, StaysInRangeNextToTheCriticalAngle) {
    for (const float eta : {1.0f / 1.3f, 1.0f / 1.5f, 1.0f / 2.4f, 0.9999f}) {
        const float critical = std::sqrt((1.0f - eta) * (1.0f + eta));
        float below = critical, above = critical;
        for (int i = 0; i < 50; ++i) {
            below = std::nextafter(below, 0.0f);
            above = std::nextafter(above, 1.0f);
        }
        for (float c = below; c <= above; c = std::nextafter(c, 1.0f)) {
            const float f = dielectric(c, eta);
            EXPECT_GE(f, 0.0f);
            EXPECT_LE(f, 1.0f);
            EXPECT_GT(f, 0.95f);
        }
        EXPECT_EQ(dielectric(below, eta), 1.0f);
        EXPECT_LT(dielectric(above, eta), 1.0f);
    }
}

// Light leaves a high index at a grazing angle. The direction inside, rounded to float, determines
// the result.
TEST(Fresnel, KeepsTheDigitsOfADirectionWithinAHighIndex) {
    for (const double eta : {1.5, 3.0, 100.0}) {
        for (const double degrees : {0.0, 60.0, 85.0, 89.0, 89.9}) {
            const double sine = std::sin(degrees * pi / 180) / eta;
            const float3 wo =
                make_float3(static_cast<float>(0.6 * sine), static_cast<float>(0.8 * sine),
                            static_cast<float>(std::sqrt((1 - sine) * (1 + sine))));
            const double x = static_cast<double>(wo.x), y = static_cast<double>(wo.y);
            const double index = static_cast<double>(static_cast<float>(1 / eta));
            const double s2 = x * x + y * y, outside = std::sqrt(1 - s2 / (index * index));
            EXPECT_NEAR(refracted_cosine(wo.z, squared_sine(wo), static_cast<float>(index)),
                        outside, 4e-7 / outside)
                << eta << ' ' << degrees;
            EXPECT_NEAR(fresnel_dielectric(wo.z, squared_sine(wo), static_cast<float>(index)),
                        fresnel_double(outside, 1 / index, 0), 4e-6 / outside)
                << eta << ' ' << degrees;
        }
    }
}

// Gold at 550 nm (P. Johnson, R. Christy 1972). Thesis (3.28) is an approximation.
TEST(Fresnel, ApproximateConductorIsCloseToTheExactOne) {
    double largest = 0;
    for (const float c : cosines()) {
        const float exact = fresnel_conductor(c, 0.42f, 2.35f),
                    approximate = fresnel_conductor_approximate(c, 0.42f, 2.35f);
        largest = std::max(largest, std::abs(static_cast<double>(exact - approximate)));
    }
    EXPECT_GT(largest, 0.005);
    EXPECT_LT(largest, 0.006);
    EXPECT_NEAR(fresnel_conductor_approximate(1.0f, 0.42f, 2.35f),
                fresnel_double(1.0, 0.42f, 2.35f), 1e-6);
}

TEST(Fresnel, SchlickHasItsClosedValues) {
    EXPECT_EQ(fresnel_schlick(1.0f, 0.04f), 0.04f);
    EXPECT_EQ(fresnel_schlick(0.0f, 0.04f), 1.0f);
    EXPECT_NEAR(fresnel_schlick(0.5f, 0.04f), 0.04f + 0.96f / 32.0f, 1e-7f);
}

// Thesis (3.52): microfacet components evaluate F of the weight at the half vector. Diffuse
// components evaluate it at the normal, for both directions.
TEST(Fresnel, IsMetAtTheHalfVectorOrTheNormal) {
    const SurfaceFrame frame = tilted_frame(50);
    const float3 wi = normalize(0.9f * frame.ns - 0.3f * frame.x + 0.6f * frame.y);
    const float half_cosine = dot(normalize(wi + frame.wo), frame.wo);
    const auto ratio = [&](BxdfRecord record, uint flags) {
        const TestMaterial without = {"ideal", {record}},
                           with = {"fresnel", {with_eta(record, 1.5f, flags)}};
        return with.evaluate(frame, wi).f_cos.x / without.evaluate(frame, wi).f_cos.x;
    };
    for (const BxdfRecord &record :
         {blinn(20), rough(BXDF_WARD, 0.5f, 0.3f), rough(BXDF_WARD_ORIGINAL, 0.5f, 0.3f),
          rough(BXDF_MICROFACET_REFLECTION, 0.5f, 0.3f),
          rough(BXDF_MICROFACET_REFLECTION, 0.5f, 0.3f, BXDF_FLAG_BECKMANN)}) {
        EXPECT_NEAR(ratio(record, FRESNEL_DIELECTRIC), dielectric(half_cosine, 1.5f), 1e-6f)
            << record.kind;
        EXPECT_NEAR(ratio(record, FRESNEL_DIELECTRIC | BXDF_FLAG_COMPLEMENT),
                    1.0f - dielectric(half_cosine, 1.5f), 1e-6f);
    }
    const float f_i = dielectric(dot(wi, frame.ns), 1.5f),
                f_o = dielectric(dot(frame.wo, frame.ns), 1.5f);
    for (const BxdfRecord &record : {component(BXDF_LAMBERT), oren_nayar(0.7f)}) {
        EXPECT_NEAR(ratio(record, FRESNEL_DIELECTRIC | BXDF_FLAG_COMPLEMENT), (1 - f_i) * (1 - f_o),
                    1e-6f);
        EXPECT_NEAR(
            ratio(record, FRESNEL_DIELECTRIC | BXDF_FLAG_COMPLEMENT | BXDF_FLAG_FRESNEL_OF_WO),
            1 - f_o, 1e-6f);
    }
    // The channels of a metal are independent.
    BxdfRecord metal = rough(BXDF_MICROFACET_REFLECTION, 0.3f, 0.3f, FRESNEL_CONDUCTOR);
    const std::array<float, 3> eta = {0.143f, 0.375f, 1.442f}, k = {3.983f, 2.386f, 1.603f};
    std::copy_n(eta.data(), 3, metal.eta);
    std::copy_n(k.data(), 3, metal.k);
    const float3 gold = TestMaterial{"gold", {metal}}.evaluate(frame, wi).f_cos;
    EXPECT_NEAR(
        gold.x / gold.z,
        fresnel_conductor(half_cosine, eta[0], k[0]) / fresnel_conductor(half_cosine, eta[2], k[2]),
        1e-5f);
}

TEST(IdealReflection, MirrorsAboutTheNormal) {
    const TestMaterial mirror = {"mirror", {component(BXDF_IDEAL_REFLECTION)}, MATERIAL_DELTA};
    const SurfaceFrame frame = tilted_frame(70);
    const BsdfSample s = mirror.sample(frame, 0.3f, 0.1f, 0.9f);
    EXPECT_EQ(s.pdf_w, std::numeric_limits<float>::infinity());
    EXPECT_EQ(s.weight.x, 1.0f);
    EXPECT_NEAR(dot(s.wi, frame.ns), dot(frame.wo, frame.ns), 1e-6f);
    EXPECT_NEAR(dot(s.wi + frame.wo, frame.x), 0.0f, 1e-6f);
    EXPECT_NEAR(dot(s.wi + frame.wo, frame.y), 0.0f, 1e-6f);
    EXPECT_EQ(mirror.evaluate(frame, s.wi).pdf_w, 0.0f);
    EXPECT_EQ(mirror.evaluate(frame, s.wi).f_cos.x, 0.0f);
}

/// Smooth glass of index 1.5, thesis (3.53).
const TestMaterial glass = {
    "glass",
    {with_eta(component(BXDF_IDEAL_REFLECTION), 1.5f, FRESNEL_DIELECTRIC),
     with_eta(component(BXDF_IDEAL_REFRACTION), 1.5f, FRESNEL_DIELECTRIC | BXDF_FLAG_COMPLEMENT)},
    MATERIAL_BOUNDARY | MATERIAL_DELTA};

TEST(IdealRefraction, BendsBySnell) {
    for (const bool front : {true, false}) {
        for (const double theta : {0.0, 20.0, 41.0}) {
            const SurfaceFrame frame = tilted_frame(theta, 0.6, front);
            EXPECT_EQ(frame.front, front ? 1u : 0u);
            const BsdfSample s = glass.sample(frame, 0.0f, 0.1f, 0.9f);
            ASSERT_LT(dot(s.wi, frame.ns), 0.0f);
            const double eta = front ? 1.5 : 1 / 1.5;
            const double sine = std::sin(theta * pi / 180) / eta;
            EXPECT_NEAR(dot(s.wi, frame.ns), -std::sqrt(1 - sine * sine), 2e-6);
            EXPECT_NEAR(length(cross(s.wi, frame.ns)), sine, 1e-6);
            EXPECT_NEAR(dot(cross(s.wi, frame.wo), frame.ns), 0.0f, 1e-6f);
            // The component is selected with the Fresnel term as probability. The remaining weight
            // is the scale of radiance, 1 / eta^2.
            EXPECT_NEAR(s.weight.x, 1 / (eta * eta), 1e-6);
        }
    }
}

/// Returns a component of a thin plate of index 1.5.
BxdfRecord of_plate(uint kind, uint flags) {
    BxdfRecord record = with_eta(component(kind), 1.0f, FRESNEL_THIN_DIELECTRIC | flags);
    record.eta[1] = 1.5f;
    return record;
}

// Born and Wolf 1999, 7.6: R, then T R^(2n + 1) T for n = 0, 1, ...
TEST(ThinDielectric, SumsTheReflectionsInsideAPlate) {
    for (const float c : cosines()) {
        const double r = static_cast<double>(dielectric(c, 1.5f));
        double sum = r;
        for (double inner = r; inner > 1e-12 && r < 1; inner *= r * r) {
            sum += (1 - r) * (1 - r) * inner;
        }
        EXPECT_NEAR(fresnel_thin_dielectric(c, squared_sine_of(c), 1.5f), sum, 1e-6) << c;
    }
    EXPECT_NEAR(fresnel_thin_dielectric(1.0f, 0.0f, 1.5f), 1.0 / 13, 1e-7);
    EXPECT_EQ(fresnel_thin_dielectric(0.1f, squared_sine_of(0.1f), 0.5f),
              1.0f);  // total reflection
}

TEST(ThinDielectric, PassesStraightThroughEitherSide) {
    const TestMaterial plate = {"plate",
                                {of_plate(BXDF_IDEAL_REFLECTION, 0u),
                                 of_plate(BXDF_IDEAL_REFRACTION, BXDF_FLAG_COMPLEMENT)},
                                MATERIAL_BOUNDARY | MATERIAL_DELTA};
    for (const bool front : {true, false}) {
        const SurfaceFrame frame = tilted_frame(60, 0.6, front);
        constexpr int count = 1 << 12;
        int passed = 0;
        for (int i = 0; i < count; ++i) {
            const BsdfSample s =
                plate.sample(frame, (static_cast<float>(i) + 0.5f) / count, 0.5f, 0.5f);
            ASSERT_NEAR(s.weight.x, 1.0f, 1e-6f);
            if (dot(s.wi, frame.ns) < 0.0f) {
                ++passed;
                ASSERT_NEAR(dot(s.wi, frame.wo), -1.0f, 1e-6f);
                ASSERT_EQ(s.scale, 1.0f);
            }
        }
        const double r = fresnel_double(0.5, 1.5, 0);
        EXPECT_NEAR(static_cast<double>(passed) / count, (1 - r) / (1 + r), 1.0 / count);
    }
}

TEST(IdealRefraction, IsChosenByItsFresnelTerm) {
    const SurfaceFrame frame = tilted_frame(75);
    const auto expected = fresnel_double(std::cos(75 * pi / 180), 1.5, 0);
    constexpr int count = 1 << 20;
    int reflected = 0;
    for (int i = 0; i < count; ++i) {
        const BsdfSample s =
            glass.sample(frame, (static_cast<float>(i) + 0.5f) / count, 0.5f, 0.5f);
        reflected += dot(s.wi, frame.ns) > 0.0f ? 1 : 0;
        ASSERT_EQ(s.pdf_w, std::numeric_limits<float>::infinity());
    }
    EXPECT_NEAR(static_cast<double>(reflected) / count, expected, 3e-6);  // `select` is stratified
}

TEST(IdealRefraction, LosesNothingAtTotalReflection) {
    for (const double theta : {42.0, 60.0, 89.999}) {
        const SurfaceFrame frame = tilted_frame(theta, 0.6, false);
        for (const float select : {0.0f, 0.5f, 0.99999994f}) {
            const BsdfSample s = glass.sample(frame, select, 0.5f, 0.5f);
            EXPECT_GT(dot(s.wi, frame.ns), 0.0f);
            EXPECT_EQ(s.weight.x, 1.0f);
        }
    }
    // Refraction alone is black under total internal reflection, thesis (3.41).
    const TestMaterial bare = {"bare",
                               {with_eta(component(BXDF_IDEAL_REFRACTION), 1.5f)},
                               MATERIAL_BOUNDARY | MATERIAL_DELTA};
    EXPECT_EQ(bare.sample(tilted_frame(60, 0.6, false), 0.5f, 0.5f, 0.5f).pdf_w, 0.0f);
    EXPECT_GT(bare.sample(tilted_frame(60, 0.6, true), 0.5f, 0.5f, 0.5f).pdf_w, 0.0f);
}

// Within an ulp of the cosine around the critical angle, values are finite and energy is conserved.
TEST(IdealRefraction, HoldsNextToTheCriticalAngle) {
    double theta = std::asin(1 / 1.5) * 180 / pi - 1e-5;
    for (int i = 0; i < 200; ++i, theta += 1e-7) {
        const SurfaceFrame frame = tilted_frame(theta, 0.6, false);
        for (const float select : {0.0f, 0.5f, 0.99999994f}) {
            const BsdfSample s = glass.sample(frame, select, 0.5f, 0.5f);
            ASSERT_TRUE(std::isfinite(s.weight.x) && std::isfinite(s.wi.x));
            ASSERT_LE(s.weight.x, 2.2501f);
            ASSERT_NEAR(length(s.wi), 1.0f, 1e-6f);
        }
    }
}

}  // namespace
}  // namespace rtrays
