// SPDX-License-Identifier: MIT
// Sampling routines of the reference: hemisphere, triangle, discrete distribution, MIS weight.
#pragma once

#include <cmath>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "reference/math.h"
#include "reference/rng.h"

namespace rtrays::reference {

/// Samples a direction on the upper hemisphere (local frame, z up) with pdf_w = cos(theta) / pi.
/// The direction is a uniform point of the unit disc, projected up (Malley's method; PBRT 4th ed.,
/// 13.6.3).
inline Vec3 sample_cosine_hemisphere(Rng &rng) {
    const double radius_squared = rng.uniform();
    const double phi = 2.0 * pi * rng.uniform();
    const double radius = std::sqrt(radius_squared);
    return {radius * std::cos(phi), radius * std::sin(phi), std::sqrt(1.0 - radius_squared)};
}

/// Samples barycentrics of the second and third vertex, uniform in area over a triangle (Osada et
/// al. 2002, eq. 1).
inline Eigen::Vector2d sample_triangle(Rng &rng) {
    const double root = std::sqrt(rng.uniform());
    const double along = rng.uniform();
    return {root * (1.0 - along), root * along};
}

/// Returns the MIS weight of a sample of density `pdf` if another strategy samples it with density
/// `other` (same measure). It is the power heuristic with beta = 2 and one sample each (Veach 1997,
/// eq. 9.13). The ratio form cannot overflow to NaN: an infinite ratio gives weight 0. `pdf` must
/// be positive.
inline double power_heuristic(double pdf, double other) {
    return 1.0 / (1.0 + square(other / pdf));
}

/// Discrete distribution sampled in constant time (Walker 1977; construction of Vose 1991).
class AliasTable {
  public:
    AliasTable() = default;

    /// `weights`: finite, not negative, at least one positive. Throws `Error` (run failed)
    /// otherwise.
    explicit AliasTable(const std::vector<double> &weights);

    /// Returns the probability of index `i`.
    double probability(size_t i) const { return slots_[i].probability; }

    /// Samples an index according to the probabilities. The table must not be empty.
    uint32_t sample(Rng &rng) const {
        // The product is below the size even after rounding, because u <= 1 - 2^-53 lowers it by at
        // least half the spacing of doubles there.
        const double scaled = rng.uniform() * static_cast<double>(slots_.size());
        const auto i = static_cast<uint32_t>(scaled);
        return scaled - i < slots_[i].keep ? i : slots_[i].alias;
    }

  private:
    struct Slot {
        double probability;
        double keep;  ///< share of the slot that belongs to its own index
        uint32_t alias;
    };
    std::vector<Slot> slots_;
};

}  // namespace rtrays::reference
