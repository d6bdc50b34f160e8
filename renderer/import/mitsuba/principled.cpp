// SPDX-License-Identifier: MIT
#include "renderer/import/mitsuba/principled.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "renderer/base/error.h"
#include "renderer/base/notice.h"
#include "renderer/import/mitsuba/blend.h"
#include "renderer/import/mitsuba/draft.h"
#include "renderer/import/models/textures.h"
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

/// Mixes the component by a texture, if there is one.
MaterialComponent mixed(MaterialComponent made, const std::shared_ptr<Texture> &texture,
                        bool inverted) {
    made.mix_texture = texture;
    made.bxdf.mix_inverted = texture != nullptr && inverted;
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
    const auto &mix = p.metallic_texture;
    const double rest = p.dielectric();
    if (rest * (1 - p.spec_tint) > 0) {
        components.push_back(mixed(
            main_lobe(p, rest * (1 - p.spec_tint), Fresnel::dielectric, Vector3d::Constant(p.eta)),
            mix, true));
    }
    if (rest * p.spec_tint > 0) {
        const double normal = std::pow((p.eta - 1) / (p.eta + 1), 2);
        const Vector3d reflectance = tint(p, "spec_tint") * normal;
        if (reflectance.maxCoeff() > 1) {
            throw input_error(
                "spec_tint: base_color is so saturated that more light is reflected "
                "than arrives; lower spec_tint, or specular");
        }
        components.push_back(
            mixed(main_lobe(p, rest * p.spec_tint, Fresnel::schlick, reflectance), mix, true));
    }
    if (p.metallic > 0 && p.base_texture == nullptr) {
        components.push_back(
            mixed(main_lobe(p, p.metallic, Fresnel::schlick, p.base_color), mix, false));
    } else if (p.metallic > 0) {
        // Schlick's r + (1 - r) w is r (1 - w) + w; w is that of the reflectance 0.
        MaterialComponent metal =
            coloured(main_lobe(p, p.metallic, Fresnel::schlick, Vector3d::Zero()), p);
        metal.bxdf.complement = true;
        components.push_back(mixed(metal, mix, false));
        components.push_back(
            mixed(main_lobe(p, p.metallic, Fresnel::schlick, Vector3d::Zero()), mix, false));
    }
}

}  // namespace

Eigen::Vector2d Principled::alpha() const {
    constexpr double narrowest = 0.001;
    const double square = roughness * roughness, aspect = std::sqrt(1 - 0.9 * anisotropic);
    return {std::max(narrowest, square / aspect), std::max(narrowest, square * aspect)};
}

Components principled_components(const Principled &p) {
    if (p.spec_trans > 0 && p.dielectric() > 0) {
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
        components.push_back(mixed(coat, p.clearcoat_texture, false));
    }
    const double diffuse = p.dielectric();
    if (diffuse > 0) {
        MaterialComponent base = coloured(component(Kind::disney_diffuse, diffuse), p);
        base.bxdf.disney_roughness = p.roughness;
        base.roughness_texture = p.roughness_texture;
        base.bxdf.flatness = p.flatness;
        components.push_back(mixed(base, p.metallic_texture, true));
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
        components.push_back(p.metallic_texture != nullptr ? mixed(sheen, p.metallic_texture, true)
                                                           : mixed(sheen, p.sheen_texture, false));
    }
    if (components.empty()) {
        components.push_back(component(Kind::lambert, 0));  // black
    }
    return components;
}

void MaterialReader::read_principled(Object &object, Draft &draft) {
    Principled p;
    read_colour(object, "base_color", "base_color", 0.5, draft);
    p.base_color = std::get<Vector3d>(draft.values.at("base_color"));
    draft.values.erase("base_color");
    if (const auto found = draft.textures.find("base_color"); found != draft.textures.end()) {
        p.base_texture = found->second;
        draft.textures.erase(found);
    }
    if (const auto textures = object.objects("texture", "roughness"); !textures.empty()) {
        p.roughness = 1;
        p.roughness_texture = texture(textures[0], draft, TextureUse::number);
    } else {
        p.roughness = read_share(object, "roughness", 0.5, draft);
    }
    p.anisotropic = read_share(object, "anisotropic", 0, draft);
    p.metallic = read_factor(object, "metallic", p.metallic_texture, draft);
    p.spec_trans = read_share(object, "spec_trans", 0, draft);
    p.spec_tint = read_share(object, "spec_tint", 0, draft);
    p.sheen = p.metallic_texture == nullptr ? read_factor(object, "sheen", p.sheen_texture, draft)
                                            : read_share(object, "sheen", 0, draft);
    p.sheen_tint = read_share(object, "sheen_tint", 0, draft);
    p.flatness = read_share(object, "flatness", 0, draft);
    p.clearcoat = read_factor(object, "clearcoat", p.clearcoat_texture, draft);
    p.clearcoat_gloss = read_share(object, "clearcoat_gloss", 0, draft);
    for (const char *rate : {"main_specular_sampling_rate", "clearcoat_sampling_rate",
                             "diffuse_reflectance_sampling_rate"}) {
        object.ignore(rate);  // affects noise only
    }
    if (object.has("eta") && object.has("specular")) {
        throw object.element().error("has both eta and specular; give one of them");
    }
    const double specular = read_share(object, "specular", 0.5, draft);
    p.eta = object.number("eta", 2 / (1 - std::sqrt(0.08 * specular)) - 1);
    if (!(p.eta >= 1 && p.eta <= 100)) {
        throw object.property("eta").error(fmt::format("{} is not within [1, 100]", p.eta));
    }
    if (p.anisotropic > 0) {
        draft.depends_on_uv = true;
        if (draft.uv == UvConvention::none) {
            throw object.property("anisotropic")
                .error("the tangents of this shape do not match Mitsuba's; use 0");
        }
    }
    if (p.is_glass() && p.spec_tint == 0 && p.clearcoat == 0 && p.base_texture == nullptr) {
        draft.set_type("glass");
        draft.values = {{"two_sided", true},
                        {"eta", std::max(p.eta, 1.001)},
                        {"roughness", p.alpha()},
                        {"roughness_squared", p.roughness_texture != nullptr},
                        {"transmittance", Vector3d(p.base_color.cwiseSqrt())}};
        if (p.roughness_texture != nullptr) {
            draft.textures["roughness"] = p.roughness_texture;
        }
        return;
    }
    Composite composite =
        composite_of(object.element().located([&] { return principled_components(p); }));
    draft.type = composite.type;
    draft.values = std::move(composite.values);
    draft.values["two_sided"] = false;
    draft.textures = std::move(composite.textures);
}

double MaterialReader::read_factor(Object &object, const char *property,
                                   std::shared_ptr<Texture> &factor, Draft &draft) {
    const std::vector<Element> textures = object.objects("texture", property);
    if (textures.empty()) {
        return read_share(object, property, 0, draft);
    }
    if (textures.size() > 1 || object.has(property)) {
        throw object.element().error(fmt::format("duplicate property '{}'", property));
    }
    factor = mix_texture(textures[0], draft);
    return 1;
}

double MaterialReader::read_share(Object &object, const char *property, double initial,
                                  Draft &draft) {
    const std::vector<Element> textures = object.objects("texture", property);
    double value = 0;
    if (textures.empty()) {
        value = object.number(property, initial);
    } else {
        value = luminance(mean_of(*texture(textures[0], draft)->image()));
        notice(textures[0]
                   .error(fmt::format("{}: replaced by its mean, {:.3g}", property, value))
                   .what());
    }
    if (!(value >= 0 && value <= 1)) {
        throw object.element().error(fmt::format("{}: {} is not within [0, 1]", property, value));
    }
    return value;
}

}  // namespace rtrays::mitsuba
