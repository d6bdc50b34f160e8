// SPDX-License-Identifier: MIT
// Light through a dielectric coat, smooth or of microfacets, from either side.
#pragma once

#include <string>

#include "renderer/scene/parameters.h"
#include "renderer/scene/stores.h"

namespace rtrays {

/// A dielectric boundary.
struct Coat {
    double eta = 1.5;  ///< index of refraction behind it over that in front of it, above 1
    double alpha = 0;  ///< roughness, 0 if smooth
    BxdfComponent::Distribution distribution = BxdfComponent::Distribution::ggx;
};

/// Returns the coat of these parameters. Throws `Error` (bad input) for a roughness that is neither
/// 0 nor that of a rough surface.
Coat coat_of(const ParameterSet &parameters, const std::string &eta, const std::string &alpha,
             const std::string &distribution);

/// Sets the fields of a component that describe its coat.
void set_coat(const Coat &coat, BxdfComponent &bxdf);

// Rough coats scatter a single time: what the masking of microfacets stops is lost. Quadratures
// have errors below 1e-5, for alpha up to 1 and eta up to 3.

/// Returns the share of light that passes from the front. It arrives at an angle whose cosine, in
/// [0, 1], is given.
double coat_transmittance(const Coat &coat, double cosine);

/// Returns the share of light that arrives from behind, at an angle of the given cosine, and is
/// reflected back.
double coat_inner_reflectance(const Coat &coat, double cosine);

/// Returns the share of diffuse light from behind that is reflected back: the integral of 2 c
/// coat_inner_reflectance(c) over the cosine c.
double coat_diffuse_reflectance(const Coat &coat);

}  // namespace rtrays
