// SPDX-License-Identifier: MIT
// Conversion of BSDFs to materials, with the parameters and defaults of Mitsuba 3.9
// (src/bsdfs/*.cpp).
#include "renderer/import/mitsuba/bsdf.h"

#include <fmt/format.h>

#include <algorithm>

#include "renderer/base/notice.h"
#include "renderer/import/mitsuba/blend.h"
#include "renderer/import/mitsuba/draft.h"
#include "renderer/import/mitsuba/ior.h"
#include "renderer/import/mitsuba/measured.h"
#include "renderer/import/mitsuba/plastic.h"
#include "renderer/import/models/names.h"
#include "renderer/import/models/textures.h"
#include "renderer/scene/graph.h"

namespace rtrays::mitsuba {

namespace {

using Eigen::Vector2d;
using Eigen::Vector3d;

double index_of_refraction(Object &object, const char *name, double initial) {
    if (!object.is(name, "string")) {
        return object.number(name, initial);
    }
    const std::string wanted = *object.text(name);
    std::string names;
    for (const IndexOfRefraction &row : indices_of_refraction) {
        if (wanted == row.name) {
            return row.value;
        }
        names += (names.empty() ? "" : ", ") + std::string(row.name);
    }
    throw object.property(name).error(fmt::format(
        "unknown index of refraction '{}'; give a number or one of: {}", wanted, names));
}

/// Returns the index of refraction of the inside relative to the outside.
double relative_index(Object &object, double inside) {
    constexpr double air = 1.000277;
    const double interior = index_of_refraction(object, "int_ior", inside);
    const double exterior = index_of_refraction(object, "ext_ior", air);
    if (!(interior > 0) || !(exterior > 0)) {
        throw object.element().error("int_ior and ext_ior must be positive");
    }
    return interior / exterior;
}

bool is_rough(const Object &object) {
    return object.type().rfind("rough", 0) == 0;
}

/// Sets eta and k of the conductor that the property "material" names.
void read_metal(Object &object, const std::string &name, ParameterValues &values) {
    const auto *found = std::find_if(std::begin(measured_metals), std::end(measured_metals),
                                     [&](const MeasuredMetal &row) { return name == row.name; });
    if (found == std::end(measured_metals)) {
        std::string names;
        for (const MeasuredMetal &row : measured_metals) {
            names += std::string(row.name) + ", ";
        }
        throw object.property("material")
            .error(
                fmt::format("unknown metal '{}'; give eta and k, or one of: {}none", name, names));
    }
    values["eta"] = Vector3d(found->eta[0], found->eta[1], found->eta[2]);
    values["k"] = Vector3d(found->k[0], found->k[1], found->k[2]);
}

}  // namespace

std::string NameList::unique(const std::string &wanted) {
    std::string name = wanted;
    std::replace(name.begin(), name.end(), '.', '_');
    std::string free = name;
    for (int i = 2; !taken_.insert(free).second; ++i) {
        free = fmt::format("{}_{}", name, i);
    }
    return free;
}

const std::vector<MaterialReader::Type> &MaterialReader::types() {
    static const std::vector<Type> all = {
        {"diffuse", &MaterialReader::read_diffuse},
        {"dielectric", &MaterialReader::read_dielectric},
        {"roughdielectric", &MaterialReader::read_dielectric},
        {"thindielectric", &MaterialReader::read_thin_dielectric},
        {"conductor", &MaterialReader::read_conductor},
        {"roughconductor", &MaterialReader::read_conductor},
        {"plastic", &MaterialReader::read_plastic},
        {"roughplastic", &MaterialReader::read_plastic},
        {"principled", &MaterialReader::read_principled},
        {"twosided", &MaterialReader::read_twosided},
        {"blendbsdf", &MaterialReader::read_blend},
        {"mask", &MaterialReader::read_mask},
        {"normalmap", &MaterialReader::read_normal_map},
        {"bumpmap", &MaterialReader::read_bump_map},
    };
    return all;
}

std::shared_ptr<MaterialCore> MaterialReader::read(const Element &bsdf, UvConvention uv,
                                                   const std::string &default_name,
                                                   const std::shared_ptr<Texture> &emission) {
    std::vector<Material> &known = materials_[bsdf.hash()];
    for (const Material &material : known) {
        if (emission == nullptr && (!material.depends_on_uv || material.uv == uv)) {
            return material.core;
        }
    }
    ErrorList errors;
    Draft draft = read_bsdf(bsdf, uv, errors);
    errors.raise(bsdf.source_name());
    if (emission != nullptr) {
        draft.values["emission"] = Vector3d(1, 1, 1);
        draft.textures["emission"] = emission;
        return bsdf.located([&] {
            return std::make_shared<MaterialCore>(material_names_.unique(default_name), draft.type,
                                                  draft.values, draft.textures);
        });
    }
    const bool has_id = bsdf.has("id");
    const std::string name = material_names_.unique(has_id ? bsdf.attribute("id") : default_name);
    const auto core = bsdf.located([&] {
        return std::make_shared<MaterialCore>(name, draft.type, draft.values, draft.textures);
    });
    if (has_id) {
        scene_.graph().share("materials." + name, core);
    }
    known.push_back({core, draft.depends_on_uv, uv});
    return core;
}

std::shared_ptr<MaterialCore> MaterialReader::standard(bool emits) {
    std::shared_ptr<MaterialCore> &core = standard_[emits ? 1 : 0];
    if (core == nullptr) {
        core = std::make_shared<MaterialCore>(
            material_names_.unique(emits ? "black" : "grey"), "lambert",
            ParameterValues{{"reflectance", Vector3d(Vector3d::Constant(emits ? 0 : 0.5))},
                            {"two_sided", false}});
    }
    return core;
}

std::shared_ptr<MaterialCore> MaterialReader::emitting(const std::shared_ptr<Texture> &emission) {
    return std::make_shared<MaterialCore>(material_names_.unique("black"), "lambert",
                                          ParameterValues{{"reflectance", Vector3d(0, 0, 0)},
                                                          {"two_sided", false},
                                                          {"emission", Vector3d(1, 1, 1)}},
                                          ParameterTextures{{"emission", emission}});
}

MaterialReader::Draft MaterialReader::read_bsdf(const Element &bsdf, UvConvention uv,
                                                ErrorList &errors) {
    // Bounds the number of components, and BSDFs that refer to themselves.
    constexpr int deepest = 4;
    if (nesting_ == deepest) {
        throw bsdf.error(fmt::format("BSDFs are nested deeper than {} levels", deepest));
    }
    Object object(bsdf, document_);
    std::string names;
    for (const Type &type : types()) {
        if (object.type() == type.name) {
            Draft draft{uv, nullptr, {{"two_sided", false}}, {}, &errors};
            ++nesting_;
            const bool is_read = errors.collect([&] { (this->*type.read)(object, draft); });
            --nesting_;
            if (is_read) {
                errors.collect([&] { object.finish(); });
            } else {
                errors.raise(bsdf.source_name());
            }
            return draft;
        }
        names += (names.empty() ? "" : ", ") + std::string(type.name);
    }
    throw bsdf.error(fmt::format("unsupported BSDF type; supported types are: {}", names));
}

std::vector<MaterialComponent> MaterialReader::nested_components(const Element &bsdf,
                                                                 const Draft &part, Draft &draft) {
    draft.depends_on_uv |= part.depends_on_uv;
    return bsdf.located(
        [&] { return MaterialCore("", part.type, part.values, part.textures).components(); });
}

void MaterialReader::read_twosided(Object &object, Draft &draft) {
    const std::vector<Element> inner = object.objects("bsdf");
    if (inner.empty() || inner.size() > 2) {
        throw object.element().error(fmt::format(
            "has {} BSDFs; expected one for both sides, or one for each side", inner.size()));
    }
    for (const Element &bsdf : inner) {
        const std::string type = bsdf.attribute("type");
        if (type == "twosided" || type == "thindielectric" || type == "dielectric" ||
            type == "roughdielectric") {
            throw bsdf.error("already two-sided; remove the enclosing twosided BSDF");
        }
        if (type == "mask") {
            throw bsdf.error("light passes it, so it cannot be two-sided; put twosided inside");
        }
    }
    Draft front = read_bsdf(inner[0], draft.uv, *draft.errors);
    front.values["two_sided"] = true;
    if (inner.size() == 1) {
        draft = front;
        if (draft.has_map()) {
            // Mitsuba turns the directions before it applies the map, so both sides look the same.
            draft.values["map_mirrored_back"] = true;
        }
        return;
    }
    Draft back = read_bsdf(inner[1], draft.uv, *draft.errors);
    std::vector<MaterialComponent> components;
    for (const bool is_front : {true, false}) {
        const Element &bsdf = inner[is_front ? 0 : 1];
        if ((is_front ? front : back).has_map()) {
            throw bsdf.error("a normal or bump map for one side only is unsupported");
        }
        for (MaterialComponent part : nested_components(bsdf, is_front ? front : back, draft)) {
            if (part.bxdf.kind == BxdfComponent::Kind::ideal_refraction ||
                part.bxdf.kind == BxdfComponent::Kind::microfacet_refraction) {
                throw bsdf.error("light passes it, so it cannot be on one side only");
            }
            part.bxdf.side = is_front ? BxdfComponent::Side::front : BxdfComponent::Side::back;
            components.push_back(part);
        }
    }
    set_composite(components, true, draft);
}

void MaterialReader::read_blend(Object &object, Draft &draft) {
    const std::vector<Element> inner = object.objects("bsdf");
    if (inner.size() != 2) {
        throw object.element().error(fmt::format("has {} BSDFs; expected two", inner.size()));
    }
    const std::vector<Element> textures = object.objects("texture", "weight");
    const std::shared_ptr<Texture> mix =
        textures.empty() ? nullptr : mix_texture(textures[0], draft);
    const double weight = mix != nullptr ? 1.0 : object.number("weight").value_or(-1);
    if (textures.size() > 1 || !(weight >= 0 && weight <= 1)) {
        throw object.element().error("expected a number from 0 to 1, or one texture, as weight");
    }
    std::vector<MaterialComponent> components;
    bool two_sided[2] = {};
    for (const size_t i : {0, 1}) {
        const Draft part = read_bsdf(inner[i], draft.uv, *draft.errors);
        if (part.has_opacity()) {
            throw inner[i].error("a blend of masks is unsupported; mask the blend instead");
        }
        if (part.has_map()) {
            throw inner[i].error(
                "a blend of normal or bump maps is unsupported; apply one map to the blend");
        }
        const auto core = nested_components(inner[i], part, draft);
        two_sided[i] = std::get<bool>(part.values.at("two_sided"));
        for (MaterialComponent component : core) {
            if (mix != nullptr && component.mix_texture != nullptr) {
                throw inner[i].error(
                    "its own weights are a texture, which is unsupported in a blend by a texture");
            }
            if (mix != nullptr) {
                component.mix_texture = mix;
                component.bxdf.mix_inverted = i == 0;
            } else if (component.bxdf.nonlinear) {
                throw inner[i].error(
                    "nonlinear: unsupported in a blend if diffuse_reflectance is a texture");
            }
            if (mix == nullptr) {
                component.bxdf.weight *= static_cast<float>(i == 0 ? 1 - weight : weight);
            }
            components.push_back(component);
        }
    }
    if (two_sided[0] != two_sided[1]) {
        throw object.element().error(
            "only one of the BSDFs is two-sided; make both or none of them so");
    }
    set_composite(components, two_sided[0], draft);
}

void MaterialReader::set_composite(const std::vector<MaterialComponent> &components, bool two_sided,
                                   Draft &draft) {
    Composite composite = composite_of(components);
    draft.type = composite.type;
    draft.values = std::move(composite.values);
    draft.values["two_sided"] = two_sided;
    draft.textures = std::move(composite.textures);
}

void MaterialReader::read_mask(Object &object, Draft &draft) {
    const std::vector<Element> inner = object.objects("bsdf");
    if (inner.size() != 1) {
        throw object.element().error(fmt::format("has {} BSDFs; expected one", inner.size()));
    }
    draft = read_bsdf(inner[0], draft.uv, *draft.errors);
    if (draft.has_opacity()) {
        throw inner[0].error("a mask in a mask is unsupported; multiply their opacities");
    }
    const std::vector<Element> textures = object.objects("texture", "opacity");
    if (textures.size() > 1 || (!textures.empty() && object.has("opacity"))) {
        throw object.element().error("duplicate property 'opacity'");
    }
    if (!textures.empty()) {
        draft.textures["opacity"] = texture(textures[0], draft, TextureUse::number);
        return;
    }
    // Mitsuba uses the luminance of a colour.
    const Vector3d colour = object.colour("opacity").value_or(Vector3d::Constant(0.5));
    const double opacity = luminance(colour);
    if (!(opacity >= 0 && opacity <= 1)) {
        throw object.property("opacity").error(fmt::format("{} is not within [0, 1]", opacity));
    }
    draft.values["opacity"] = opacity;
}

void MaterialReader::read_map(Object &object, const std::vector<Element> &textures,
                              const char *parameter, Draft &draft) {
    const std::vector<Element> inner = object.objects("bsdf");
    if (inner.size() != 1 || textures.size() != 1) {
        throw object.element().error(
            fmt::format("has {} BSDFs and {} textures of the map; expected one of each",
                        inner.size(), textures.size()));
    }
    draft = read_bsdf(inner[0], draft.uv, *draft.errors);
    if (draft.has_map()) {
        throw inner[0].error("a map in a map is unsupported; combine their images");
    }
    if (draft.has_opacity()) {
        throw inner[0].error("a mask in a map is unsupported; put the map inside the mask");
    }
    if (!object.boolean("flip_invalid_normals", true)) {
        throw object.property("flip_invalid_normals")
            .error("false is unsupported: the normals would be black where they face away");
    }
    draft.values["map_shadowing"] = object.boolean("use_shadowing_function", true);
    draft.values["map_mirrored_back"] = false;
    const std::shared_ptr<Texture> map = texture(textures[0], draft);
    if (map->image()->srgb) {
        notice(textures[0]
                   .error("raw is false, so the map is decoded from sRGB, as in Mitsuba; maps are "
                          "usually linear data, with raw set to true")
                   .what());
    }
    draft.textures[parameter] = map;
}

void MaterialReader::read_normal_map(Object &object, Draft &draft) {
    read_map(object, object.objects("texture", "normalmap"), "normal_map", draft);
}

void MaterialReader::read_bump_map(Object &object, Draft &draft) {
    const double scale = object.number("scale", 1);
    read_map(object, object.objects("texture"), "bump_map", draft);
    draft.values["bump_map"] = scale;
}

void MaterialReader::read_diffuse(Object &object, Draft &draft) {
    draft.set_type("lambert");
    read_colour(object, "reflectance", "reflectance", 0.5, draft);
}

void MaterialReader::read_glass(Object &object, const char *type, Draft &draft) {
    constexpr double bk7 = 1.5046;
    draft.set_type(type);
    draft.values["two_sided"] = true;
    draft.values["eta"] = relative_index(object, bk7);
    read_colour(object, "specular_reflectance", "reflectance", 1, draft);
    read_colour(object, "specular_transmittance", "transmittance", 1, draft);
}

void MaterialReader::read_dielectric(Object &object, Draft &draft) {
    read_glass(object, "glass", draft);
    if (is_rough(object)) {
        read_roughness(object, draft);
    }
}

void MaterialReader::read_thin_dielectric(Object &object, Draft &draft) {
    read_glass(object, "thin_glass", draft);
}

void MaterialReader::read_conductor(Object &object, Draft &draft) {
    draft.set_type("metal");
    const std::string none = "none";
    const std::optional<Vector3d> eta = object.colour("eta", SpectrumUse::index);
    const std::optional<Vector3d> k = object.colour("k", SpectrumUse::index);
    const std::optional<std::string> material = object.text("material");
    if (eta.has_value() != k.has_value() || (eta.has_value() && material.has_value())) {
        throw object.element().error(
            "expected eta and k together, or a material, or neither for an ideal mirror");
    }
    if (eta.has_value()) {
        draft.values["eta"] = *eta;
        draft.values["k"] = *k;
    } else if (!material.has_value() || *material == none) {
        draft.values["fresnel"] = std::string("ideal");
    } else {
        read_metal(object, *material, draft.values);
    }
    read_colour(object, "specular_reflectance", "reflectance", 1, draft);
    if (is_rough(object)) {
        read_roughness(object, draft);
        draft.values["model"] = draft.values.at("distribution");
        draft.values.erase("distribution");
    }
}

void MaterialReader::read_plastic(Object &object, Draft &draft) {
    constexpr double polypropylene = 1.49;
    draft.type = plastic_type();
    draft.values["eta"] = relative_index(object, polypropylene);
    draft.values["nonlinear"] = object.boolean("nonlinear", false);
    read_colour(object, "diffuse_reflectance", "diffuse_reflectance", 0.5, draft);
    read_colour(object, "specular_reflectance", "specular_reflectance", 1, draft);
    if (is_rough(object)) {
        read_roughness(object, draft);
        const Vector2d alpha = std::get<Vector2d>(draft.values.at("roughness"));
        if (alpha[0] != alpha[1]) {
            throw object.element().error(
                "alpha_u and alpha_v differ, which is an error in Mitsuba; give one alpha");
        }
        if (draft.textures.count("roughness") != 0) {
            throw object.element().error("alpha: a texture is an error in Mitsuba; give a number");
        }
        draft.values["roughness"] = alpha[0];
    }
}

void MaterialReader::read_roughness(Object &object, Draft &draft) {
    const bool both = object.has("alpha");
    if (both && (object.has("alpha_u") || object.has("alpha_v"))) {
        throw object.element().error(
            "has both alpha and alpha_u or alpha_v; give alpha, or both alpha_u and alpha_v");
    }
    if (!both && object.has("alpha_u") != object.has("alpha_v")) {
        throw object.element().error("needs both alpha_u and alpha_v, or alpha");
    }
    const std::vector<Element> textures = object.objects("texture", "alpha");
    const bool numbers = both || object.has("alpha_u") || object.has("alpha_v");
    if (textures.size() > 1 || (!textures.empty() && numbers)) {
        throw object.element().error("alpha: give one texture, or numbers");
    }
    if (!textures.empty()) {
        draft.textures["roughness"] = texture(textures[0], draft, TextureUse::number);
    }
    const double alpha = textures.empty() ? object.number("alpha", 0.1) : 1;
    const Vector2d roughness(object.number("alpha_u", alpha), object.number("alpha_v", alpha));
    object.ignore("sample_visible");  // affects noise only
    const std::vector<std::string> names = {"beckmann", "ggx"};
    draft.values["roughness"] = roughness;
    draft.values["distribution"] = names[object.choice("distribution", names, 0)];
    if (roughness.minCoeff() < 1e-4 || roughness.maxCoeff() > 1) {
        throw object.element().error(fmt::format(
            "alpha: [{}, {}] is not within [0.0001, 1]; for a smooth surface use type {}",
            roughness[0], roughness[1], object.type().substr(5)));
    }
    if (roughness[0] != roughness[1]) {
        draft.depends_on_uv = true;
        if (draft.uv == UvConvention::none) {
            throw object.element().error(
                "alpha_u and alpha_v differ, but the tangents of this shape do not match "
                "Mitsuba's; use one alpha");
        }
    }
}

void MaterialReader::read_colour(Object &object, const char *property, const char *parameter,
                                 double initial, Draft &draft) {
    const std::vector<Element> textures = object.objects("texture", property);
    draft.values[parameter] = Vector3d(1, 1, 1);
    draft.errors->collect([&] {
        if (textures.size() > 1 || (!textures.empty() && object.has(property))) {
            throw object.element().error(fmt::format("duplicate property '{}'", property));
        }
        if (!textures.empty()) {
            draft.textures[parameter] = texture(textures[0], draft);
            return;
        }
        const Vector3d colour = object.colour(property).value_or(Vector3d::Constant(initial));
        // Checked here already, because the line is known here.
        if (colour.minCoeff() < 0 || colour.maxCoeff() > 1) {
            throw object.property(property).error(
                fmt::format("[{}, {}, {}] is not within [0, 1]", colour[0], colour[1], colour[2]));
        }
        draft.values[parameter] = colour;
    });
}

std::shared_ptr<Texture> MaterialReader::mix_texture(const Element &element, Draft &draft) {
    const std::shared_ptr<Texture> made = texture(element, draft, TextureUse::number);
    const double brightest = brightest_luminance(*made);
    if (!(brightest <= 1 + 1e-6)) {
        throw element.error(fmt::format("its brightest texel, {:.6g}, exceeds 1", brightest));
    }
    return made;
}

std::shared_ptr<Texture> MaterialReader::texture(const Element &element, Draft &draft,
                                                 TextureUse use) {
    draft.depends_on_uv |= element.attribute("type") != "mesh_attribute";
    return texture(element, draft.uv, use);
}

}  // namespace rtrays::mitsuba
