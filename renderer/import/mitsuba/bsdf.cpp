// SPDX-License-Identifier: MIT
// Conversion of BSDFs to materials, with the parameters and defaults of Mitsuba 3.9
// (src/bsdfs/*.cpp).
#include "renderer/import/mitsuba/bsdf.h"

#include <fmt/format.h>

#include <algorithm>

#include "renderer/base/notice.h"
#include "renderer/import/mitsuba/ior.h"
#include "renderer/import/mitsuba/plastic.h"
#include "renderer/scene/graph.h"

namespace rtrays::mitsuba {

namespace {

using Eigen::Vector2d;
using Eigen::Vector3d;

/// Maximum roughness of a plastic. Mitsuba's base below a rough coat is darker than our base, which
/// is lit as through a smooth coat. Measured ratios are 0.961 at roughness 0.1, 0.915 at 0.2 and
/// 0.851 at 0.3, for an index of 1.5 and away from grazing angles. Beyond 0.2 the two models
/// disagree by more than a tenth.
constexpr double roughest_plastic = 0.2;

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

/// Mitsuba's names of our metal presets. Both names refer to the same measurements.
struct MetalName {
    const char *mitsuba;
    const char *ours;
};
constexpr MetalName metal_names[] = {{"Ag", "silver"}, {"Au", "gold"}, {"Cu", "copper"}};

}  // namespace

/// A material under construction.
struct MaterialReader::Draft {
    UvConvention uv;
    std::shared_ptr<const MaterialType> type;
    ParameterValues values;
    ParameterTextures textures;
    bool depends_on_uv = false;

    void set_type(const char *name) {
        type = static_type(find_type(material_types(), name, "material"));
    }
};

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
        {"conductor", &MaterialReader::read_conductor},
        {"roughconductor", &MaterialReader::read_conductor},
        {"plastic", &MaterialReader::read_plastic},
        {"roughplastic", &MaterialReader::read_plastic},
        {"twosided", &MaterialReader::read_twosided},
    };
    return all;
}

std::shared_ptr<MaterialCore> MaterialReader::read(const Element &bsdf, UvConvention uv,
                                                   const std::string &default_name) {
    std::vector<Material> &known = materials_[bsdf.hash()];
    for (const Material &material : known) {
        if (!material.depends_on_uv || material.uv == uv) {
            return material.core;
        }
    }
    const Draft draft = read_bsdf(bsdf, uv);
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

MaterialReader::Draft MaterialReader::read_bsdf(const Element &bsdf, UvConvention uv) {
    Object object(bsdf, document_);
    std::string names;
    for (const Type &type : types()) {
        if (object.type() == type.name) {
            Draft draft{uv, nullptr, {{"two_sided", false}}, {}};
            (this->*type.read)(object, draft);
            object.finish();
            return draft;
        }
        names += (names.empty() ? "" : ", ") + std::string(type.name);
    }
    throw bsdf.error(fmt::format("unsupported BSDF type; supported types are: {}", names));
}

void MaterialReader::read_twosided(Object &object, Draft &draft) {
    const std::vector<Element> inner = object.objects("bsdf");
    if (inner.size() != 1) {
        throw object.element().error(
            fmt::format("has {} BSDFs; expected one, which is used for both sides", inner.size()));
    }
    const std::string type = inner[0].attribute("type");
    if (type == "twosided" || type == "dielectric" || type == "roughdielectric") {
        throw inner[0].error("already two-sided; remove the enclosing twosided BSDF");
    }
    draft = read_bsdf(inner[0], draft.uv);
    draft.values["two_sided"] = true;
}

void MaterialReader::read_diffuse(Object &object, Draft &draft) {
    draft.set_type("lambert");
    read_colour(object, "reflectance", "reflectance", 0.5, draft);
}

void MaterialReader::read_dielectric(Object &object, Draft &draft) {
    constexpr double bk7 = 1.5046;
    draft.set_type("glass");
    draft.values["two_sided"] = true;
    draft.values["eta"] = relative_index(object, bk7);
    read_colour(object, "specular_reflectance", "reflectance", 1, draft);
    read_colour(object, "specular_transmittance", "transmittance", 1, draft);
    if (is_rough(object)) {
        read_roughness(object, draft);
    }
}

void MaterialReader::read_conductor(Object &object, Draft &draft) {
    draft.set_type("metal");
    const std::string none = "none";
    const std::optional<Vector3d> eta = object.colour("eta");
    const std::optional<Vector3d> k = object.colour("k");
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
        const auto found =
            std::find_if(std::begin(metal_names), std::end(metal_names),
                         [&](const MetalName &row) { return *material == row.mitsuba; });
        if (found == std::end(metal_names)) {
            throw object.property("material")
                .error(fmt::format("unknown metal '{}'; give eta and k as <rgb>, or one of: Ag, "
                                   "Au, Cu, none",
                                   *material));
        }
        draft.values["preset"] = std::string(found->ours);
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
        const double alpha = std::get<Vector2d>(draft.values.at("roughness")).maxCoeff();
        if (alpha > roughest_plastic) {
            throw object.element().error(
                fmt::format("alpha: {} is too rough, the diffuse base would be more than 10 % "
                            "brighter than in Mitsuba; use at most {}, or type plastic or diffuse",
                            alpha, roughest_plastic));
        }
        notice(
            object.element()
                .error("only the coat's reflection is rough, the diffuse base is lit as through a "
                       "smooth coat; it is up to 10 % brighter than in Mitsuba")
                .what());
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
    const double alpha = object.number("alpha", 0.1);
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
    if (textures.empty()) {
        const Vector3d colour = object.colour(property).value_or(Vector3d::Constant(initial));
        // Checked here already, because the line is known here.
        if (colour.minCoeff() < 0 || colour.maxCoeff() > 1) {
            throw object.property(property).error(
                fmt::format("[{}, {}, {}] is not within [0, 1]", colour[0], colour[1], colour[2]));
        }
        draft.values[parameter] = colour;
        return;
    }
    if (textures.size() > 1 || object.has(property)) {
        throw object.element().error(fmt::format("duplicate property '{}'", property));
    }
    draft.values[parameter] = Vector3d(1, 1, 1);
    draft.textures[parameter] = texture(textures[0], draft);
}

std::shared_ptr<Texture> MaterialReader::texture(const Element &element, Draft &draft) {
    draft.depends_on_uv = true;
    if (draft.uv == UvConvention::none) {
        throw element.error(
            "this shape has no texture coordinates that match Mitsuba's; use one colour, or a mesh "
            "with texture coordinates");
    }
    std::shared_ptr<Texture> &texture = textures_[{element.hash(), draft.uv}];
    if (texture != nullptr) {
        return texture;
    }
    Object object(element, document_);
    if (object.type() != "bitmap") {
        throw element.error("unsupported texture type; supported types are: bitmap");
    }
    const std::optional<std::string> file = object.text("filename");
    if (!file.has_value()) {
        throw element.error("needs a filename");
    }
    const std::vector<std::string> filters = {"bilinear", "nearest"};
    const std::vector<std::string> wraps = {"repeat", "clamp"};
    ParameterValues values{{"filter", filters[object.choice("filter_type", filters, 0)]},
                           {"wrap", wraps[object.choice("wrap_mode", wraps, 0)]}};
    const bool raw = object.boolean("raw", false);
    object.ignore("format");  // of texels in Mitsuba's memory
    object.ignore("accel");

    const Eigen::Matrix4d to_uv = object.transform("to_uv");
    if (to_uv(0, 1) != 0 || to_uv(1, 0) != 0) {
        throw object.property("to_uv").error(
            "textures can only be scaled and translated; remove the rotation");
    }
    const Vector2d scale(to_uv(0, 0), to_uv(1, 1));
    // Mitsuba looks up row scale v + offset from the top. Let v' be our coordinate. If v = v', the
    // row from the bottom is 1 - scale v' - offset. If v = 1 - v', it is
    // scale v' + 1 - scale - offset.
    const bool flipped = draft.uv == UvConvention::flipped;
    values["uv_scale"] = Vector2d(scale[0], flipped ? scale[1] : -scale[1]);
    // The fourth column of the matrix translates.
    values["uv_offset"] =
        Vector2d(to_uv(0, 3), flipped ? 1 - scale[1] - to_uv(1, 3) : 1 - to_uv(1, 3));
    object.finish();

    const std::filesystem::path path = element.path(*file);
    std::string extension = path.extension().string();
    std::transform(extension.begin(), extension.end(), extension.begin(),
                   [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
    const bool holds_floats =
        extension == ".exr" || extension == ".hdr" || extension == ".rgbe" || extension == ".pfm";
    element.located([&] {
        const bool has_id = element.has("id");
        const std::string name =
            texture_names_.unique(has_id ? element.attribute("id") : path.stem().string());
        texture = std::make_shared<Texture>(
            name,
            files_.load(path,
                        raw || holds_floats ? TextureEncoding::linear : TextureEncoding::srgb),
            values);
        if (has_id) {
            scene_.graph().share("textures." + name, texture);
        }
    });
    return texture;
}

}  // namespace rtrays::mitsuba
