// SPDX-License-Identifier: MIT
// Conversion of the surfaces of model files to our materials, for all formats.
#pragma once

#include <Eigen/Core>
#include <memory>
#include <string>

#include "renderer/import/models/notes.h"
#include "renderer/scene/cores/material.h"
#include "renderer/scene/cores/texture.h"

namespace rtrays {

/// The parameters of a surface, independent of the file format.
struct ModelSurface {
    static constexpr double default_grey = 0.6;  ///< Assimp's default
    static constexpr double glass_eta = 1.5;     ///< glTF's default

    Eigen::Vector3d diffuse = Eigen::Vector3d::Constant(default_grey);
    Eigen::Vector3d specular = Eigen::Vector3d::Zero();
    Eigen::Vector3d emission = Eigen::Vector3d::Zero();
    std::shared_ptr<Texture> emission_texture;  ///< factor of the emission
    Eigen::Vector3d transmittance = Eigen::Vector3d::Ones();
    std::shared_ptr<Texture> diffuse_texture;
    std::shared_ptr<Texture> specular_texture;
    std::shared_ptr<Texture> opacity_texture;
    std::shared_ptr<Texture> roughness_texture;  ///< its square scales `alpha`
    std::shared_ptr<Texture> normal_texture;
    std::shared_ptr<Texture> bump_texture;
    double map_scale = 1;  ///< factor of x and y of the normals, or of the heights
    double exponent = 0;
    double opacity = 1;
    double opacity_cutoff = 0;  ///< as of `MaterialCore`
    double eta = 1;
    double metalness = 0;
    double alpha = 0;
    double transmission = 0;  ///< fraction of the light below the coat that is transmitted
    /// Factor of `metalness`, or of `transmission`; at most one of them. Their luminance counts.
    std::shared_ptr<Texture> metalness_texture;
    std::shared_ptr<Texture> transmission_texture;
    bool is_thin = false;  ///< transmitted light passes a plate instead of entering a body
    double clearcoat = 0;  ///< share of the surface that has a clear coat
    double clearcoat_alpha = 0;
    Eigen::Vector3d sheen = Eigen::Vector3d::Zero();
    std::shared_ptr<Texture> sheen_texture;  ///< factor of `sheen`
    bool is_physical = false;                ///< described by metalness and roughness
    bool refracts = false;                   ///< glass
    bool only_reflects = false;              ///< a mirror or a metal without a diffuse colour

    bool has_highlight() const { return specular.maxCoeff() > 0 && exponent > 0; }
    bool is_plain() const { return !is_physical && !refracts && !only_reflects; }
};

/// Converts a surface to a material. The first matching rule applies:
///
///   1. `refracts`: glass, or thin glass.
///   2. `is_physical`: a mixture by metalness of a metal (Schlick) and of a coated base. The base
///      is Lambert below a dielectric, and transmits the fraction `transmission`. The distribution
///      is GGX. A clear coat of index 1.5 replaces the dielectric, and the edge of the metal's
///      Fresnel term, where the surface has one. Burley's sheen is added, and the rest darkened by
///      the largest albedo of the sheen.
///   3. `only_reflects`: metal (Schlick) of reflectance `specular`, GGX.
///   4. A specular colour and an exponent: lambert_blinn.
///   5. Otherwise: lambert.
///
/// Colours are scaled down where a material would reflect more light than it receives, with a note.
/// Opacities are those of the material, except where it emits: it is opaque then, with a note.
/// Emission is radiance. Throws `Error` (bad input) naming the parameter at fault.
std::shared_ptr<MaterialCore> make_model_material(ModelSurface surface, const std::string &name,
                                                  ModelNotes &notes);

}  // namespace rtrays
