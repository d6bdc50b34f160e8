// SPDX-License-Identifier: MIT
// Mitsuba's "plastic" and "roughplastic" (Jakob et al. 2022, Mitsuba 3.9): a diffuse base below a
// dielectric coat. The inside of the coat repeatedly reflects part of the light back to the base.
#pragma once

#include <memory>
#include <string>

#include "renderer/scene/cores/coat.h"
#include "renderer/scene/cores/material.h"

namespace rtrays::mitsuba {

/// Returns the fraction of diffuse light from inside that Mitsuba lets the coat reflect. For eta =
/// 1.5 it is 8e-4 above the exact value if smooth, and about 8e-3 below it if rough.
double plastic_inner_reflectance(const Coat &coat);

/// Weight of the Lambert component for a base of colour `reflectance` below the coat. It is
/// reflectance / (eta^2 (1 - F)), or reflectance / (eta^2 (1 - reflectance F)) if `nonlinear`. F is
/// the fraction of diffuse light that the inside of the coat reflects.
Eigen::Vector3d plastic_base_weight(const Eigen::Vector3d &reflectance, double eta, bool nonlinear);

/// Returns the material type of plastics. Its parameters are diffuse_reflectance,
/// specular_reflectance, eta, roughness, distribution and nonlinear.
const std::shared_ptr<const MaterialType> &plastic_type();

}  // namespace rtrays::mitsuba
