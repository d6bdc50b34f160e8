// SPDX-License-Identifier: MIT
#include "reference/tests/sphere_grid.h"

#include <boost/math/quadrature/gauss.hpp>
#include <numeric>
#include <vector>

#include "renderer/testing/chi_square.h"

namespace rtrays::reference {

namespace {

using Rule = boost::math::quadrature::gauss<double, 7>;
using Function = std::function<double(double, double)>;

double apply_rule(const Function &f, double x0, double x1, double y0, double y1) {
    return Rule::integrate(
        [&](double x) { return Rule::integrate([&](double y) { return f(x, y); }, y0, y1); }, x0,
        x1);
}

double refine(const Function &f, double x0, double x1, double y0, double y1, double coarse,
              double tolerance, int depth) {
    const double xm = 0.5 * (x0 + x1), ym = 0.5 * (y0 + y1);
    const double parts[4] = {apply_rule(f, x0, xm, y0, ym), apply_rule(f, xm, x1, y0, ym),
                             apply_rule(f, x0, xm, ym, y1), apply_rule(f, xm, x1, ym, y1)};
    const double fine = parts[0] + parts[1] + parts[2] + parts[3];
    if (depth == 0 || std::abs(fine - coarse) <= tolerance) {
        return fine;
    }
    return refine(f, x0, xm, y0, ym, parts[0], 0.25 * tolerance, depth - 1) +
           refine(f, xm, x1, y0, ym, parts[1], 0.25 * tolerance, depth - 1) +
           refine(f, x0, xm, ym, y1, parts[2], 0.25 * tolerance, depth - 1) +
           refine(f, xm, x1, ym, y1, parts[3], 0.25 * tolerance, depth - 1);
}

constexpr int rows = 20;  // cells of cos(theta); even, so that none straddles the horizon
constexpr int columns = 24;
constexpr int slope_cells = 24;
constexpr double slope_range = 6.0;

Vec3 direction(double z, double phi) {
    const double sine = std::sqrt((1.0 - z) * (1.0 + z));
    return {sine * std::cos(phi), sine * std::sin(phi), z};
}

SamplerCheck decide(std::vector<uint64_t> observed, std::vector<double> expected, int samples) {
    const double total = std::accumulate(expected.begin(), expected.end(), 0.0);
    // The integrals are accurate to 1e-5, so the remaining probability may be that large.
    expected.push_back(std::max(1.0 - total, 1e-5));
    for (double &e : expected) {
        e *= samples;
    }
    return {chi_square_p(observed, expected), total};
}

}  // namespace

double integrate(const Function &f, double x0, double x1, double y0, double y1, double tolerance,
                 int depth) {
    return refine(f, x0, x1, y0, y1, apply_rule(f, x0, x1, y0, y1), tolerance, depth);
}

double integrate_sphere(const std::function<double(const Vec3 &)> &f, double tolerance) {
    double total = 0.0;
    for (int row = 0; row < rows; ++row) {
        for (int column = 0; column < columns; ++column) {
            total += integrate([&](double z, double phi) { return f(direction(z, phi)); },
                               2.0 * row / rows - 1.0, 2.0 * (row + 1) / rows - 1.0,
                               2.0 * pi * column / columns, 2.0 * pi * (column + 1) / columns,
                               tolerance / (rows * columns), 6);
        }
    }
    return total;
}

SamplerCheck check_sampler(const DirectionSampler &sample, const DirectionDensity &pdf_w,
                           int samples, Rng &rng) {
    std::vector<uint64_t> observed(rows * columns + 1, 0);
    std::vector<double> expected;
    for (int i = 0; i < samples; ++i) {
        const auto w = sample(rng);
        size_t cell = rows * columns;
        if (w) {
            const double phi = std::atan2(w->y(), w->x());
            const int row = std::min(static_cast<int>(0.5 * (w->z() + 1.0) * rows), rows - 1);
            const int column = std::min(
                static_cast<int>((phi < 0.0 ? phi + 2.0 * pi : phi) / (2.0 * pi) * columns),
                columns - 1);
            cell = static_cast<size_t>(row * columns + column);
        }
        ++observed[cell];
    }
    for (int row = 0; row < rows; ++row) {
        for (int column = 0; column < columns; ++column) {
            expected.push_back(
                integrate([&](double z, double phi) { return pdf_w(direction(z, phi)); },
                          2.0 * row / rows - 1.0, 2.0 * (row + 1) / rows - 1.0,
                          2.0 * pi * column / columns, 2.0 * pi * (column + 1) / columns, 1e-7, 7));
        }
    }
    return decide(std::move(observed), std::move(expected), samples);
}

SamplerCheck check_sharp_sampler(const DirectionSampler &sample, const DirectionDensity &pdf_w,
                                 const Vec3 &wo, const Eigen::Vector2d &width, int samples,
                                 Rng &rng) {
    std::vector<uint64_t> observed(slope_cells * slope_cells + 1, 0);
    std::vector<double> expected;
    const double cells_per_unit = slope_cells / (2.0 * slope_range);
    for (int i = 0; i < samples; ++i) {
        const auto wi = sample(rng);
        size_t cell = slope_cells * slope_cells;
        if (wi) {
            const Vec3 sum = *wi + wo;
            const double x = (sum.x() / sum.z() / width.x() + slope_range) * cells_per_unit;
            const double y = (sum.y() / sum.z() / width.y() + slope_range) * cells_per_unit;
            if (x >= 0.0 && x < slope_cells && y >= 0.0 && y < slope_cells) {
                cell = static_cast<size_t>(x) * slope_cells + static_cast<size_t>(y);
            }
        }
        ++observed[cell];
    }
    const auto density = [&](double x, double y) {
        const Vec3 h = Vec3(x * width.x(), y * width.y(), 1.0).normalized();
        const double cosine = wo.dot(h);
        const Vec3 wi = 2.0 * cosine * h - wo;
        if (!(cosine > 0.0 && wi.z() > 0.0)) {
            return 0.0;
        }
        // dw_i = 4 (wo.h) dw_h, dw_h = h.z^3 d(slope).
        return pdf_w(wi) * 4.0 * cosine * h.z() * square(h.z()) * width.x() * width.y();
    };
    for (int i = 0; i < slope_cells; ++i) {
        for (int j = 0; j < slope_cells; ++j) {
            const double x = i / cells_per_unit - slope_range, y = j / cells_per_unit - slope_range;
            expected.push_back(integrate(density, x, x + 1.0 / cells_per_unit, y,
                                         y + 1.0 / cells_per_unit, 1e-8, 4));
        }
    }
    return decide(std::move(observed), std::move(expected), samples);
}

}  // namespace rtrays::reference
