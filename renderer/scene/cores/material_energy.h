// SPDX-License-Identifier: MIT
#pragma once

#include <vector>

#include "renderer/scene/cores/material.h"

namespace rtrays {

/// Throws `Error` (bad input) when a material reflects and refracts more light than arrives: when
/// for some direction of view, on either side of a boundary, the weights * brightest texels *
/// Fresnel terms of its components (thesis 3.52) add up to more than one in some channel. The
/// message names the component that adds most.
///
/// That bounds the albedo of every BxDF whose own albedo is at most one. Named exemptions, because
/// no weight mends them: oren_nayar (up to 1.008), ward_original (diverges at grazing angles) and
/// the thesis' car paint (not reciprocal).
void check_energy(const std::vector<MaterialComponent> &components);

}  // namespace rtrays
