// SPDX-License-Identifier: MIT
#include "renderer/import/mitsuba/principled.h"

#include <algorithm>
#include <cmath>

#include "renderer/base/error.h"
#include "renderer/scene/cores/texture.h"

namespace rtrays::mitsuba {

namespace {

using Eigen::Vector3d;
using Kind = BxdfComponent::Kind;
using Fresnel = BxdfComponent::Fresnel;
using Components = std::vector<MaterialComponent>;

/// Makes a component whose weight is the same in all channels.
MaterialComponent component(Kind kind, double weight) {
    MaterialComponent made;
    made.parameter = "weight";
    made.bxdf.kind = kind;
    made.bxdf.weight = Rgb::Constant(static_cast<float>(weight));
    return made;
}

/// Makes the component times the base colour.
MaterialComponent coloured(MaterialComponent made, const Principled &p) {
    made.bxdf.weight = made.bxdf.weight.cwiseProduct(p.base_color.cast<float>());
    made.texture = p.base_texture;
    return made;
}

/// Makes a part of the main lobe, which reflects by microfacets.
MaterialComponent main_lobe(const Principled &p, double weight, Fresnel fresnel,
                            const Vector3d &eta) {
    MaterialComponent made = component(Kind::microfacet_reflection, weight);
    made.bxdf.alpha = p.alpha();
    made.bxdf.roughness_squared = p.roughness_texture != nullptr;
    made.roughness_texture = p.roughness_texture;
    made.bxdf.fresnel = fresnel;
    made.bxdf.eta = eta;
    return made;
}

/// Returns the base colour of luminance 1.
Vector3d tint(const Principled &p, const char *parameter) {
    if (p.base_texture != nullptr) {
        throw input_error(std::string(parameter) +
                          ": unsupported if base_color is a texture; set it to 0");
    }
    const double y = luminance(p.base_color);
    return y > 0 ? Vector3d(p.base_color / y) : Vector3d::Ones();
}

/// Adds the reflection by microfacets: a mixture of dielectric, tinted dielectric and metal.
void add_main_lobe(const Principled &p, Components &components) {
    if (p.eta == 1) {
        return;  // Mitsuba omits the lobe if the dielectric reflects nothing, for metals, too
    }
    const double rest = 1 - p.metallic;
    if (rest * (1 - p.spec_tint) > 0) {
        components.push_back(
            main_lobe(p, rest * (1 - p.spec_tint), Fresnel::dielectric, Vector3d::Constant(p.eta)));
    }
    if (rest * p.spec_tint > 0) {
        const double normal = std::pow((p.eta - 1) / (p.eta + 1), 2);
        const Vector3d reflectance = tint(p, "spec_tint") * normal;
        if (reflectance.maxCoeff() > 1) {
            throw input_error(
                "spec_tint: base_color is so saturated that more light is reflected "
                "than arrives; lower spec_tint, or specular");
        }
        components.push_back(main_lobe(p, rest * p.spec_tint, Fresnel::schlick, reflectance));
    }
    if (p.metallic > 0 && p.base_texture == nullptr) {
        components.push_back(main_lobe(p, p.metallic, Fresnel::schlick, p.base_color));
    } else if (p.metallic > 0) {
        // Schlick's r + (1 - r) w is r (1 - w) + w; w is that of the reflectance 0.
        MaterialComponent metal =
            coloured(main_lobe(p, p.metallic, Fresnel::schlick, Vector3d::Zero()), p);
        metal.bxdf.complement = true;
        components.push_back(metal);
        components.push_back(main_lobe(p, p.metallic, Fresnel::schlick, Vector3d::Zero()));
    }
}

}  // namespace

Eigen::Vector2d Principled::alpha() const {
    constexpr double narrowest = 0.001;
    const double square = roughness * roughness, aspect = std::sqrt(1 - 0.9 * anisotropic);
    return {std::max(narrowest, square / aspect), std::max(narrowest, square * aspect)};
}

Components principled_components(const Principled &p) {
    if (p.spec_trans > 0 && p.metallic < 1) {
        throw input_error(
            "spec_trans: a surface that is only partly transparent looks different from behind, "
            "which is unsupported; use 0, or 1 with metallic 0");
    }
    const double brightest =
        p.roughness_texture != nullptr
            ? static_cast<double>(p.roughness_texture->largest_texel().maxCoeff())
            : 1;
    if (p.alpha().maxCoeff() * brightest * brightest > 1 + 1e-6) {
        throw input_error(
            "anisotropic: the roughness along the tangent exceeds 1; lower roughness "
            "or anisotropic");
    }
    Components components;
    add_main_lobe(p, components);
    if (p.clearcoat > 0) {
        MaterialComponent coat = component(Kind::disney_clearcoat, p.clearcoat);
        coat.bxdf.alpha.setConstant(0.1 + (0.001 - 0.1) * p.clearcoat_gloss);
        coat.bxdf.fresnel = Fresnel::schlick;
        coat.bxdf.eta.setConstant(0.04);
        components.push_back(coat);
    }
    const double diffuse = 1 - p.metallic;
    if (diffuse > 0) {
        MaterialComponent base = coloured(component(Kind::disney_diffuse, diffuse), p);
        base.bxdf.disney_roughness = p.roughness;
        base.roughness_texture = p.roughness_texture;
        base.bxdf.flatness = p.flatness;
        components.push_back(base);
    }
    if (diffuse * p.sheen > 0) {
        MaterialComponent sheen = component(Kind::disney_sheen, diffuse * p.sheen);
        if (p.sheen_tint > 0) {
            const Vector3d colour =
                Vector3d::Ones() + p.sheen_tint * (tint(p, "sheen_tint") - Vector3d::Ones());
            sheen.bxdf.weight = sheen.bxdf.weight.cwiseProduct(colour.cast<float>());
        }
        if (sheen.bxdf.weight.maxCoeff() > 1) {
            throw input_error(
                "sheen_tint: base_color is so saturated that the sheen exceeds 1; "
                "lower sheen or sheen_tint");
        }
        components.push_back(sheen);
    }
    if (components.empty()) {
        components.push_back(component(Kind::lambert, 0));  // black
    }
    return components;
}

}  // namespace rtrays::mitsuba
