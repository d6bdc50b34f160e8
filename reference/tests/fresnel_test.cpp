// SPDX-License-Identifier: MIT
#include "reference/fresnel.h"

#include <gtest/gtest.h>

namespace rtrays::reference {
namespace {

/// Returns the reflectance by Fresnel's sine and tangent laws (Born & Wolf 1999, 1.5.2, eq. 21a),
/// which the code does not use.
double by_sines_and_tangents(double angle_i, double eta) {
    const double angle_t = std::asin(std::sin(angle_i) / eta);
    const double s = std::sin(angle_i - angle_t) / std::sin(angle_i + angle_t);
    const double p = std::tan(angle_i - angle_t) / std::tan(angle_i + angle_t);
    return 0.5 * (s * s + p * p);
}

TEST(Fresnel, dielectric_has_its_tabulated_values) {
    // Hecht, Optics, 4.6. At normal incidence, glass (1.5) reflects 4 % and water (4/3) 2.04 %. At
    // Brewster's angle only the perpendicular half is reflected: ((n^2 - 1) / (n^2 + 1))^2 / 2.
    EXPECT_NEAR(fresnel_dielectric(1.0, 1.5), 0.04, 1e-15);
    EXPECT_NEAR(fresnel_dielectric(1.0, 4.0 / 3.0), 1.0 / 49.0, 1e-15);
    EXPECT_NEAR(fresnel_dielectric(std::cos(std::atan(1.5)), 1.5), 0.5 * square(1.25 / 3.25),
                1e-14);
    EXPECT_EQ(fresnel_dielectric(0.0, 1.5), 1.0);
    for (const double eta : {1.3, 1.6, 1.9, 3.0, 1.0 / 1.3, 1.0 / 1.9}) {
        for (double angle = 0.02; angle < 0.5 * pi; angle += 0.02) {
            const double expected = std::sin(angle) < eta ? by_sines_and_tangents(angle, eta) : 1.0;
            ASSERT_NEAR(fresnel_dielectric(std::cos(angle), eta), expected, 1e-12)
                << eta << " " << angle;
        }
    }
}

TEST(Fresnel, dielectric_behaves_at_its_edges) {
    for (double c = 0.0; c <= 1.0; c += 0.125) {
        EXPECT_EQ(fresnel_dielectric(c, 1.0), 0.0);
    }
    EXPECT_LT(fresnel_dielectric(0.5, 1.0 + 1e-6), 1e-11);
    // One ulp of the cosine on both sides of the critical angle of 1 / 1.5. The reflectance is
    // continuous, with the slope of a root.
    const double critical = std::sqrt(1.0 - square(1.0 / 1.5));
    EXPECT_EQ(fresnel_dielectric(std::nextafter(critical, 0.0) - 1e-15, 1.0 / 1.5), 1.0);
    EXPECT_NEAR(fresnel_dielectric(std::nextafter(critical, 1.0) + 1e-15, 1.0 / 1.5), 1.0, 1e-6);
    // Both sides of a boundary have the same reflectance.
    for (double c = 0.1; c < 1.0; c += 0.1) {
        EXPECT_NEAR(fresnel_dielectric(c, 1.5),
                    fresnel_dielectric(refracted_cosine(c, 1.5), 1.0 / 1.5), 1e-14);
    }
}

/// Returns the reflectance in Born & Wolf's form with real numbers (1999, 14.2; as in Lazanyi &
/// Szirmay-Kalos 2005, eq. 1).
double conductor_by_reals(double c, double eta, double k) {
    const double s2 = 1.0 - c * c, t0 = eta * eta - k * k - s2;
    const double a2_b2 = std::sqrt(t0 * t0 + 4.0 * eta * eta * k * k);
    const double a = std::sqrt(0.5 * (a2_b2 + t0));
    const double s = (a2_b2 + c * c - 2.0 * a * c) / (a2_b2 + c * c + 2.0 * a * c);
    const double p = s * (c * c * a2_b2 + s2 * s2 - 2.0 * a * c * s2) /
                     (c * c * a2_b2 + s2 * s2 + 2.0 * a * c * s2);
    return 0.5 * (s + p);
}

TEST(Fresnel, conductor_agrees_with_the_real_form_and_with_dielectrics) {
    for (const auto &[eta, k] : {std::pair(0.155, 3.6), std::pair(0.2, 3.1), std::pair(1.44, 7.6),
                                 std::pair(3.0, 3.0), std::pair(0.05, 0.4)}) {
        EXPECT_NEAR(fresnel_conductor(1.0, eta, k),
                    (square(eta - 1) + square(k)) / (square(eta + 1) + square(k)), 1e-14);
        for (double c = 0.01; c <= 1.0; c += 0.01) {
            ASSERT_NEAR(fresnel_conductor(c, eta, k), conductor_by_reals(c, eta, k), 1e-10);
        }
    }
    for (double c = 0.05; c <= 1.0; c += 0.05) {
        EXPECT_NEAR(fresnel_conductor(c, 1.5, 0.0), fresnel_dielectric(c, 1.5), 1e-14);
        EXPECT_NEAR(fresnel_conductor(c, 1.0 / 1.5, 0.0), fresnel_dielectric(c, 1.0 / 1.5), 1e-14);
    }
    EXPECT_EQ(fresnel_conductor(0.0, 0.2, 3.0), 1.0);
}

TEST(Fresnel, approximations_are_as_close_as_stated) {
    double largest = 0.0;
    for (double c = 0.0; c <= 1.0; c += 0.001) {
        largest = std::max(largest, std::abs(fresnel_conductor(c, 1.44, 7.6) -
                                             fresnel_conductor_approximate(c, 1.44, 7.6)));
    }
    EXPECT_LT(largest, 0.006);
    EXPECT_GT(largest, 1e-4);  // the two formulas are not the same
    EXPECT_DOUBLE_EQ(fresnel_conductor_approximate(1.0, 0.2, 3.1),
                     fresnel_conductor(1.0, 0.2, 3.1));
    EXPECT_DOUBLE_EQ(fresnel_schlick(1.0, 0.04), 0.04);
    EXPECT_DOUBLE_EQ(fresnel_schlick(0.0, 0.04), 1.0);
    EXPECT_DOUBLE_EQ(fresnel_schlick(0.5, 0.04), 0.04 + 0.96 / 32.0);
}

TEST(Fresnel, factor_knows_its_channels_complement_and_side) {
    BxdfComponent component;
    EXPECT_TRUE(Fresnel(component).is_ideal());
    component.fresnel = BxdfComponent::Fresnel::conductor;
    component.eta = {0.2, 0.9, 1.5};
    component.k = {3.9, 2.4, 1.9};
    const Spectrum f = Fresnel(component).evaluate(0.7, false);
    for (int i = 0; i < 3; ++i) {
        EXPECT_EQ(f[i], fresnel_conductor(0.7, component.eta[i], component.k[i]));
    }
    component.complement = true;
    EXPECT_TRUE((Fresnel(component).evaluate(0.7, false) == 1.0 - f).all());
    component.complement = false;
    component.fresnel = BxdfComponent::Fresnel::dielectric;
    component.eta.setConstant(1.5);
    EXPECT_EQ(Fresnel(component).evaluate(0.3, true)[0], fresnel_dielectric(0.3, 1.0 / 1.5));
}

}  // namespace
}  // namespace rtrays::reference
