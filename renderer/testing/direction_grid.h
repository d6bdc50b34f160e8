// SPDX-License-Identifier: MIT
// Partition of the sphere of directions into cells, for tests of samplers against densities.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>

#include "renderer/kernels/bsdf/surface_frame.h"

#include "renderer/base/angles.h"

namespace rtrays {

/// A partition of the sphere of directions about a centre. Rings of the polar angle scale * tan(t)
/// are divided by azimuth, so cells are narrow near the centre.
class DirectionGrid {
  public:
    static constexpr int polar_cells = 16, azimuth_cells = 12, cells = polar_cells * azimuth_cells;

    /// About half the rings are within the polar angle `scale`, in radians. Azimuths start at a
    /// direction outside the plane through centre and normal, because the horizon may run along
    /// that plane.
    DirectionGrid(float3 centre, float3 normal, double scale)
        : normal_(normal), scale_(scale), t_end_(std::atan(pi / scale)) {
        const Frame upright = frame_from_tangent(centre, normal);
        frame_ = frame_from_tangent(centre, upright.x + 0.1f * upright.y);
    }

    int cell(float3 w) const {
        const double x = static_cast<double>(dot(w, frame_.x)),
                     y = static_cast<double>(dot(w, frame_.y));
        const double polar = std::atan2(std::hypot(x, y), static_cast<double>(dot(w, frame_.z)));
        const int i = static_cast<int>(std::atan(polar / scale_) / t_end_ * polar_cells);
        const int j = static_cast<int>((std::atan2(y, x) + pi) / (2 * pi) * azimuth_cells);
        return std::min(i, polar_cells - 1) * azimuth_cells + std::min(j, azimuth_cells - 1);
    }

    /// Returns the integral over a cell of a density per solid angle. The density may end at the
    /// horizon of the normal, so the two parts of the cell are integrated separately.
    double integral(int cell, const std::function<double(float3)> &density) const {
        const int i = cell / azimuth_cells, j = cell % azimuth_cells;
        const Range t = {t_end_ * i / polar_cells, t_end_ * (i + 1) / polar_cells};
        const Range azimuth = {2 * pi * j / azimuth_cells - pi,
                               2 * pi * (j + 1) / azimuth_cells - pi};
        double sum = 0;
        for (const bool near : {true, false}) {
            // s in [0, 1] parametrises the part of the ring on the centre's side of the horizon, or
            // the other part.
            const auto f = [&](double s, double a) {
                const double horizon = horizon_t(a);
                const double begin = near ? t.begin : std::max(t.begin, horizon),
                             end = near ? std::min(t.end, horizon) : t.end;
                if (!(begin < end)) {
                    return 0.0;
                }
                const double tangent = std::tan(begin + s * (end - begin));
                const double polar = scale_ * tangent;
                return density(direction(polar, a)) * scale_ * (1 + tangent * tangent) *
                       std::sin(polar) * (end - begin);
            };
            const Range unit = {0, 1};
            sum += refine(f, unit, azimuth, gauss(f, unit, azimuth), 0);
        }
        return sum;
    }

  private:
    struct Range {
        double begin, end;
        double middle() const { return 0.5 * (begin + end); }
    };
    using Function = std::function<double(double, double)>;

    float3 direction(double polar, double azimuth) const {
        const double s = std::sin(polar);
        return to_world(frame_, make_float3(static_cast<float>(s * std::cos(azimuth)),
                                            static_cast<float>(s * std::sin(azimuth)),
                                            static_cast<float>(std::cos(polar))));
    }

    /// Returns t of the horizon along an azimuth. Each azimuth crosses the horizon exactly once.
    double horizon_t(double azimuth) const {
        const double along = static_cast<double>(dot(normal_, frame_.x)) * std::cos(azimuth) +
                             static_cast<double>(dot(normal_, frame_.y)) * std::sin(azimuth);
        const double at_centre = static_cast<double>(dot(normal_, frame_.z));
        return std::atan(
            (at_centre >= 0 ? std::atan2(at_centre, -along) : std::atan2(-at_centre, along)) /
            scale_);
    }

    static double gauss(const Function &f, Range s, Range a) {
        constexpr std::array<double, 3> node = {-0.774596669241483, 0.0, 0.774596669241483};
        constexpr std::array<double, 3> weight = {5.0 / 18, 8.0 / 18, 5.0 / 18};
        double sum = 0;
        for (size_t i = 0; i < 3; ++i) {
            for (size_t j = 0; j < 3; ++j) {
                sum += weight[i] * weight[j] *
                       f(s.middle() + 0.5 * (s.end - s.begin) * node[i],
                         a.middle() + 0.5 * (a.end - a.begin) * node[j]);
            }
        }
        return sum * (s.end - s.begin) * (a.end - a.begin);
    }

    static double refine(const Function &f, Range s, Range a, double whole, int depth) {
        const std::array<Range, 2> rows = {Range{s.begin, s.middle()}, Range{s.middle(), s.end}};
        const std::array<Range, 2> columns = {Range{a.begin, a.middle()}, Range{a.middle(), a.end}};
        std::array<double, 4> part{};
        double sum = 0;
        for (size_t k = 0; k < 4; ++k) {
            part[k] = gauss(f, rows[k / 2], columns[k % 2]);
            sum += part[k];
        }
        if (depth >= 10 || (depth >= 1 && std::abs(sum - whole) < 1e-7)) {
            return sum;
        }
        sum = 0;
        for (size_t k = 0; k < 4; ++k) {
            sum += refine(f, rows[k / 2], columns[k % 2], part[k], depth + 1);
        }
        return sum;
    }

    Frame frame_;
    float3 normal_;
    double scale_, t_end_;
};

}  // namespace rtrays
