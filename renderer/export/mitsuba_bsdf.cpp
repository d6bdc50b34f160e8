// SPDX-License-Identifier: MIT
#include "renderer/export/mitsuba_bsdf.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "renderer/export/mitsuba_principled.h"
#include "renderer/import/images/texture_file.h"
#include "renderer/import/mitsuba/plastic.h"
#include "renderer/import/models/textures.h"
#include "renderer/scene/cores/composite.h"
#include "renderer/scene/cores/texture.h"

namespace rtrays::mitsuba {

namespace {

using Eigen::Vector2d;
using Eigen::Vector3d;
using Kind = BxdfComponent::Kind;

/// Returns the formula of a material, such as "ideal_reflection * dielectric + lambert * (1 -
/// dielectric)".
std::string formula(const std::vector<BxdfComponent> &parts) {
    std::string text;
    for (const BxdfComponent &part : parts) {
        text += (text.empty() ? "" : " + ") + bxdf_names()[static_cast<size_t>(part.kind)];
        if (part.fresnel != BxdfComponent::Fresnel::ideal) {
            const std::string term = fresnel_names()[static_cast<size_t>(part.fresnel)] +
                                     (part.fresnel_of_wo ? " of wo" : "");
            text += part.complement ? " * (1 - " + term + ")" : " * " + term;
        }
    }
    return text;
}

bool is_rough(const BxdfComponent &part) {
    return part.kind == Kind::microfacet_reflection || part.kind == Kind::microfacet_refraction;
}

}  // namespace

const std::vector<BsdfWriter::Recipe> &BsdfWriter::recipes() {
    static const std::vector<Recipe> all = {
        {"lambert", "diffuse", false, &BsdfWriter::write_diffuse},
        {"ideal_reflection", "conductor", false, &BsdfWriter::write_conductor},
        {"ideal_reflection * conductor", "conductor", false, &BsdfWriter::write_conductor},
        {"microfacet_reflection", "conductor", false, &BsdfWriter::write_conductor},
        {"microfacet_reflection * conductor", "conductor", false, &BsdfWriter::write_conductor},
        {"ideal_reflection * dielectric + ideal_refraction * (1 - dielectric)", "dielectric", true,
         &BsdfWriter::write_dielectric},
        {"ideal_reflection * thin_dielectric + ideal_refraction * (1 - thin_dielectric)",
         "thindielectric", true, &BsdfWriter::write_thin_dielectric},
        {"microfacet_reflection * dielectric + microfacet_refraction * (1 - dielectric)",
         "dielectric", true, &BsdfWriter::write_dielectric},
        {"ideal_reflection * dielectric + lambert * (1 - dielectric)", "plastic", false,
         &BsdfWriter::write_plastic},
        {"ideal_reflection * dielectric + coated_lambert", "plastic", false,
         &BsdfWriter::write_coated},
        {"microfacet_reflection * dielectric + coated_lambert", "plastic", false,
         &BsdfWriter::write_coated},
    };
    return all;
}

const BsdfWriter::Recipe *BsdfWriter::recipe(const std::vector<BxdfComponent> &parts) {
    const std::string wanted = formula(parts);
    const auto row = std::find_if(recipes().begin(), recipes().end(),
                                  [&](const Recipe &known) { return wanted == known.components; });
    return row == recipes().end() ? nullptr : &*row;
}

Error BsdfWriter::unknown(const std::vector<BxdfComponent> &parts) {
    std::string known;
    for (const Recipe &row : recipes()) {
        known += std::string(row.components) + "; ";
    }
    return input_error(
        fmt::format("Mitsuba has no BSDF for {}; supported are: {}the lobes of "
                    "Mitsuba's principled BSDF",
                    formula(parts), known));
}

std::string BsdfWriter::id(uint32_t material, UvConvention uv) {
    const MaterialArrays &materials = arrays_.materials;
    const BxdfComponent *parts = &materials.component[materials.first_component[material]];
    const bool depends_on_uv =
        materials.opacity[material].texture != no_index ||
        materials.normal_map[material].kind != NormalMap::Kind::none ||
        std::any_of(parts, parts + materials.component_count[material],
                    [&](const BxdfComponent &part) {
                        return (part.texture != no_index && !is_constant(part.texture)) ||
                               part.roughness_texture != no_index ||
                               (is_rough(part) && part.alpha[0] != part.alpha[1]);
                    });
    if (depends_on_uv && uv == UvConvention::none) {
        throw input_error(fmt::format(
            "material '{}': its texture or anisotropic roughness needs texture coordinates that "
            "agree with Mitsuba's; use a mesh with texture coordinates, a sphere or a cylinder",
            materials.name[material]));
    }
    std::string &id = written_[{material, depends_on_uv ? uv : UvConvention::none}];
    if (id.empty()) {
        id = ids_.unique(materials.name[material]);
        try {
            const bool is_opaque = materials.opacity[material].is_opaque();
            const pugi::xml_node parent =
                is_opaque ? scene_ : write_mask(materials.opacity[material], id, uv);
            write_sides(parent, is_opaque ? id : std::string(), material, uv);
        } catch (const Error &error) {
            throw Error(error.exit_code(),
                        fmt::format("material '{}': {}", materials.name[material], error.what()));
        }
    }
    return id;
}

bool BsdfWriter::is_constant(uint32_t texture) const {
    const TextureImage &image = *arrays_.textures.image[texture];
    return arrays_.textures.has_vertex_colours(texture) && image.width == 1 && image.height == 1;
}

bool BsdfWriter::has_vertex_colours(uint32_t material) const {
    const MaterialArrays &materials = arrays_.materials;
    const BxdfComponent *parts = &materials.component[materials.first_component[material]];
    return std::any_of(
        parts, parts + materials.component_count[material], [&](const BxdfComponent &part) {
            return part.texture != no_index && arrays_.textures.has_vertex_colours(part.texture);
        });
}

void BsdfWriter::write_radiance(pugi::xml_node emitter, const Rgb &radiance, uint32_t material,
                                UvConvention uv) {
    const uint32_t texture = arrays_.materials.emission_texture[material];
    if (texture != no_index && uv == UvConvention::none) {
        throw input_error(fmt::format(
            "material '{}': the texture of its emission needs texture coordinates that agree with "
            "Mitsuba's; use a mesh with texture coordinates or a sphere",
            arrays_.materials.name[material]));
    }
    write_weight(emitter, "radiance", radiance.cast<double>(), texture, uv);
}

void BsdfWriter::write_sides(pugi::xml_node parent, std::string id, uint32_t material,
                             UvConvention uv) {
    using Side = BxdfComponent::Side;
    const MaterialArrays &materials = arrays_.materials;
    std::vector<BxdfComponent> front, back;
    bool differ = false;
    for (uint32_t i = 0; i < materials.component_count[material]; ++i) {
        const BxdfComponent &part = materials.component[materials.first_component[material] + i];
        differ = differ || part.side != Side::both;
        if (part.side != Side::back) {
            front.push_back(part);
        }
        if (part.side != Side::front) {
            back.push_back(part);
        }
    }
    const Recipe *row = front.empty() ? nullptr : recipe(front);
    const bool transmits = row != nullptr && row->transmits;
    const bool is_two_sided = !transmits && materials.two_sided[material] != 0;
    const NormalMap &map = materials.normal_map[material];
    const bool mapped = map.kind != NormalMap::Kind::none;
    const bool maps_sides = mapped && is_two_sided && map.mirrored_back;
    if (mapped && !maps_sides) {
        parent = write_map(parent, material, std::exchange(id, {}), uv);
    }
    if (is_two_sided) {
        parent = add_object(parent, "bsdf", "twosided", std::exchange(id, {}));
    }
    const auto side = [&] { return maps_sides ? write_map(parent, material, {}, uv) : parent; };
    write_parts(side(), id, front, uv);
    if (is_two_sided && differ) {
        write_parts(side(), {}, back, uv);
    }
}

void BsdfWriter::write_parts(pugi::xml_node parent, const std::string &id,
                             const std::vector<BxdfComponent> &parts, UvConvention uv) {
    if (parts.empty()) {
        add_number(add_object(parent, "bsdf", "diffuse", id), "reflectance", 0);
        return;
    }
    if (std::any_of(parts.begin(), parts.end(),
                    [](const BxdfComponent &part) { return part.mix_texture != no_index; })) {
        throw input_error("the export to Mitsuba writes no mixture by a texture");
    }
    if (const Recipe *row = recipe(parts)) {
        const std::string plugin = (is_rough(parts[0]) ? "rough" : "") + std::string(row->plugin);
        (this->*row->write)(add_object(parent, "bsdf", plugin, id), parts.data(), uv);
    } else if (const auto principled = principled_of(parts, arrays_.textures)) {
        write_principled(add_object(parent, "bsdf", "principled", id), *principled, uv);
    } else {
        throw unknown(parts);
    }
}

void BsdfWriter::write_principled(pugi::xml_node bsdf, const PrincipledBsdf &principled,
                                  UvConvention uv) {
    const Principled &p = principled.parameters;
    write_weight(bsdf, "base_color", p.base_color, principled.base_texture, uv);
    if (principled.roughness_texture == no_index) {
        add_number(bsdf, "roughness", p.roughness);
    } else {
        write_weight(bsdf, "roughness", Vector3d::Constant(p.roughness),
                     principled.roughness_texture, uv);
    }
    const auto add_share = [&](const char *name, double value) {
        add_number(bsdf, name, std::clamp(value, 0.0, 1.0));  // rounding
    };
    add_share("metallic", p.metallic);
    add_share("anisotropic", p.anisotropic);
    add_share("spec_tint", p.spec_tint);
    add_share("sheen", p.sheen);
    add_share("sheen_tint", p.sheen_tint);
    add_share("flatness", p.flatness);
    add_share("clearcoat", p.clearcoat);
    add_share("clearcoat_gloss", p.clearcoat_gloss);
    if (p.eta > 1) {
        add_number(bsdf, "eta", p.eta);
    } else {
        add_number(bsdf, "specular", 0);  // Mitsuba has no eta of 1
    }
}

pugi::xml_node BsdfWriter::write_mask(const MaterialOpacity &opacity, const std::string &id,
                                      UvConvention uv) {
    if (opacity.cutoff > 0 && opacity.texture != no_index) {
        throw input_error(
            "Mitsuba has no cutoff of an opacity texture; set opacity_cutoff to 0, or use an image "
            "of zeros and ones");
    }
    const double value = opacity.cutoff > 0 ? 0 : opacity.value;  // below the cutoff
    pugi::xml_node mask = add_object(scene_, "bsdf", "mask", id);
    if (opacity.texture == no_index) {
        add_number(mask, "opacity", value);
    } else {
        write_weight(mask, "opacity", Vector3d::Constant(value), opacity.texture, uv);
    }
    return mask;
}

bool BsdfWriter::has_mirrored_uv(uint32_t material) const {
    const MeshArrays &meshes = arrays_.meshes;
    for (size_t i = 0; i < meshes.triangle.size() && !meshes.uv.empty(); ++i) {
        const auto &[a, b, c] = meshes.triangle[i];
        const Eigen::Vector2f along1 = meshes.uv[b] - meshes.uv[a],
                              along2 = meshes.uv[c] - meshes.uv[a];
        if (meshes.material[meshes.triangle_mesh[i]] == material &&
            along1.x() * along2.y() < along2.x() * along1.y()) {
            return true;
        }
    }
    return false;
}

pugi::xml_node BsdfWriter::write_map(pugi::xml_node parent, uint32_t material,
                                     const std::string &id, UvConvention uv) {
    const NormalMap &map = arrays_.materials.normal_map[material];
    const bool has_heights = map.kind == NormalMap::Kind::heights;
    if (!has_heights && map.follows_v && has_mirrored_uv(material)) {
        throw input_error(
            "the y axis of Mitsuba's normal maps does not follow mirrored texture coordinates; set "
            "map_follows_v to false");
    }
    pugi::xml_node bsdf = add_object(parent, "bsdf", has_heights ? "bumpmap" : "normalmap", id);
    add_boolean(bsdf, "use_shadowing_function", map.shadowing);
    if (has_heights) {
        add_number(bsdf, "scale", map.scale);
        write_weight(bsdf, "heights", Vector3d::Ones(), map.texture, uv);
    } else {
        // A texel t becomes (s (2 t - 1) + 1) / 2 for the factor s of its component. Lengths do not
        // matter, so no factor need be above 1.
        const double largest = std::max(1.0, std::abs(map.scale));
        const Vector3d factor = Vector3d(map.scale, map.scale, 1) / largest;
        write_weight(bsdf, "normalmap", factor, map.texture, uv,
                     Vector3d::Constant(0.5) - 0.5 * factor);
    }
    return bsdf;
}

void BsdfWriter::write_diffuse(pugi::xml_node bsdf, const BxdfComponent *parts, UvConvention uv) {
    write_weight(bsdf, "reflectance", parts[0].weight.cast<double>(), parts[0].texture, uv);
}

void BsdfWriter::write_conductor(pugi::xml_node bsdf, const BxdfComponent *parts, UvConvention uv) {
    if (parts[0].fresnel == BxdfComponent::Fresnel::ideal) {
        add_property(bsdf, "string", "material", "none");
    } else {
        add_colour(bsdf, "eta", parts[0].eta);
        add_colour(bsdf, "k", parts[0].k);
    }
    write_roughness(bsdf, parts[0], uv);
    write_weight(bsdf, "specular_reflectance", parts[0].weight.cast<double>(), parts[0].texture,
                 uv);
}

void BsdfWriter::write_dielectric(pugi::xml_node bsdf, const BxdfComponent *parts,
                                  UvConvention uv) {
    if (parts[0].eta != parts[1].eta || parts[0].alpha != parts[1].alpha ||
        parts[0].roughness_texture != parts[1].roughness_texture ||
        parts[0].distribution != parts[1].distribution) {
        throw input_error(
            "the reflecting and the refracting component must have the same eta, roughness and "
            "distribution");
    }
    add_number(bsdf, "int_ior", parts[0].eta[0]);
    add_number(bsdf, "ext_ior", 1);
    write_roughness(bsdf, parts[0], uv);
    write_weight(bsdf, "specular_reflectance", parts[0].weight.cast<double>(), parts[0].texture,
                 uv);
    write_weight(bsdf, "specular_transmittance", parts[1].weight.cast<double>(), parts[1].texture,
                 uv);
}

void BsdfWriter::write_thin_dielectric(pugi::xml_node bsdf, const BxdfComponent *parts,
                                       UvConvention uv) {
    if (parts[0].eta != parts[1].eta) {
        throw input_error("the reflection and the transmission must have the same eta");
    }
    add_number(bsdf, "int_ior", parts[0].eta[1]);
    add_number(bsdf, "ext_ior", 1);
    write_weight(bsdf, "specular_reflectance", parts[0].weight.cast<double>(), parts[0].texture,
                 uv);
    write_weight(bsdf, "specular_transmittance", parts[1].weight.cast<double>(), parts[1].texture,
                 uv);
}

void BsdfWriter::check_plastic(const BxdfComponent *parts) const {
    for (size_t i = 0; i < 2; ++i) {
        if (parts[i].texture != no_index && arrays_.textures.has_vertex_colours(parts[i].texture)) {
            throw input_error(
                "Mitsuba's plastics need the mean of their textures, which vertex colours lack");
        }
    }
}

void BsdfWriter::write_plastic(pugi::xml_node bsdf, const BxdfComponent *parts, UvConvention uv) {
    check_plastic(parts);
    const double eta = parts[0].eta[0];
    if (parts[1].eta[0] != eta || !(eta > 1) || eta > 3) {
        throw input_error(
            fmt::format("the coat and the base must have the same eta, in (1, 3], got {} and {}",
                        eta, parts[1].eta[0]));
    }
    add_number(bsdf, "int_ior", eta);
    add_number(bsdf, "ext_ior", 1);
    add_boolean(bsdf, "nonlinear", false);
    write_weight(bsdf, "specular_reflectance", parts[0].weight.cast<double>(), parts[0].texture,
                 uv);
    // Mitsuba multiplies by this factor, for the light reflected back and forth below the coat.
    const Vector3d factor = plastic_base_weight(Vector3d::Ones(), eta, false);
    write_weight(bsdf, "diffuse_reflectance", parts[1].weight.cast<double>().cwiseQuotient(factor),
                 parts[1].texture, uv);
}

void BsdfWriter::write_coated(pugi::xml_node bsdf, const BxdfComponent *parts, UvConvention uv) {
    check_plastic(parts);
    const BxdfComponent &surface = parts[0], &base = parts[1];
    if (surface.eta[0] != base.eta[0] || (is_rough(surface) && surface.alpha != base.alpha) ||
        (!is_rough(surface) && base.alpha[0] != 0) ||
        (is_rough(surface) && surface.distribution != base.distribution)) {
        throw input_error(
            "the coat and the component below it must have the same eta, roughness and "
            "distribution");
    }
    if (surface.roughness_texture != no_index) {
        throw input_error("Mitsuba's coat takes no texture of its roughness");
    }
    const Coat coat{base.eta[0], base.alpha[0], base.distribution};
    const double inner = plastic_inner_reflectance(coat);
    const double own =
        base.inner_reflectance >= 0 ? base.inner_reflectance : coat_diffuse_reflectance(coat);
    Vector3d weight = base.weight.cast<double>();
    if (!base.nonlinear) {
        weight *= (1 - inner) / (1 - own);  // Mitsuba divides by 1 - inner
    } else if (std::abs(inner - own) > 1e-5) {
        throw input_error(fmt::format(
            "Mitsuba's coat reflects {:.5f} of the light below it back, this one {:.5f}, which a "
            "nonlinear base cannot compensate; set nonlinear to false, or inner_reflectance to "
            "Mitsuba's",
            inner, own));
    }
    add_number(bsdf, "int_ior", coat.eta);
    add_number(bsdf, "ext_ior", 1);
    add_boolean(bsdf, "nonlinear", base.nonlinear);
    write_roughness(bsdf, surface, uv);
    write_weight(bsdf, "specular_reflectance", surface.weight.cast<double>(), surface.texture, uv);
    write_weight(bsdf, "diffuse_reflectance", weight, base.texture, uv);
}

void BsdfWriter::write_roughness(pugi::xml_node bsdf, const BxdfComponent &part, UvConvention uv) {
    if (!is_rough(part)) {
        return;
    }
    add_property(bsdf, "string", "distribution",
                 part.distribution == BxdfComponent::Distribution::ggx ? "ggx" : "beckmann");
    if (part.roughness_texture != no_index) {
        if (part.roughness_squared || part.alpha[0] != part.alpha[1]) {
            throw input_error(
                "Mitsuba has no texture whose square scales the roughness, or that scales an "
                "anisotropic one; set roughness_squared to false, and one roughness");
        }
        write_weight(bsdf, "alpha", Vector3d::Constant(part.alpha[0]), part.roughness_texture, uv);
    } else if (part.alpha[0] == part.alpha[1]) {
        add_number(bsdf, "alpha", part.alpha[0]);
    } else {
        add_number(bsdf, "alpha_u", part.alpha[0]);
        add_number(bsdf, "alpha_v", part.alpha[1]);
    }
}

void BsdfWriter::write_weight(pugi::xml_node bsdf, const char *name, const Vector3d &weight,
                              uint32_t texture, UvConvention uv, const Vector3d &offset) {
    if (texture == no_index) {
        add_colour(bsdf, name, weight);
        return;
    }
    const TextureArrays &textures = arrays_.textures;
    if (textures.has_vertex_colours(texture)) {
        write_vertex_colours(bsdf, name, weight, texture);
        return;
    }
    pugi::xml_node node = add_object(bsdf, "texture", "bitmap");
    node.append_attribute("name") = name;
    add_property(node, "string", "filename", image_file(texture, weight, offset));
    add_property(
        node, "string", "filter_type",
        textures.filter[texture] == TextureArrays::Filter::nearest ? "nearest" : "bilinear");
    add_property(node, "string", "wrap_mode",
                 wrap_names()[static_cast<size_t>(textures.wrap[texture])]);
    const TextureImage &image = *textures.image[texture];
    const bool decodes = image.floats.empty() && image.srgb && weight == Vector3d::Ones();
    add_boolean(node, "raw", !decodes);

    // The inverse of the importer's mapping: Mitsuba's rows run from the top.
    const Vector2d &scale = textures.uv_scale[texture];
    const Vector2d &uv_offset = textures.uv_offset[texture];
    const bool flipped = uv == UvConvention::flipped;
    const Vector2d to_scale(scale[0], flipped ? scale[1] : -scale[1]);
    const Vector2d to_offset(uv_offset[0],
                             flipped ? 1 - scale[1] - uv_offset[1] : 1 - uv_offset[1]);
    if (to_scale == Vector2d::Ones() && to_offset == Vector2d::Zero()) {
        return;
    }
    if (to_scale[0] == 0 || to_scale[1] == 0) {
        throw input_error(fmt::format("texture '{}': Mitsuba does not support a uv_scale of 0",
                                      textures.name[texture]));
    }
    pugi::xml_node transform = node.append_child("transform");
    transform.append_attribute("name") = "to_uv";
    transform.append_child("scale").append_attribute("value") =
        fmt::format("{}, {}, 1", to_scale[0], to_scale[1]).c_str();
    transform.append_child("translate").append_attribute("value") =
        fmt::format("{}, {}, 0", to_offset[0], to_offset[1]).c_str();
}

void BsdfWriter::write_vertex_colours(pugi::xml_node bsdf, const char *name, const Vector3d &weight,
                                      uint32_t texture) {
    const Vector3d factor = weight.cwiseProduct(mean_of(*arrays_.textures.image[texture]));
    if (!is_constant(texture) || factor.minCoeff() != factor.maxCoeff()) {
        throw input_error(fmt::format(
            "texture '{}': Mitsuba multiplies vertex colours by one number only; remove the image, "
            "or use a grey colour",
            arrays_.textures.name[texture]));
    }
    pugi::xml_node node = add_object(bsdf, "texture", "mesh_attribute");
    node.append_attribute("name") = name;
    add_property(node, "string", "name", "vertex_color");
    add_number(node, "scale", factor[0]);
}

std::string BsdfWriter::image_file(uint32_t texture, const Vector3d &weight,
                                   const Vector3d &offset) {
    const std::shared_ptr<const TextureImage> &image = arrays_.textures.image[texture];
    std::string &file =
        images_[{image.get(), weight[0], weight[1], weight[2], offset[0], offset[2]}];
    if (!file.empty()) {
        return file;
    }
    const std::string &name = arrays_.textures.name[texture];
    TextureImage written = *image;
    if (weight != Vector3d::Ones()) {
        // A bitmap has no factor, so its texels are multiplied.
        written.floats.resize(3 * static_cast<size_t>(image->width) *
                              static_cast<size_t>(image->height));
        for (size_t i = 0; i < written.floats.size(); ++i) {
            const auto channel = static_cast<Eigen::Index>(i % 3);
            written.floats[i] =
                static_cast<float>(decoded_channel(*image, i) * weight[channel] + offset[channel]);
        }
    }
    const std::filesystem::path path =
        folder_.new_file(name, written.floats.empty() ? ".png" : ".exr");
    write_texture_file(written, path);
    return file = folder_.relative(path);
}

}  // namespace rtrays::mitsuba
