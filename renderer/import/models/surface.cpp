// SPDX-License-Identifier: MIT
#include "renderer/import/models/surface.h"

#include <algorithm>
#include <cmath>

#include "renderer/scene/cores/composite.h"

namespace rtrays {

using Eigen::Vector2d;
using Eigen::Vector3d;

namespace {

/// A surface of lower alpha is ideally smooth. Its highlight would be narrower than a pixel.
constexpr double smooth_alpha = 0.01;

/// Builds a composite material from components and their parameters.
class CompositeBuilder {
  public:
    /// Adds a component and returns the prefix of its parameter names.
    std::string add(const char *bxdf, const char *fresnel, const Vector3d &weight,
                    const std::shared_ptr<Texture> &texture = nullptr) {
        const std::string prefix = part_prefix(parts_.size());
        parts_.push_back({bxdf, fresnel});
        values[prefix + "weight"] = weight;
        if (texture != nullptr) {
            textures[prefix + "weight"] = texture;
        }
        return prefix;
    }

    /// Sets the roughness of a component, which the square of a texture may scale.
    void set_roughness(const std::string &prefix, double alpha,
                       const std::shared_ptr<Texture> &texture) {
        values[prefix + "alpha"] = Vector2d(alpha, alpha);
        if (texture != nullptr) {
            textures[prefix + "alpha"] = texture;
            values[prefix + "roughness_squared"] = true;
        }
    }

    /// Adds an ideal or a microfacet reflection, depending on `alpha`.
    std::string add_reflection(double alpha, const std::shared_ptr<Texture> &roughness,
                               const char *fresnel, const Vector3d &weight,
                               const std::shared_ptr<Texture> &texture = nullptr) {
        if (alpha < smooth_alpha) {
            return add("ideal_reflection", fresnel, weight, texture);
        }
        const std::string prefix = add("microfacet_reflection", fresnel, weight, texture);
        set_roughness(prefix, alpha, roughness);
        return prefix;
    }

    std::shared_ptr<MaterialCore> build(const std::string &name) const {
        return std::make_shared<MaterialCore>(name, composite_type(parts_), values, textures);
    }

    ParameterValues values;
    ParameterTextures textures;

  private:
    std::vector<CompositePart> parts_;
};

/// Sets the parameters that all types of materials have.
void set_common(const ModelSurface &s, ParameterValues &values, ParameterTextures &textures) {
    values["emission"] = s.emission;
    values["opacity"] = std::min(std::max(s.opacity, 0.0), 1.0);
    values["opacity_cutoff"] = s.opacity_cutoff;
    if (s.opacity_texture != nullptr) {
        textures["opacity"] = s.opacity_texture;
    }
    if (s.emission_texture != nullptr) {
        textures["emission"] = s.emission_texture;
    }
    for (const auto &[parameter, texture] :
         {std::pair("normal_map", s.normal_texture), std::pair("bump_map", s.bump_texture)}) {
        if (texture != nullptr) {
            textures[parameter] = texture;
            values[parameter] = s.map_scale;
            values["map_follows_v"] = true;
        }
    }
}

void set_texture(const char *parameter, const std::shared_ptr<Texture> &texture,
                 ParameterTextures &textures) {
    if (texture != nullptr) {
        textures[parameter] = texture;
    }
}

/// Scales the colours so that no channel sums to more than one. Returns whether they were scaled.
bool conserve_energy(ModelSurface &s) {
    const Vector3d highlight = s.has_highlight() ? s.specular : Vector3d::Zero();
    const double most = s.is_plain() ? (s.diffuse + highlight).maxCoeff()
                                     : s.diffuse.cwiseMax(s.specular).maxCoeff();
    if (most > 1) {
        s.diffuse /= most;
        s.specular /= most;
    }
    return most > 1;
}

std::shared_ptr<MaterialCore> make_glass(const ModelSurface &s, const std::string &name) {
    const double alpha = s.is_physical && s.alpha >= smooth_alpha && s.eta != 1 ? s.alpha : 0;
    ParameterValues values = {
        {"eta", s.eta > 0 ? s.eta : ModelSurface::glass_eta},
        {"transmittance",
         s.is_physical ? s.diffuse.cwiseProduct(s.transmittance) : s.transmittance},
        {"roughness", Vector2d(alpha, alpha)}};
    ParameterTextures textures;
    set_common(s, values, textures);
    if (alpha > 0 && s.roughness_texture != nullptr) {
        values["roughness_squared"] = true;
        textures["roughness"] = s.roughness_texture;
    }
    set_texture("transmittance", s.is_physical ? s.diffuse_texture : nullptr, textures);
    return std::make_shared<MaterialCore>(name, "glass", values, textures);
}

std::shared_ptr<MaterialCore> make_plain(const ModelSurface &s, const std::string &name) {
    ParameterValues values = {{"reflectance", s.diffuse}};
    ParameterTextures textures;
    set_common(s, values, textures);
    set_texture("reflectance", s.diffuse_texture, textures);
    if (!s.has_highlight()) {
        return std::make_shared<MaterialCore>(name, "lambert", values, textures);
    }
    values["specular"] = s.specular;
    values["exponent"] = s.exponent;
    set_texture("specular", s.specular_texture, textures);
    return std::make_shared<MaterialCore>(name, "lambert_blinn", values, textures);
}

/// Adds what is below the coat: Lambert, and refraction by the fraction `s.transmission`.
void add_base(const ModelSurface &s, double share, CompositeBuilder &composite) {
    const double through = std::min(std::max(s.transmission, 0.0), 1.0);
    if (through < 1) {
        const std::string base = composite.add(
            "lambert", "dielectric", share * (1 - through) * s.diffuse, s.diffuse_texture);
        composite.values[base + "fresnel_eta"] = s.eta;
        composite.values[base + "fresnel_complement"] = true;
    }
    if (through > 0) {
        const bool is_rough = s.alpha >= smooth_alpha && s.eta != 1;
        const std::string part = composite.add(
            is_rough ? "microfacet_refraction" : "ideal_refraction", "dielectric",
            share * through * s.diffuse.cwiseProduct(s.transmittance), s.diffuse_texture);
        composite.values[part + "eta"] = s.eta;
        composite.values[part + "fresnel_complement"] = true;
        if (is_rough) {
            composite.set_roughness(part, s.alpha, s.roughness_texture);
        }
    }
}

/// Adds a mixture by metalness of a metal and a coated base.
void add_physical(const ModelSurface &s, CompositeBuilder &composite) {
    const double metal = std::min(std::max(s.metalness, 0.0), 1.0);
    if (metal > 0) {
        const std::string part = composite.add_reflection(
            s.alpha, s.roughness_texture, "schlick", Vector3d::Constant(metal), s.diffuse_texture);
        composite.values[part + "fresnel_reflectance"] = s.diffuse;
    }
    if (metal < 1) {
        const double share = 1 - metal;
        if (s.eta != 1) {
            const std::string coat = composite.add_reflection(
                s.alpha, s.roughness_texture, "dielectric", Vector3d::Constant(share));
            composite.values[coat + "fresnel_eta"] = s.eta;
        }
        add_base(s, share, composite);
    }
}

std::shared_ptr<MaterialCore> make_composite(const ModelSurface &s, const std::string &name) {
    CompositeBuilder composite;
    set_common(s, composite.values, composite.textures);
    if (s.is_physical) {
        add_physical(s, composite);
    } else {
        // An exponent of zero means a mirror. The material requests reflections, not a highlight.
        const std::string part = composite.add_reflection(
            s.exponent > 0 ? s.alpha : 0, nullptr, "schlick", Vector3d::Ones(), s.specular_texture);
        composite.values[part + "fresnel_reflectance"] = s.specular;
    }
    return composite.build(name);
}

}  // namespace

std::shared_ptr<MaterialCore> make_model_material(ModelSurface surface, const std::string &name,
                                                  ModelNotes &notes) {
    if (surface.is_plain() && surface.specular.maxCoeff() > 0 && !surface.has_highlight()) {
        notes.add("specular colours without an exponent are ignored", name);
    }
    if (!surface.refracts && conserve_energy(surface)) {
        notes.add("colours that would reflect more light than they receive are scaled down", name);
    }
    const bool is_opaque = surface.opacity >= 1 && surface.opacity_texture == nullptr;
    if (!is_opaque && surface.emission.maxCoeff() > 0) {
        notes.add("materials that emit are opaque; their opacity is ignored", name);
        surface.opacity = 1;
        surface.opacity_texture = nullptr;
    }
    if (surface.refracts) {
        return make_glass(surface, name);
    }
    return surface.is_plain() ? make_plain(surface, name) : make_composite(surface, name);
}

}  // namespace rtrays
