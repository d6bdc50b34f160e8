// SPDX-License-Identifier: MIT
// Chi-square tests of directional samplers: samples counted in the cells of a grid over the sphere
// against the integral of the density over each cell. What the density lacks to 1 (rejected
// samples, delta events) is a cell of its own.
#pragma once

#include <functional>
#include <optional>

#include "reference/math.h"
#include "reference/rng.h"

namespace rtrays::reference {

/// Integral of f(x, y) over [x0, x1] x [y0, y1]: nested Gauss-Legendre rules, cells divided until
/// they agree to `tolerance` or 2^-depth of the edge is reached.
double integrate(const std::function<double(double, double)> &f, double x0, double x1, double y0,
                 double y1, double tolerance, int depth);

/// Integral of a function over the directions of the sphere.
double integrate_sphere(const std::function<double(const Vec3 &)> &f, double tolerance);

using DirectionSampler = std::function<std::optional<Vec3>(Rng &)>;
using DirectionDensity = std::function<double(const Vec3 &)>;

struct SamplerCheck {
    double p_value;
    double total;  ///< integral of the density
};

/// Equal-area cells of cos(theta) and phi; none straddles the horizon z = 0.
SamplerCheck check_sampler(const DirectionSampler &sample, const DirectionDensity &pdf_w,
                           int samples, Rng &rng);

/// For reflection lobes too sharp for that grid: cells of the slopes of the half vector, up to six
/// times `width` from zero. Cells in which a reflected direction falls below the horizon must not
/// matter.
SamplerCheck check_sharp_sampler(const DirectionSampler &sample, const DirectionDensity &pdf_w,
                                 const Vec3 &wo, const Eigen::Vector2d &width, int samples,
                                 Rng &rng);

}  // namespace rtrays::reference
