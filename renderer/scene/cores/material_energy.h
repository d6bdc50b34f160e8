// SPDX-License-Identifier: MIT
// The check that materials conserve energy.
#pragma once

#include <vector>

#include "renderer/scene/cores/material.h"

namespace rtrays {

/// Returns the albedo of disney_sheen of weight 1, seen at this cosine with the normal: 0.0003 at
/// normal incidence, and more towards the horizon.
double sheen_albedo(double cosine);

/// Throws `Error` (bad input) if a material reflects and refracts more light than arrives. The
/// check adds the components' weights * brightest texels * Fresnel terms (thesis 3.52), for
/// directions of view on either side of a boundary. The sum must not exceed one in any channel. The
/// message names the component of the largest contribution.
///
/// The transmittance of a rough coat differs from 1 - F, and the reflectance of its surface from F,
/// but the sum of both is at most one.
///
/// disney_sheen counts with its albedo. The sum bounds the albedo if the albedo of each BxDF is at
/// most one. Exceptions, which no weight could correct, are oren_nayar (up to 1.008),
/// disney_diffuse (up to 1.6, at grazing angles), ward_original (diverges at grazing angles) and
/// the thesis' car paint (not reciprocal).
void check_energy(const std::vector<MaterialComponent> &components);

}  // namespace rtrays
