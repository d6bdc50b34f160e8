// SPDX-License-Identifier: MIT
// Chi-square tests of directional samplers.
//
// Samples are counted in the cells of a grid over the sphere and compared with the integral of the
// density over each cell. The probability that the density lacks to 1 (rejected samples, delta
// events) has its own cell.
#pragma once

#include <functional>
#include <optional>

#include "reference/math.h"
#include "reference/rng.h"

namespace rtrays::reference {

/// Returns the integral of f(x, y) over [x0, x1] x [y0, y1]. It uses nested Gauss-Legendre rules
/// and divides cells until they agree to `tolerance` or 2^-depth of the edge is reached.
double integrate(const std::function<double(double, double)> &f, double x0, double x1, double y0,
                 double y1, double tolerance, int depth);

/// Returns the integral of a function over the directions of the sphere.
double integrate_sphere(const std::function<double(const Vec3 &)> &f, double tolerance);

using DirectionSampler = std::function<std::optional<Vec3>(Rng &)>;
using DirectionDensity = std::function<double(const Vec3 &)>;

/// Result of a chi-square test.
struct SamplerCheck {
    double p_value;
    double total;  ///< integral of the density
};

/// Tests a sampler on equal-area cells of cos(theta) and phi. No cell straddles the horizon z = 0.
SamplerCheck check_sampler(const DirectionSampler &sample, const DirectionDensity &pdf_w,
                           int samples, Rng &rng);

/// Tests the sampler of a reflection lobe that is too sharp for that grid. The cells are slopes of
/// the half vector, up to six times `width` from zero. Cells in which a reflected direction falls
/// below the horizon must be negligible.
SamplerCheck check_sharp_sampler(const DirectionSampler &sample, const DirectionDensity &pdf_w,
                                 const Vec3 &wo, const Eigen::Vector2d &width, int samples,
                                 Rng &rng);

}  // namespace rtrays::reference
