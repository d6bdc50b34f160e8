// SPDX-License-Identifier: MIT
#include "renderer/import/mitsuba/blend.h"

#include "renderer/scene/cores/composite.h"

namespace rtrays::mitsuba {

namespace {

using Fresnel = BxdfComponent::Fresnel;
using Kind = BxdfComponent::Kind;

/// Adds the parameters of the Fresnel term of a component; `prefix` begins their names.
void add_fresnel(const BxdfComponent &bxdf, const std::string &prefix, ParameterValues &values) {
    if (bxdf.fresnel == Fresnel::ideal) {
        return;
    }
    values[prefix + "complement"] = bxdf.complement;
    const bool refracts =
        bxdf.kind == Kind::ideal_refraction || bxdf.kind == Kind::microfacet_refraction;
    if (bxdf.fresnel == Fresnel::dielectric && !refracts) {
        values[prefix + "eta"] = bxdf.eta[0];
    } else if (bxdf.fresnel == Fresnel::thin_dielectric) {
        values[prefix + "eta"] = bxdf.eta[1];
    } else if (bxdf.fresnel == Fresnel::conductor) {
        values[prefix + "eta"] = bxdf.eta;
        values[prefix + "k"] = bxdf.k;
    } else if (bxdf.fresnel == Fresnel::schlick) {
        values[prefix + "reflectance"] = bxdf.eta;
    }
}

/// Adds the parameters of a component that a Mitsuba BSDF can have; `prefix` begins their names.
void add_component(const MaterialComponent &component, const std::string &prefix,
                   Composite &composite) {
    const BxdfComponent &bxdf = component.bxdf;
    ParameterValues &values = composite.values;
    values[prefix + "weight"] = Eigen::Vector3d(bxdf.weight.cast<double>());
    if (component.texture != nullptr) {
        composite.textures[prefix + "weight"] = component.texture;
    }
    if (component.mix_texture != nullptr) {
        composite.textures[prefix + "mix"] = component.mix_texture;
        values[prefix + "mix"] = bxdf.mix;
        values[prefix + "mix_inverted"] = bxdf.mix_inverted;
    }
    if (component.roughness_texture != nullptr) {
        const bool is_diffuse = bxdf.kind == Kind::disney_diffuse;
        composite.textures[prefix + (is_diffuse ? "roughness" : "alpha")] =
            component.roughness_texture;
    }
    if (bxdf.kind == Kind::microfacet_reflection || bxdf.kind == Kind::microfacet_refraction) {
        const bool is_ggx = bxdf.distribution == BxdfComponent::Distribution::ggx;
        values[prefix + "alpha"] = bxdf.alpha;
        values[prefix + "roughness_squared"] = bxdf.roughness_squared;
        values[prefix + "distribution"] = std::string(is_ggx ? "ggx" : "beckmann");
    }
    if (bxdf.kind == Kind::ideal_refraction || bxdf.kind == Kind::microfacet_refraction) {
        values[prefix + "eta"] = bxdf.eta[0];
    } else {
        values[prefix + "side"] = side_names()[static_cast<size_t>(bxdf.side)];
    }
    if (bxdf.kind == Kind::disney_diffuse) {
        values[prefix + "roughness"] = bxdf.disney_roughness;
        values[prefix + "flatness"] = bxdf.flatness;
    }
    if (bxdf.kind == Kind::disney_clearcoat) {
        values[prefix + "alpha"] = bxdf.alpha[0];
    }
    if (bxdf.kind == Kind::coated_lambert) {
        const bool is_ggx = bxdf.distribution == BxdfComponent::Distribution::ggx;
        values[prefix + "alpha"] = bxdf.alpha[0];
        values[prefix + "distribution"] = std::string(is_ggx ? "ggx" : "beckmann");
        values[prefix + "eta"] = bxdf.eta[0];
        values[prefix + "nonlinear"] = bxdf.nonlinear;
        values[prefix + "inner_reflectance"] = bxdf.inner_reflectance;
    }
    add_fresnel(bxdf, prefix + "fresnel_", values);
}

}  // namespace

Composite composite_of(const std::vector<MaterialComponent> &components) {
    Composite composite;
    std::vector<CompositePart> parts;
    for (const MaterialComponent &component : components) {
        add_component(component, part_prefix(parts.size()), composite);
        parts.push_back({bxdf_names()[static_cast<size_t>(component.bxdf.kind)],
                         fresnel_names()[static_cast<size_t>(component.bxdf.fresnel)]});
    }
    const auto type = std::make_shared<MaterialType>(*composite_type(parts));
    type->check = {};
    composite.type = type;
    return composite;
}

}  // namespace rtrays::mitsuba
