// SPDX-License-Identifier: MIT
// Mitsuba's "plastic": a diffuse base below a dielectric coat that sends part of what the base
// reflects back to it, again and again (Jakob et al. 2022, Mitsuba 3.9, plastic.cpp).
#pragma once

#include <memory>
#include <string>

#include "renderer/scene/cores/material.h"

namespace rtrays::mitsuba {

/// What a base of the colour `reflectance` becomes as the weight of a Lambert component below the
/// coat, reflectance / (eta^2 (1 - F)) or, `nonlinear`, reflectance / (eta^2 (1 - reflectance F)),
/// where F is what the inside of the coat reflects of diffuse light.
Eigen::Vector3d plastic_base_weight(const Eigen::Vector3d &reflectance, double eta, bool nonlinear);

/// The type of such materials. Parameters: diffuse_reflectance, specular_reflectance, eta,
/// roughness, distribution, nonlinear.
const std::shared_ptr<const MaterialType> &plastic_type();

}  // namespace rtrays::mitsuba
