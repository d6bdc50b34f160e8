// SPDX-License-Identifier: MIT
// Mitsuba's "principled" (Jakob et al. 2022, Mitsuba 3.9, principled.cpp), after Burley 2012 and
// 2015.
#pragma once

#include <memory>
#include <vector>

#include "renderer/scene/cores/material.h"

namespace rtrays::mitsuba {

/// The parameters of a principled BSDF, within [0, 1] unless stated.
struct Principled {
    Eigen::Vector3d base_color = Eigen::Vector3d::Constant(0.5);
    std::shared_ptr<Texture> base_texture;  ///< factor of base_color
    double roughness = 0.5;
    std::shared_ptr<Texture> roughness_texture;  ///< its luminance is a factor of roughness
    double anisotropic = 0;
    double metallic = 0;
    /// Factors of metallic, clearcoat and sheen by their luminance. At most one of the first and
    /// the last.
    std::shared_ptr<Texture> metallic_texture, clearcoat_texture, sheen_texture;
    double spec_trans = 0;
    double eta = 1.5;  ///< at least 1
    double spec_tint = 0;
    double sheen = 0;
    double sheen_tint = 0;
    double flatness = 0;
    double clearcoat = 0;
    double clearcoat_gloss = 0;

    /// Returns whether all light that is not reflected passes the surface.
    bool is_glass() const {
        return spec_trans == 1 && metallic == 0 && metallic_texture == nullptr;
    }
    /// Returns the share of what is not metal, before the texture.
    double dielectric() const { return metallic_texture != nullptr ? 1 : 1 - metallic; }
    /// Returns the roughness of the main lobe along the tangent and across it.
    Eigen::Vector2d alpha() const;
};

/// Returns the components of a surface that is not glass. Throws `Error` (bad input) naming a
/// parameter that components cannot express.
std::vector<MaterialComponent> principled_components(const Principled &p);

}  // namespace rtrays::mitsuba
