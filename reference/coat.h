// SPDX-License-Identifier: MIT
// A diffuse reflector under a dielectric coat (renderer/scene/stores.h, coated_lambert).
#pragma once

#include <memory>
#include <vector>

#include "reference/math.h"
#include "renderer/scene/stores.h"

namespace rtrays::reference {

/// The coat of a diffuse base, with its colour.
///
/// Rough coats scatter a single time. Their transmittance is the sum over a regular grid of
/// microfacets and is tabulated; its error is below 1e-3.
class Coat {
  public:
    explicit Coat(const BxdfComponent &component);

    /// Returns the share of light at an angle of cosine `c` that passes the coat.
    double transmittance(double c) const;

    /// Returns the factor of transmittances / pi for a base of albedo `albedo`.
    Spectrum base(const Spectrum &albedo) const;

  private:
    struct Table {
        std::vector<double> transmittance;
        double inner_reflectance;
    };
    static std::shared_ptr<const Table> table_of(const BxdfComponent &component);

    double eta_;
    bool nonlinear_;
    double inner_;  ///< share of diffuse light from below that is reflected back
    std::shared_ptr<const Table> table_;  ///< of a rough coat
};

}  // namespace rtrays::reference
