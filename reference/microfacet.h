// SPDX-License-Identifier: MIT
// Distributions of microfacet normals, anisotropic, with Smith's masking function for uncorrelated
// heights (Walter et al. 2007, "Microfacet Models for Refraction through Rough Surfaces"; Heitz
// 2014, "Understanding the Masking-Shadowing Function in Microfacet-Based BRDFs"). Beckmann's
// masking is the exact one with the error function, not Walter's rational fit (0.35 % off): only so
// is the density of visible normals normalized.
//
// Everything is in the local frame; h is a unit microfacet normal with h.z > 0.
#pragma once

#include "reference/math.h"
#include "reference/rng.h"
#include "renderer/scene/stores.h"

namespace rtrays::reference {

class MicrofacetDistribution {
  public:
    MicrofacetDistribution(BxdfComponent::Distribution kind, const Eigen::Vector2d &alpha)
        : kind_(kind), alpha_(alpha) {}

    /// D(h) [1/sr]: the integral of D(h) h.z over the hemisphere is 1.
    double density(const Vec3 &h) const;

    /// G1(v, h) in [0, 1]: share of facets with normal h visible from v; 0 where v sees the facet's
    /// back but the surface's front, or the other way round (Walter et al. 2007, eq. 23).
    double masking(const Vec3 &v, const Vec3 &h) const;

    /// Density per solid angle of `sample_visible`: G1(wo, h) max(0, wo.h) D(h) / wo.z (Heitz 2014,
    /// eq. 2).
    double pdf_visible(const Vec3 &wo, const Vec3 &h) const;

    /// A normal visible from wo (wo.z > 0).
    Vec3 sample_visible(const Vec3 &wo, Rng &rng) const;

  private:
    BxdfComponent::Distribution kind_;
    Eigen::Vector2d alpha_;
};

}  // namespace rtrays::reference
