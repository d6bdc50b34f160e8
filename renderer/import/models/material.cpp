// SPDX-License-Identifier: MIT
#include "renderer/import/models/material.h"

#include <assimp/GltfMaterial.h>
#include <assimp/ObjMaterial.h>
#include <assimp/material.h>
#include <assimp/scene.h>
#include <fmt/format.h>
#include <stdlib.h>
#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

#include "renderer/base/error.h"
#include "renderer/base/files.h"
#include "renderer/scene/cores/composite.h"
#include "renderer/scene/cores/texture.h"

namespace rtrays {

using Eigen::Vector2d;
using Eigen::Vector3d;

/// The parameters of a material, independent of the file format.
struct ModelSurface {
    Vector3d diffuse;
    Vector3d specular;
    Vector3d emission;
    Vector3d transmittance;
    std::shared_ptr<Texture> diffuse_texture;
    std::shared_ptr<Texture> specular_texture;
    double exponent = 0;
    double opacity = 1;
    double eta = 1;
    double metalness = 0;
    double alpha = 0;
    bool is_physical = false;  ///< described by metalness and roughness
    bool refracts = false;
    bool only_reflects = false;

    bool has_highlight() const { return specular.maxCoeff() > 0 && exponent > 0; }
    bool is_plain() const { return !is_physical && !refracts && !only_reflects; }
};

namespace {

/// A surface of lower alpha is ideally smooth. Its highlight would be narrower than a pixel.
constexpr double smooth_alpha = 0.01;
constexpr double glass_eta = 1.5;
constexpr double grey = 0.6;  // Assimp's default

struct UnusedMap {
    aiTextureType type;
    const char *note;
};
constexpr UnusedMap unused_maps[] = {
    {aiTextureType_HEIGHT, "bump and normal maps are ignored"},
    {aiTextureType_NORMALS, "bump and normal maps are ignored"},
    {aiTextureType_NORMAL_CAMERA, "bump and normal maps are ignored"},
    {aiTextureType_DISPLACEMENT, "displacement maps are ignored"},
    {aiTextureType_OPACITY, "opacity masks are ignored; masked parts are visible"},
    {aiTextureType_SHININESS, "shininess maps are ignored"},
    {aiTextureType_AMBIENT, "ambient and occlusion maps are ignored"},
    {aiTextureType_LIGHTMAP, "ambient and occlusion maps are ignored"},
    {aiTextureType_AMBIENT_OCCLUSION, "ambient and occlusion maps are ignored"},
    {aiTextureType_REFLECTION, "reflection maps are ignored"},
    {aiTextureType_SHEEN, "sheen and clear coats are ignored"},
    {aiTextureType_CLEARCOAT, "sheen and clear coats are ignored"},
    {aiTextureType_TRANSMISSION, "transmission maps are ignored"},
};

Vector3d colour(const aiMaterial &source, const char *key, const Vector3d &otherwise) {
    aiColor3D value;
    return source.Get(key, 0, 0, value) == aiReturn_SUCCESS ? Vector3d(value.r, value.g, value.b)
                                                            : otherwise;
}

/// Returns whether a material has a number. Assimp identifies it by (key, type, index), where type
/// and index are zero unless it belongs to a texture.
bool has_number(const aiMaterial &source, const char *key) {
    ai_real value = 0;
    return source.Get(key, 0, 0, value) == aiReturn_SUCCESS;
}

double number(const aiMaterial &source, const char *key, double otherwise) {
    ai_real value = 0;
    return source.Get(key, 0, 0, value) == aiReturn_SUCCESS ? static_cast<double>(value)
                                                            : otherwise;
}

constexpr const char *const metalness_key = "$mat.metallicFactor";
constexpr const char *const roughness_key = "$mat.roughnessFactor";

std::string text(const aiMaterial &source, const char *key) {
    aiString value;
    return source.Get(key, 0, 0, value) == aiReturn_SUCCESS ? value.C_Str() : "";
}

bool has_map(const aiMaterial &source, aiTextureType type) {
    return source.GetTextureCount(type) > 0;
}

aiTextureType colour_map(const aiMaterial &source) {
    return has_map(source, aiTextureType_BASE_COLOR) ? aiTextureType_BASE_COLOR
                                                     : aiTextureType_DIFFUSE;
}

/// A file that the destructor removes, for readers that accept only files.
class TemporaryFile {
  public:
    TemporaryFile(const void *bytes, size_t count, const std::string &extension) {
        path_ = (std::filesystem::temp_directory_path() / "rtrays-XXXXXX").string() + extension;
        const int file = mkstemps(path_.data(), static_cast<int>(extension.size()));
        const char *at = static_cast<const char *>(bytes);
        while (file >= 0 && count > 0) {
            const ssize_t written = write(file, at, count);
            if (written <= 0) {
                break;
            }
            at += written;
            count -= static_cast<size_t>(written);
        }
        if (file >= 0) {
            close(file);
        }
        if (count > 0) {
            throw run_error(fmt::format("{}: cannot write the file", path_));
        }
    }
    ~TemporaryFile() { unlink(path_.c_str()); }
    TemporaryFile(const TemporaryFile &) = delete;
    TemporaryFile &operator=(const TemporaryFile &) = delete;

    const std::string &path() const { return path_; }

  private:
    std::string path_;
};

/// Returns the path of an image as given in the model file. Accepts backslashes as separators.
std::filesystem::path image_path(std::string file) {
    std::replace(file.begin(), file.end(), '\\', '/');
    return file;
}

/// Returns the location of an image. If the path in the model file does not exist here, an image of
/// that name beside the model is used.
std::filesystem::path find_image(const std::filesystem::path &directory,
                                 const std::filesystem::path &file) {
    const std::filesystem::path stated = directory / file;
    std::error_code ignored;
    if (!std::filesystem::is_regular_file(stated, ignored)) {
        const std::filesystem::path beside = directory / file.filename();
        if (std::filesystem::is_regular_file(beside, ignored)) {
            return beside;
        }
    }
    return stated;
}

bool holds_floats(const std::string &file) {
    const std::string extension = std::filesystem::path(file).extension().string();
    return extension == ".hdr" || extension == ".exr" || extension == ".pfm";
}

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
            textures_[prefix + "weight"] = texture;
        }
        return prefix;
    }

    /// Adds an ideal or a microfacet reflection, depending on `alpha`.
    std::string add_reflection(double alpha, const char *fresnel, const Vector3d &weight,
                               const std::shared_ptr<Texture> &texture = nullptr) {
        if (alpha < smooth_alpha) {
            return add("ideal_reflection", fresnel, weight, texture);
        }
        const std::string prefix = add("microfacet_reflection", fresnel, weight, texture);
        values[prefix + "alpha"] = Vector2d(alpha, alpha);
        return prefix;
    }

    std::shared_ptr<MaterialCore> build(const std::string &name) const {
        return std::make_shared<MaterialCore>(name, composite_type(parts_), values, textures_);
    }

    ParameterValues values;

  private:
    std::vector<CompositePart> parts_;
    ParameterTextures textures_;
};

ParameterTextures textured(const char *parameter, const std::shared_ptr<Texture> &texture) {
    return texture != nullptr ? ParameterTextures{{parameter, texture}} : ParameterTextures{};
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
    return std::make_shared<MaterialCore>(
        name, "glass",
        ParameterValues{{"emission", s.emission},
                        {"eta", s.eta > 0 ? s.eta : glass_eta},
                        {"transmittance", s.is_physical ? s.diffuse : s.transmittance},
                        {"roughness", Vector2d(alpha, alpha)}},
        textured("transmittance", s.is_physical ? s.diffuse_texture : nullptr));
}

std::shared_ptr<MaterialCore> make_plain(const ModelSurface &s, const std::string &name) {
    ParameterValues values = {{"emission", s.emission}, {"reflectance", s.diffuse}};
    ParameterTextures textures = textured("reflectance", s.diffuse_texture);
    if (!s.has_highlight()) {
        return std::make_shared<MaterialCore>(name, "lambert", values, textures);
    }
    values["specular"] = s.specular;
    values["exponent"] = s.exponent;
    textures.merge(textured("specular", s.specular_texture));
    return std::make_shared<MaterialCore>(name, "lambert_blinn", values, textures);
}

/// Adds a mixture by metalness of a metal and a coated base.
void add_physical(const ModelSurface &s, double share, CompositeBuilder &composite) {
    const double metal = std::min(std::max(s.metalness, 0.0), 1.0);
    if (metal > 0) {
        const std::string part = composite.add_reflection(
            s.alpha, "schlick", Vector3d::Constant(share * metal), s.diffuse_texture);
        composite.values[part + "fresnel_reflectance"] = s.diffuse;
    }
    if (metal < 1) {
        share *= 1 - metal;
        const std::string coat =
            composite.add_reflection(s.alpha, "dielectric", Vector3d::Constant(share));
        composite.values[coat + "fresnel_eta"] = s.eta;
        const std::string base =
            composite.add("lambert", "dielectric", share * s.diffuse, s.diffuse_texture);
        composite.values[base + "fresnel_eta"] = s.eta;
        composite.values[base + "fresnel_complement"] = true;
    }
}

std::shared_ptr<MaterialCore> make_composite(const ModelSurface &s, const std::string &name) {
    CompositeBuilder composite;
    composite.values["emission"] = s.emission;
    const double share = std::min(std::max(s.opacity, 0.0), 1.0);
    if (s.is_physical) {
        add_physical(s, share, composite);
    } else if (s.only_reflects) {
        // An exponent of zero means a mirror. The material requests reflections, not a highlight.
        const std::string part = composite.add_reflection(
            s.exponent > 0 ? s.alpha : 0, "schlick", Vector3d::Constant(share), s.specular_texture);
        composite.values[part + "fresnel_reflectance"] = s.specular;
    } else {
        composite.add("lambert", "ideal", share * s.diffuse, s.diffuse_texture);
        if (s.has_highlight()) {
            const std::string part =
                composite.add("blinn", "ideal", share * s.specular, s.specular_texture);
            composite.values[part + "exponent"] = s.exponent;
        }
    }
    if (share < 1) {
        const std::string part =
            composite.add("ideal_refraction", "ideal", Vector3d::Constant(1 - share));
        composite.values[part + "eta"] = 1.0;
    }
    return composite.build(name);
}

}  // namespace

ModelMaterials::ModelMaterials(std::shared_ptr<const aiScene> model,
                               std::filesystem::path directory, ModelNotes &notes)
    : model_(std::move(model)), directory_(std::move(directory)), notes_(notes) {}

std::shared_ptr<const TextureImage> ModelMaterials::load(const std::string &file, bool is_colour) {
    const aiTexture *inside = model_->GetEmbeddedTexture(file.c_str());
    const TextureEncoding encoding =
        is_colour && !holds_floats(file) ? TextureEncoding::srgb : TextureEncoding::linear;
    if (inside == nullptr) {
        return files_.load(find_image(directory_, image_path(file)), encoding);
    }
    std::shared_ptr<const TextureImage> &image = embedded_[file + (is_colour ? " srgb" : "")];
    if (image != nullptr) {
        return image;
    }
    if (inside->mHeight == 0) {  // an image file of `mWidth` bytes
        const std::string format = inside->achFormatHint;
        const TemporaryFile copy(inside->pcData, inside->mWidth,
                                 format.empty() ? "" : "." + format);
        try {
            image = load_texture_file(copy.path(), encoding);
        } catch (const Error &error) {
            throw Error(error.exit_code(),
                        fmt::format("embedded image '{}': {}", file, error.what()));
        }
        return image;
    }
    auto texels = std::make_shared<TextureImage>();
    texels->width = static_cast<int>(inside->mWidth);
    texels->height = static_cast<int>(inside->mHeight);
    texels->srgb = is_colour;
    for (size_t i = 0; i < static_cast<size_t>(inside->mWidth) * inside->mHeight; ++i) {
        const aiTexel &texel = inside->pcData[i];
        texels->bytes.insert(texels->bytes.end(), {texel.r, texel.g, texel.b});
    }
    image = texels;
    return image;
}

Vector3d ModelMaterials::mean_of(const aiMaterial &source, int type, bool is_colour) {
    aiString file;
    source.GetTexture(static_cast<aiTextureType>(type), 0, &file);
    const std::shared_ptr<const TextureImage> image = load(file.C_Str(), is_colour);
    Vector3d sum = Vector3d::Zero();
    const auto texels = static_cast<Eigen::Index>(image->width) * image->height;
    for (Eigen::Index i = 0; i < 3 * texels; ++i) {
        const auto at = static_cast<size_t>(i);
        const double value = image->floats.empty() ? image->bytes[at] / 255.0 : image->floats[at];
        sum[i % 3] += image->srgb ? srgb_decoded(value) : value;
    }
    return sum / static_cast<double>(texels);
}

std::shared_ptr<Texture> ModelMaterials::texture(const aiMaterial &source, int type_number,
                                                 const std::string &name) {
    const auto type = static_cast<aiTextureType>(type_number);
    aiString file;
    aiTextureMapping mapping = aiTextureMapping_UV;
    aiTextureMapMode modes[3] = {aiTextureMapMode_Wrap, aiTextureMapMode_Wrap,
                                 aiTextureMapMode_Wrap};
    if (source.GetTexture(type, 0, &file, &mapping, nullptr, nullptr, nullptr, modes) !=
        aiReturn_SUCCESS) {
        return nullptr;
    }
    if (mapping != aiTextureMapping_UV) {
        notes_.add("projected textures are ignored", name);
        return nullptr;
    }
    if (source.GetTextureCount(type) > 1) {
        notes_.add("only the first of several texture layers is used", name);
    }
    aiUVTransform placement;
    source.Get(_AI_MATKEY_UVTRANSFORM_BASE, type_number, 0, placement);
    if (placement.mRotation != 0) {
        notes_.add("texture rotations are ignored", name);
    }
    for (int axis = 0; axis < 2; ++axis) {
        if (modes[axis] != aiTextureMapMode_Wrap && modes[axis] != aiTextureMapMode_Clamp) {
            notes_.add("mirrored and decal textures are repeated", name);
        }
    }
    const bool clamps = modes[0] == aiTextureMapMode_Clamp;
    if (clamps != (modes[1] == aiTextureMapMode_Clamp)) {
        notes_.add("textures with different wrap modes along u and v use the mode along u", name);
    }
    const Vector2d scale(placement.mScaling.x, placement.mScaling.y);
    const Vector2d offset(placement.mTranslation.x, placement.mTranslation.y);
    const std::string key = fmt::format("{} {} {} {} {} {}", file.C_Str(), clamps, scale[0],
                                        scale[1], offset[0], offset[1]);
    std::shared_ptr<Texture> &made = textures_[key];
    if (made == nullptr) {
        made = std::make_shared<Texture>(
            names_.unique(image_path(file.C_Str()).stem().string(), "texture"),
            load(file.C_Str(), true),
            ParameterValues{{"wrap", std::string(clamps ? "clamp" : "repeat")},
                            {"uv_scale", scale},
                            {"uv_offset", offset}});
    }
    return made;
}

ModelSurface ModelMaterials::read(const aiMaterial &source, const std::string &name) {
    ModelSurface surface;
    surface.is_physical = has_number(source, metalness_key) && has_number(source, roughness_key);
    const Vector3d diffuse = colour(source, "$clr.diffuse", Vector3d::Constant(grey));
    surface.diffuse = surface.is_physical ? colour(source, "$clr.base", diffuse) : diffuse;
    surface.specular =
        colour(source, "$clr.specular", Vector3d::Zero()) * number(source, "$mat.shinpercent", 1);
    surface.transmittance = colour(source, "$clr.transparent", Vector3d::Ones());
    surface.exponent = number(source, "$mat.shininess", 0);
    surface.opacity = number(source, "$mat.opacity", 1);
    surface.eta = number(source, "$mat.refracti", surface.is_physical ? glass_eta : 1);
    surface.metalness = number(source, metalness_key, 0);
    double roughness = number(source, roughness_key, 1);

    int illumination = 0;
    source.Get("$mat.illum", 0, 0, illumination);
    const auto is_one_of = [&](std::initializer_list<int> models) {
        return std::find(models.begin(), models.end(), illumination) != models.end();
    };
    surface.refracts =
        is_one_of({4, 6, 7, 9}) || number(source, "$mat.transmission.factor", 0) > 0.5;
    surface.only_reflects = is_one_of({3, 5}) && surface.diffuse.isZero();

    const std::string alpha_mode = text(source, "$mat.gltf.alphaMode");
    if (alpha_mode == "MASK") {
        notes_.add("opacity masks are ignored; masked parts are visible", name);
    }
    if (alpha_mode == "MASK" || alpha_mode == "OPAQUE") {
        surface.opacity = 1;
    }
    surface.diffuse_texture = texture(source, colour_map(source), name);
    surface.specular_texture =
        surface.is_physical ? nullptr : texture(source, aiTextureType_SPECULAR, name);

    surface.emission = colour(source, "$clr.emissive", Vector3d::Zero()) *
                       number(source, "$mat.emissiveIntensity", 1);
    for (const aiTextureType type : {aiTextureType_EMISSIVE, aiTextureType_EMISSION_COLOR}) {
        if (has_map(source, type) && !surface.emission.isZero()) {
            notes_.add("emission maps are replaced by their mean", name);
            surface.emission = surface.emission.cwiseProduct(mean_of(source, type, true));
            break;
        }
    }
    if (surface.is_physical && has_map(source, aiTextureType_METALNESS)) {
        notes_.add("metalness and roughness maps are replaced by their mean", name);
        // glTF stores roughness in the green channel and metalness in the blue one.
        const Vector3d mean = mean_of(source, aiTextureType_METALNESS, false);
        roughness *= mean.y();
        surface.metalness *= mean.z();
    }
    surface.alpha = surface.is_physical ? roughness * roughness
                                        : std::sqrt(2 / (std::max(surface.exponent, 0.0) + 2));
    for (const UnusedMap &map : unused_maps) {
        if (has_map(source, map.type)) {
            notes_.add(map.note, name);
        }
    }
    return surface;
}

std::shared_ptr<MaterialCore> ModelMaterials::material(const aiMaterial &source,
                                                       const std::string &name) {
    try {
        ModelSurface surface = read(source, name);
        if (surface.is_plain() && surface.specular.maxCoeff() > 0 && !surface.has_highlight()) {
            notes_.add("specular colours without an exponent are ignored", name);
        }
        if (!surface.refracts && conserve_energy(surface)) {
            notes_.add("colours that would reflect more light than they receive are scaled down",
                       name);
        }
        if (surface.refracts) {
            return make_glass(surface, name);
        }
        return surface.is_plain() && surface.opacity >= 1 ? make_plain(surface, name)
                                                          : make_composite(surface, name);
    } catch (const Error &error) {
        throw Error(error.exit_code(), fmt::format("material '{}': {}", name, error.what()));
    }
}

unsigned uv_channel(const aiMaterial &source) {
    int channel = 0;
    source.Get(_AI_MATKEY_UVWSRC_BASE, colour_map(source), 0, channel);
    return static_cast<unsigned>(std::max(channel, 0));
}

std::string material_name(const aiMaterial &source) {
    return text(source, "?mat.name");
}

}  // namespace rtrays
