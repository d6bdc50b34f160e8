// SPDX-License-Identifier: MIT
// Integrals over visible microfacets, in the plane of their slopes. For wo = (s, 0, c) and a facet
// of slopes (p, q), whose normal is along (p, q, 1), the visible area is proportional to
// max(0, c + s p) P(p, q). P is the distribution of slopes (Heitz 2014, "Understanding the
// Masking-Shadowing Function in Microfacet-Based BRDFs", equations 10 and 76).
//
// In polar coordinates, with the radius alpha tan(t) for GGX and alpha t for Beckmann, the
// integrands are smooth but for a bend where facets begin to be invisible. Both integrals are split
// there.
#include "renderer/scene/cores/coat.h"

#include <fmt/format.h>

#include <algorithm>
#include <boost/math/quadrature/gauss.hpp>
#include <cmath>

#include "renderer/base/error.h"
#include "renderer/scene/cores/bxdf_parameters.h"

namespace rtrays {

namespace {

constexpr double pi = 3.14159265358979323846;

/// Returns the integral of f from a to b, by Gauss-Legendre quadrature.
template <typename Function>
double integral(const Function &f, double a, double b) {
    return a < b ? boost::math::quadrature::gauss<double, 30>::integrate(f, a, b) : 0.0;
}

/// The boundary, seen from one side. `eta` is the index beyond it over that on this side.
struct Boundary {
    double eta;
    double alpha;
    bool beckmann;
};

/// Returns the Fresnel reflectance and, if there is refraction, the cosine beyond the boundary.
double reflectance(double cosine, double eta, double &refracted) {
    const double squared = 1 - (1 - cosine) * (1 + cosine) / (eta * eta);
    if (!(squared > 0)) {
        return 1;  // total reflection
    }
    refracted = std::sqrt(squared);
    const double parallel = (eta * cosine - refracted) / (eta * cosine + refracted);
    const double perpendicular = (cosine - eta * refracted) / (cosine + eta * refracted);
    return 0.5 * (parallel * parallel + perpendicular * perpendicular);
}

/// Returns Smith's masking function over the cosine c of a direction. This form is finite for c =
/// 0.
double masking_over_cosine(const Boundary &boundary, double c) {
    const double width = boundary.alpha * std::sqrt((1 - c) * (1 + c));
    if (!boundary.beckmann) {
        return 2 / (c + std::hypot(c, width));
    }
    if (c > 6 * width) {
        return 1 / c;
    }
    const double a = c / width;
    return 2 / (c * (2 - std::erfc(a)) + width * std::exp(-a * a) / std::sqrt(pi));
}

/// Returns the share of light that a facet reflects or transmits and that leaves the surface. `c`
/// and `s` are cosine and sine of wo, `slope` that of the facet along x, `steepness` the root of 1
/// plus the squared length of its slopes.
double scattered(const Boundary &boundary, double c, double s, double slope, double steepness,
                 bool transmitted) {
    const double cosine = std::clamp((c + s * slope) / steepness, 0.0, 1.0);
    double refracted = 0;
    const double reflected = reflectance(cosine, boundary.eta, refracted);
    const double height = transmitted
                              ? (refracted - cosine / boundary.eta) / steepness + c / boundary.eta
                              : 2 * cosine / steepness - c;
    if (!(height > 0)) {
        return 0;
    }
    const double leaving = std::min(height, 1.0);
    return (transmitted ? 1 - reflected : reflected) * leaving *
           masking_over_cosine(boundary, leaving);
}

/// Returns the mean of `scattered` over the facets that are visible at cosine c.
double mean_scattered(const Boundary &boundary, double c, bool transmitted) {
    if (boundary.alpha == 0) {
        double refracted = 0;
        const double reflected = reflectance(c, boundary.eta, refracted);
        return transmitted ? 1 - reflected : reflected;
    }
    const double s = std::sqrt((1 - c) * (1 + c));
    const auto ring = [&](double t) {
        const double x = boundary.beckmann ? t : std::tan(t);
        const double radius = boundary.alpha * x;
        const double steepness = std::hypot(1.0, radius);
        const double last = s * radius > c ? std::acos(-c / (s * radius)) : pi;
        const double sum = integral(
            [&](double phi) {
                const double slope = radius * std::cos(phi);
                return (c + s * slope) * scattered(boundary, c, s, slope, steepness, transmitted);
            },
            0, last);
        const double density = boundary.beckmann ? t * std::exp(-t * t) : std::sin(t) * std::cos(t);
        return density * sum;
    };
    const double end = boundary.beckmann ? 6 : 0.5 * pi;
    const double bend = s > 0 ? c / (s * boundary.alpha) : end;
    const double split = std::min(boundary.beckmann ? bend : std::atan(bend), end);
    return 2 / pi * masking_over_cosine(boundary, c) *
           (integral(ring, 0, split) + integral(ring, split, end));
}

Boundary front(const Coat &coat) {
    return {coat.eta, coat.alpha, coat.distribution == BxdfComponent::Distribution::beckmann};
}

}  // namespace

Coat coat_of(const ParameterSet &parameters, const std::string &eta, const std::string &alpha,
             const std::string &distribution) {
    const double roughness = parameters.number(alpha);
    if (roughness > 0 && roughness < rows::roughness.min) {
        throw input_error(
            fmt::format("{}: {} is out of range; use 0 (ideally smooth) or a value within {}",
                        alpha, roughness, rows::roughness.text()));
    }
    return {parameters.number(eta), roughness,
            parameters.choice<BxdfComponent::Distribution>(distribution)};
}

void set_coat(const Coat &coat, BxdfComponent &bxdf) {
    bxdf.eta.setConstant(coat.eta);
    bxdf.alpha.setConstant(coat.alpha);
    bxdf.distribution = coat.distribution;
}

double coat_transmittance(const Coat &coat, double cosine) {
    return mean_scattered(front(coat), cosine, true);
}

double coat_inner_reflectance(const Coat &coat, double cosine) {
    Boundary inside = front(coat);
    inside.eta = 1 / coat.eta;
    return mean_scattered(inside, cosine, false);
}

double coat_diffuse_reflectance(const Coat &coat) {
    // At the critical angle, the reflectance has the slope of a root.
    const double critical = std::sqrt(1 - 1 / (coat.eta * coat.eta));
    const double below =
        integral([&](double c) { return 2 * c * coat_inner_reflectance(coat, c); }, 0, critical);
    const double above = integral(
        [&](double root) {
            const double c = critical + (1 - critical) * root * root;
            return 2 * c * coat_inner_reflectance(coat, c) * 2 * root * (1 - critical);
        },
        0, 1);
    return below + above;
}

}  // namespace rtrays
