// SPDX-License-Identifier: MIT
// Anisotropic distributions of microfacet normals, GGX and Beckmann, with Smith's masking function
// for uncorrelated heights (Walter et al. 2007, "Microfacet Models for Refraction through Rough
// Surfaces"; Heitz 2014, "Understanding the Masking-Shadowing Function in Microfacet-Based BRDFs").
//
// Beckmann's masking is the exact form with the error function. With Walter's rational fit (0.35 %
// off), the density of visible normals would not be normalised.
//
// All directions are in the local frame; h is a unit microfacet normal with h.z > 0.
#pragma once

#include "reference/math.h"
#include "reference/rng.h"
#include "renderer/scene/stores.h"

namespace rtrays::reference {

/// A distribution of microfacet normals.
class MicrofacetDistribution {
  public:
    MicrofacetDistribution(BxdfComponent::Distribution kind, const Eigen::Vector2d &alpha)
        : kind_(kind), alpha_(alpha) {}

    /// Returns D(h) [1/sr]. The integral of D(h) h.z over the hemisphere is 1.
    double density(const Vec3 &h) const;

    /// Returns G1(v, h) in [0, 1], the share of facets with normal h that are visible from v. It is
    /// 0 where v sees the back of the facet but the front of the surface, or the reverse (Walter et
    /// al. 2007, eq. 23).
    double masking(const Vec3 &v, const Vec3 &h) const;

    /// Returns the density of `sample_visible` per solid angle: G1(wo, h) max(0, wo.h) D(h) / wo.z
    /// (Heitz 2014, eq. 2).
    double pdf_visible(const Vec3 &wo, const Vec3 &h) const;

    /// Samples a normal visible from wo (wo.z > 0).
    Vec3 sample_visible(const Vec3 &wo, Rng &rng) const;

  private:
    BxdfComponent::Distribution kind_;
    Eigen::Vector2d alpha_;
};

}  // namespace rtrays::reference
