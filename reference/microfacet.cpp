// SPDX-License-Identifier: MIT
#include "reference/microfacet.h"

#include <algorithm>

namespace rtrays::reference {

namespace {

using Kind = BxdfComponent::Distribution;

const double inv_sqrt_pi = 1.0 / std::sqrt(pi);

/// Samples a visible normal of the unit GGX hemisphere seen from `v` (Heitz 2018, "Sampling the GGX
/// Distribution of Visible Normals", listing 1).
Vec3 sample_hemisphere_visible(const Vec3 &v, Rng &rng) {
    // T1 must be horizontal, because the lower half of the projected hemisphere shrinks along T2.
    const double horizontal = std::hypot(v.x(), v.y());
    const Vec3 t1 =
        horizontal > 0.0 ? Vec3(-v.y() / horizontal, v.x() / horizontal, 0.0) : Vec3::UnitX();
    const Vec3 t2 = v.cross(t1);
    const double radius = std::sqrt(rng.uniform());
    const double phi = 2.0 * pi * rng.uniform();
    const double p1 = radius * std::cos(phi);
    const double visible = 0.5 * (1.0 + v.z());
    const double p2 = (1.0 - visible) * std::sqrt(std::max(0.0, 1.0 - p1 * p1)) +
                      visible * radius * std::sin(phi);
    // Rounding can push the point off the disc by an ulp, so the root's argument is clamped to 0.
    return p1 * t1 + p2 * t2 + std::sqrt(std::max(0.0, 1.0 - p1 * p1 - p2 * p2)) * v;
}

/// Samples the slope of a visible normal along the azimuth of the view direction, for a Beckmann
/// surface of roughness 1.
///
/// Let c and s be the cosine and sine of the view angle. Visible slopes have a density proportional
/// to (c - s x) exp(-x^2) for x < c / s (Heitz & d'Eon 2014, "Importance Sampling Microfacet-Based
/// BSDFs using the Distribution of Visible Normals", 4.1). The integral of the density from minus
/// infinity is
///
///     P(x) = c / 2 erfc(-x) + s / (2 sqrt(pi)) exp(-x^2),
///
/// a sum of positive terms. P is inverted by Newton steps. A step that leaves the bracket is
/// replaced by a bisection.
double sample_beckmann_slope(double c, double s, Rng &rng) {
    const auto integral = [&](double x) {
        return 0.5 * c * std::erfc(-x) + 0.5 * s * inv_sqrt_pi * std::exp(-x * x);
    };
    // The density is negligible in double beyond |x| = 26.
    double low = -26.0;
    double high = c < 26.0 * s ? c / s : 26.0;
    const double target = rng.uniform() * integral(high);
    double x = std::min(0.0, 0.5 * high);
    for (int i = 0; i < 100; ++i) {
        const double excess = integral(x) - target;
        (excess > 0.0 ? high : low) = x;
        const double slope = (c - s * x) * inv_sqrt_pi * std::exp(-x * x);
        double next = x - excess / slope;
        if (!(next > low && next < high)) {
            next = 0.5 * (low + high);
        }
        if (std::abs(next - x) <= 1e-14 * (1.0 + std::abs(x))) {
            return next;
        }
        x = next;
    }
    return x;  // the bracket is 26 / 2^100 wide, or steps alternate between neighbours
}

}  // namespace

double MicrofacetDistribution::density(const Vec3 &h) const {
    const double x = h.x() / alpha_.x(), y = h.y() / alpha_.y(), z_squared = square(h.z());
    const double norm = pi * alpha_.x() * alpha_.y();
    if (kind_ == Kind::ggx) {
        return 1.0 / (norm * square(x * x + y * y + z_squared));
    }
    // A normal within 1e-75 of the horizon would give 0 / 0.
    return z_squared > 1e-150 ? std::exp(-(x * x + y * y) / z_squared) / (norm * square(z_squared))
                              : 0.0;
}

double MicrofacetDistribution::masking(const Vec3 &v, const Vec3 &h) const {
    if (!(v.dot(h) * v.z() > 0.0)) {
        return 0.0;
    }
    // Roughness along v times the tangent of the polar angle. It is infinite at the horizon, where
    // G1 is 0.
    const double slope = std::hypot(alpha_.x() * v.x(), alpha_.y() * v.y()) / std::abs(v.z());
    if (kind_ == Kind::ggx) {
        return 2.0 / (1.0 + std::sqrt(1.0 + square(slope)));
    }
    const double a = 1.0 / slope;  // infinite along the normal, where erf is 1 and the tail 0
    const double tail = a < 26.0 ? 0.5 * inv_sqrt_pi * std::exp(-a * a) * slope : 0.0;
    return 1.0 / (0.5 * (1.0 + std::erf(a)) + tail);
}

double MicrofacetDistribution::pdf_visible(const Vec3 &wo, const Vec3 &h) const {
    const double cosine = wo.dot(h);
    return cosine > 0.0 ? masking(wo, h) * cosine * density(h) / wo.z() : 0.0;
}

Vec3 MicrofacetDistribution::sample_visible(const Vec3 &wo, Rng &rng) const {
    // Stretching by the roughness makes the surface isotropic with roughness 1.
    const Vec3 stretched = Vec3(alpha_.x() * wo.x(), alpha_.y() * wo.y(), wo.z()).normalized();
    if (kind_ == Kind::ggx) {
        const Vec3 m = sample_hemisphere_visible(stretched, rng);
        // Rounding alone could make the normal face down.
        return Vec3(alpha_.x() * m.x(), alpha_.y() * m.y(), std::max(m.z(), 1e-300)).normalized();
    }
    const double s = std::hypot(stretched.x(), stretched.y());
    const double along = sample_beckmann_slope(stretched.z(), s, rng);
    // The slope across the azimuth is normally distributed with variance 1/2 for any view (Box &
    // Muller 1958).
    const double radius = std::sqrt(-std::log(1.0 - rng.uniform()));
    const double across = radius * std::cos(2.0 * pi * rng.uniform());
    const double cos_phi = s > 0.0 ? stretched.x() / s : 1.0;
    const double sin_phi = s > 0.0 ? stretched.y() / s : 0.0;
    const double slope_x = alpha_.x() * (cos_phi * along - sin_phi * across);
    const double slope_y = alpha_.y() * (sin_phi * along + cos_phi * across);
    return Vec3(-slope_x, -slope_y, 1.0).normalized();
}

}  // namespace rtrays::reference
