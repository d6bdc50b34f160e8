// SPDX-License-Identifier: MIT
#include "renderer/import/models/surface.h"

#include <algorithm>
#include <cmath>

#include "renderer/scene/cores/composite.h"
#include "renderer/scene/cores/material_energy.h"

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
         s.is_physical ? s.diffuse.cwiseProduct(s.transmittance) : s.transmittance}};
    ParameterTextures textures;
    set_common(s, values, textures);
    if (s.is_thin) {
        set_texture("transmittance", s.diffuse_texture, textures);
        return std::make_shared<MaterialCore>(name, "thin_glass", values, textures);
    }
    values["roughness"] = Vector2d(alpha, alpha);
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

/// A share of all components of a surface: a constant, times a texture or its complement.
struct Share {
    double constant = 1;
    std::shared_ptr<Texture> texture;
    double scale = 1;  ///< of the texture
    bool inverted = false;
};

/// Adds the components of metalness and roughness to a composite.
class PhysicalSurface {
  public:
    PhysicalSurface(const ModelSurface &surface, CompositeBuilder &composite)
        : s_(surface), composite_(composite) {}

    void add() {
        const double coated = std::min(std::max(s_.clearcoat, 0.0), 1.0);
        // The largest albedo of the sheen, with a margin for its quadrature.
        const double rest = 1 - 1.001 * sheen_albedo(0) * s_.sheen.maxCoeff();
        if (coated < 1) {
            add_mixture(rest * (1 - coated), false);
        }
        if (coated > 0) {
            const std::string coat = composite_.add_reflection(
                s_.clearcoat_alpha, nullptr, dielectric(), Vector3d::Constant(rest * coated));
            composite_.values[coat + "fresnel_eta"] = eta_of(true);
            add_mixture(rest * coated, true);
        }
        if (s_.sheen.maxCoeff() > 0) {
            composite_.add("disney_sheen", "ideal", s_.sheen, s_.sheen_texture);
        }
    }

  private:
    bool is_transparent() const { return s_.transmission > 0; }
    bool is_thin() const { return is_transparent() && s_.is_thin; }

    /// Returns the Fresnel term of a dielectric. That of a thin wall is the same from both sides.
    const char *dielectric() const { return is_thin() ? "thin_dielectric" : "dielectric"; }

    /// Returns the index of the dielectric: that of the base, or 1.5 for a clear coat of glTF. A
    /// coat on a transparent body reflects no more than the surface of the body, which passes the
    /// rest.
    double eta_of(bool coated) const {
        constexpr double clearcoat = 1.5;
        return !coated                          ? s_.eta
               : is_transparent() && !is_thin() ? std::min(clearcoat, s_.eta)
                                                : clearcoat;
    }

    void set_share(const std::string &part, const Share &share) {
        if (share.texture != nullptr) {
            composite_.textures[part + "mix"] = share.texture;
            composite_.values[part + "mix"] = share.scale;
            composite_.values[part + "mix_inverted"] = share.inverted;
        }
    }

    /// Sets the Fresnel term 1 - F of what is below a dielectric.
    void set_below(const std::string &part, double eta) {
        composite_.values[part + "fresnel_eta"] = eta;
        composite_.values[part + "fresnel_complement"] = true;
    }

    /// Adds the mixture by metalness, on `constant` of the surface.
    void add_mixture(double constant, bool coated) {
        const double metal = std::min(std::max(s_.metalness, 0.0), 1.0);
        const std::shared_ptr<Texture> &texture = s_.metalness_texture;
        if (metal > 0) {
            add_metal({texture ? constant : constant * metal, texture, metal, false}, coated);
        }
        if (metal < 1 || texture) {
            add_base({texture ? constant : constant * (1 - metal), texture, metal, true}, coated);
        }
    }

    void add_metal(const Share &share, bool coated) {
        const std::string part = composite_.add_reflection(
            s_.alpha, s_.roughness_texture, coated ? dielectric() : "schlick",
            share.constant * (coated ? s_.diffuse : Vector3d::Ones()), s_.diffuse_texture);
        set_share(part, share);
        if (coated) {
            set_below(part, eta_of(coated));
        } else {
            composite_.values[part + "fresnel_reflectance"] = s_.diffuse;
        }
    }

    /// Adds the dielectric and what is below it.
    void add_base(const Share &share, bool coated) {
        const double through = std::min(std::max(s_.transmission, 0.0), 1.0);
        const std::shared_ptr<Texture> &texture = s_.transmission_texture;
        if (!coated && s_.eta != 1) {
            const std::string coat = composite_.add_reflection(
                s_.alpha, s_.roughness_texture, dielectric(), Vector3d::Constant(share.constant));
            composite_.values[coat + "fresnel_eta"] = s_.eta;
            set_share(coat, share);
        }
        const Share diffuse = texture ? Share{share.constant, texture, through, true}
                                      : with_factor(share, 1 - through);
        const Share transmitted =
            texture ? Share{share.constant, texture, through, false} : with_factor(share, through);
        if (through < 1 || texture) {
            const std::string base = composite_.add(
                "lambert", dielectric(), diffuse.constant * s_.diffuse, s_.diffuse_texture);
            set_below(base, eta_of(coated));
            set_share(base, diffuse);
        }
        if (through > 0) {
            add_transmission(transmitted, coated);
        }
    }

    static Share with_factor(Share share, double factor) {
        share.constant *= factor;
        return share;
    }

    void add_transmission(const Share &share, bool coated) {
        const Vector3d weight = share.constant * s_.diffuse.cwiseProduct(s_.transmittance);
        const bool is_rough = s_.alpha >= smooth_alpha && s_.eta != 1 && !s_.is_thin;
        const std::string part =
            composite_.add(is_rough ? "microfacet_refraction" : "ideal_refraction", dielectric(),
                           weight, s_.diffuse_texture);
        composite_.values[part + "eta"] = s_.is_thin ? 1 : s_.eta;
        composite_.values[part + "fresnel_complement"] = true;
        if (s_.is_thin) {
            composite_.values[part + "fresnel_eta"] = eta_of(coated);
        }
        if (is_rough) {
            composite_.set_roughness(part, s_.alpha, s_.roughness_texture);
        }
        set_share(part, share);
    }

    const ModelSurface &s_;
    CompositeBuilder &composite_;
};

std::shared_ptr<MaterialCore> make_composite(const ModelSurface &s, const std::string &name) {
    CompositeBuilder composite;
    set_common(s, composite.values, composite.textures);
    if (s.is_physical) {
        PhysicalSurface(s, composite).add();
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
