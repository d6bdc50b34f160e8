// SPDX-License-Identifier: MIT
#pragma once

#include "reference/math.h"
#include "renderer/scene/stores.h"

namespace rtrays::reference {

/// Reflectance of a smooth boundary for unpolarized light (Born & Wolf 1999, 1.5.2; thesis
/// (3.26, 3.27)). `cos_o`: of the angle to the normal on the side of the ray, in [0, 1]; `eta`:
/// index of refraction of the other side over that of the ray's side. 1 at and beyond the critical
/// angle.
double fresnel_dielectric(double cos_o, double eta);

/// Likewise at a conductor of index eta + ik over that of the ray's side (Born & Wolf 1999, 14.2).
double fresnel_conductor(double cos_o, double eta, double k);

/// The approximation of thesis (3.28): up to 0.006 off.
double fresnel_conductor_approximate(double cos_o, double eta, double k);

/// Schlick 1994, eq. 15; thesis (3.29).
double fresnel_schlick(double cos_o, double reflectance_at_normal);

/// cos of the refracted angle, or 0 at total internal reflection. Same arguments as
/// `fresnel_dielectric`.
double refracted_cosine(double cos_o, double eta);

/// The factor F of a component, or 1 - F.
class Fresnel {
  public:
    explicit Fresnel(const BxdfComponent &component)
        : kind_(component.fresnel),
          complement_(component.complement),
          eta_(component.eta),
          k_(component.k) {}

    bool is_ideal() const { return kind_ == BxdfComponent::Fresnel::ideal && !complement_; }

    /// `cos_o` in [0, 1]; `inverted`: seen from behind a boundary, where a dielectric's eta is 1 /
    /// eta.
    Spectrum evaluate(double cos_o, bool inverted) const;

  private:
    BxdfComponent::Fresnel kind_;
    bool complement_;
    Spectrum eta_;
    Spectrum k_;
};

}  // namespace rtrays::reference
