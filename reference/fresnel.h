// SPDX-License-Identifier: MIT
// Fresnel reflectance of dielectrics and conductors, and the Fresnel term of a component.
#pragma once

#include "reference/math.h"
#include "renderer/scene/stores.h"

namespace rtrays::reference {

/// Returns the reflectance of a smooth dielectric boundary for unpolarized light (Born & Wolf 1999,
/// 1.5.2; thesis (3.26), (3.27)). It is 1 at and beyond the critical angle.
///
/// `cos_o`: cosine of the angle to the normal on the side of the ray, in [0, 1].
/// `eta`: index of refraction of the other side over that of the ray's side.
double fresnel_dielectric(double cos_o, double eta);

/// Returns the reflectance of a smooth conductor for unpolarized light (Born & Wolf 1999, 14.2).
/// The index of the conductor over that of the ray's side is eta + ik.
double fresnel_conductor(double cos_o, double eta, double k);

/// Returns the approximation of `fresnel_conductor` by thesis (3.28). Its error is at most about
/// 0.007 for common metals and larger for weakly absorbing materials.
double fresnel_conductor_approximate(double cos_o, double eta, double k);

/// Returns Schlick's approximation (Schlick 1994, eq. 15; thesis (3.29)).
double fresnel_schlick(double cos_o, double reflectance_at_normal);

/// Returns the reflectance of a plate of two parallel dielectric boundaries, summed over all
/// reflections inside it: each boundary reflects R, and r = R + (1 - R)^2 R / (1 - R^2) (Born &
/// Wolf 1999, 7.6, without interference). `eta`: index of the plate over that around it.
double thin_plate_reflectance(double cos_o, double eta);

/// Returns the cosine of the refracted angle, or 0 at total internal reflection. The arguments are
/// those of `fresnel_dielectric`.
double refracted_cosine(double cos_o, double eta);

/// Fresnel factor F of a component, or its complement 1 - F.
class Fresnel {
  public:
    explicit Fresnel(const BxdfComponent &component)
        : kind_(component.fresnel),
          complement_(component.complement),
          eta_(component.eta),
          k_(component.k) {}

    bool is_ideal() const { return kind_ == BxdfComponent::Fresnel::ideal && !complement_; }

    /// Returns F or 1 - F for `cos_o` in [0, 1]. `inverted` means that the ray is behind a
    /// boundary, where a dielectric's eta is replaced by 1 / eta.
    Spectrum evaluate(double cos_o, bool inverted) const;

  private:
    BxdfComponent::Fresnel kind_;
    bool complement_;
    Spectrum eta_;
    Spectrum k_;
};

}  // namespace rtrays::reference
