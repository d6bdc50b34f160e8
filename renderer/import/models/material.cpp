// SPDX-License-Identifier: MIT
#include "renderer/import/models/material.h"

#include <assimp/GltfMaterial.h>
#include <assimp/material.h>
#include <assimp/scene.h>
#include <fmt/format.h>
#include <stdlib.h>
#include <unistd.h>

#include <Eigen/LU>
#include <algorithm>
#include <charconv>
#include <cmath>
#include <optional>
#include <utility>

#include "renderer/base/error.h"

namespace rtrays {

using Eigen::Vector3d;

namespace {

struct UnusedMap {
    aiTextureType type;
    const char *note;
};
constexpr UnusedMap unused_maps[] = {
    {aiTextureType_HEIGHT, "bump maps are ignored outside MTL"},
    {aiTextureType_NORMAL_CAMERA, "normal maps in camera space are ignored"},
    {aiTextureType_DISPLACEMENT, "displacement maps are ignored"},
    {aiTextureType_SHININESS, "shininess maps are ignored"},
    {aiTextureType_AMBIENT, "ambient and occlusion maps are ignored"},
    {aiTextureType_LIGHTMAP, "ambient and occlusion maps are ignored"},
    {aiTextureType_AMBIENT_OCCLUSION, "ambient and occlusion maps are ignored"},
    {aiTextureType_REFLECTION, "reflection maps are ignored"},
    {aiTextureType_SHEEN, "sheen and clear coats are ignored"},
    {aiTextureType_CLEARCOAT, "sheen and clear coats are ignored"},
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

/// Returns the index of refraction whose reflectance at normal incidence is that of the dielectric
/// coat, scaled by KHR_materials_specular.
double coat_index(const GltfMaterial &material) {
    const double scale = material.specular * material.specular_colour.mean();
    if (scale == 1) {
        return material.ior;
    }
    const double amplitude = std::sqrt(scale) * std::abs(material.ior - 1) / (material.ior + 1);
    return (1 + amplitude) / (1 - amplitude);
}

/// Returns the transform of a map from the texture coordinates of meshes: those of the base colour,
/// turned if they are. Returns nothing if a texture cannot have it.
std::optional<GltfTextureTransform> from_mesh(const GltfMaterial &material,
                                              const GltfPlacement &map) {
    GltfTextureTransform placed = map.transform;
    if (material.base_transform.rotates()) {
        placed.linear = placed.linear * material.base_transform.linear.inverse();
        placed.offset -= placed.linear * material.base_transform.offset;
    }
    constexpr double rounding = 1e-9;
    const bool turns = !(std::abs(placed.linear(0, 1)) + std::abs(placed.linear(1, 0)) < rounding);
    if (turns || map.uv_set != material.base_uv_set) {
        return std::nullopt;
    }
    placed.linear = Eigen::Matrix2d(placed.linear.diagonal().asDiagonal());
    return placed;
}

/// Returns the value of a channel if it is the same at all texels, which must be linear.
std::optional<double> constant_of(const TextureImage &image, size_t channel) {
    const auto constant = [&](const auto &values, double one) -> std::optional<double> {
        for (size_t i = channel; i < values.size(); i += 3) {
            if (values[i] != values[channel]) {
                return std::nullopt;
            }
        }
        return static_cast<double>(values[channel]) / one;
    };
    return image.floats.empty() ? constant(image.bytes, 255) : constant(image.floats, 1);
}

/// Returns the properties of a material of a format other than glTF.
GltfMaterial without_extensions(const aiMaterial &source) {
    GltfMaterial made;
    made.ior = number(source, "$mat.refracti", made.ior);
    made.transmission = number(source, "$mat.transmission.factor", 0);
    return made;
}

}  // namespace

ModelMaterials::ModelMaterials(std::shared_ptr<const aiScene> model,
                               std::filesystem::path directory, std::vector<GltfMaterial> extended,
                               bool vertex_coloured, ModelNotes &notes)
    : model_(std::move(model)),
      directory_(std::move(directory)),
      extended_(std::move(extended)),
      vertex_coloured_(vertex_coloured),
      notes_(notes),
      textures_(notes) {}

const GltfMaterial *ModelMaterials::extended(unsigned index) const {
    // Assimp appends a default material, which has no name.
    const std::string stated = text(*model_->mMaterials[index], "?mat.name");
    size_t number = extended_.size();
    std::from_chars(stated.data(), stated.data() + stated.size(), number);
    return number < extended_.size() ? &extended_[number] : nullptr;
}

bool ModelMaterials::is_vertex_coloured(unsigned index) const {
    return vertex_coloured_ && std::any_of(model_->mMeshes, model_->mMeshes + model_->mNumMeshes,
                                           [&](const aiMesh *mesh) {
                                               return mesh->mMaterialIndex == index &&
                                                      mesh->HasVertexColors(0);
                                           });
}

std::string ModelMaterials::name(unsigned index) const {
    const GltfMaterial *const gltf = extended(index);
    return gltf != nullptr ? gltf->name : text(*model_->mMaterials[index], "?mat.name");
}

unsigned ModelMaterials::uv_channel(unsigned index) const {
    if (const GltfMaterial *const gltf = extended(index); gltf != nullptr) {
        return std::min(gltf->base_uv_set, AI_MAX_NUMBER_OF_TEXTURECOORDS - 1u);
    }
    const aiMaterial &source = *model_->mMaterials[index];
    int channel = 0;
    source.Get(_AI_MATKEY_UVWSRC_BASE, colour_map(source), 0, channel);
    return static_cast<unsigned>(std::max(channel, 0));
}

GltfTextureTransform ModelMaterials::uv_transform(unsigned index) const {
    const GltfMaterial *const gltf = extended(index);
    return gltf != nullptr && gltf->base_transform.rotates() ? gltf->base_transform
                                                             : GltfTextureTransform{};
}

std::shared_ptr<const TextureImage> ModelMaterials::load(const std::string &file,
                                                         TextureEncoding encoding) {
    const aiTexture *inside = model_->GetEmbeddedTexture(file.c_str());
    const bool is_alpha = encoding == TextureEncoding::alpha;
    if (inside == nullptr) {
        return is_alpha ? textures_.load_alpha(file, {directory_})
                        : textures_.load(file, {directory_}, encoding == TextureEncoding::srgb);
    }
    const auto [found, is_new] = embedded_.try_emplace({file, encoding});
    std::shared_ptr<const TextureImage> &image = found->second;
    if (!is_new) {
        return image;
    }
    if (inside->mHeight == 0) {  // an image file of `mWidth` bytes
        const std::string format = inside->achFormatHint;
        const TemporaryFile copy(inside->pcData, inside->mWidth,
                                 format.empty() ? "" : "." + format);
        try {
            if (!is_alpha) {
                image = load_texture_file(copy.path(), encoding);
            } else if (has_alpha_channel(copy.path())) {
                image = unless_opaque(load_texture_file(copy.path(), encoding));
            }
        } catch (const Error &error) {
            throw Error(error.exit_code(),
                        fmt::format("embedded image '{}': {}", file, error.what()));
        }
        return image;
    }
    auto texels = std::make_shared<TextureImage>();
    texels->width = static_cast<int>(inside->mWidth);
    texels->height = static_cast<int>(inside->mHeight);
    texels->srgb = encoding == TextureEncoding::srgb;
    for (size_t i = 0; i < static_cast<size_t>(inside->mWidth) * inside->mHeight; ++i) {
        const aiTexel &texel = inside->pcData[i];
        if (is_alpha) {
            texels->bytes.insert(texels->bytes.end(), 3, texel.a);
        } else {
            texels->bytes.insert(texels->bytes.end(), {texel.r, texel.g, texel.b});
        }
    }
    image = is_alpha ? unless_opaque(texels) : texels;
    return image;
}

std::shared_ptr<const TextureImage> ModelMaterials::channel_of(
    const std::shared_ptr<const TextureImage> &image, int channel) {
    std::shared_ptr<const TextureImage> &known = channels_[{image.get(), channel}];
    if (known == nullptr) {
        auto grey = std::make_shared<TextureImage>(*image);
        const auto copy = [channel](auto &values) {
            for (size_t i = 0; i + 2 < values.size(); i += 3) {
                const auto value = values[i + static_cast<size_t>(channel)];
                values[i] = values[i + 1] = values[i + 2] = value;
            }
        };
        copy(grey->bytes);
        copy(grey->floats);
        known = grey;
    }
    return known;
}

Vector3d ModelMaterials::mean_of_map(const aiMaterial &source, int type, bool is_colour,
                                     unsigned index) {
    aiString file;
    if (source.GetTexture(static_cast<aiTextureType>(type), index, &file) != aiReturn_SUCCESS) {
        return Vector3d::Ones();
    }
    return mean_of(
        *load(file.C_Str(), is_colour ? TextureEncoding::srgb : TextureEncoding::linear));
}

std::shared_ptr<Texture> ModelMaterials::texture(const aiMaterial &source, int type_number,
                                                 const GltfTextureTransform *transform,
                                                 const std::string &name, const MapUse &use) {
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
    if (modes[0] == aiTextureMapMode_Decal || modes[1] == aiTextureMapMode_Decal) {
        notes_.add("decal textures are repeated", name);
    }
    if (modes[0] != modes[1]) {
        notes_.add("textures with different wrap modes along u and v use the mode along u", name);
    }
    TexturePlacement placement;
    placement.vertex_colours = use.vertex_colours;
    placement.wrap = modes[0] == aiTextureMapMode_Clamp    ? TextureArrays::Wrap::clamp
                     : modes[0] == aiTextureMapMode_Mirror ? TextureArrays::Wrap::mirror
                                                           : TextureArrays::Wrap::repeat;
    int filter = 0;
    constexpr int nearest = 9728;  // NEAREST of OpenGL, as in glTF
    placement.is_nearest = source.Get(_AI_MATKEY_GLTF_MAPPINGFILTER_MAG_BASE, type_number, 0,
                                      filter) == aiReturn_SUCCESS &&
                           filter == nearest;
    if (transform == nullptr) {
        aiUVTransform stated;
        source.Get(_AI_MATKEY_UVTRANSFORM_BASE, type_number, 0, stated);
        placement.scale = {stated.mScaling.x, stated.mScaling.y};
        placement.offset = {stated.mTranslation.x, stated.mTranslation.y};
        if (stated.mRotation != 0) {
            notes_.add("texture rotations are ignored", name);
        }
    } else if (!transform->rotates()) {
        placement.scale = transform->linear.diagonal();
        placement.offset = transform->offset;
    }
    std::shared_ptr<const TextureImage> image = load(file.C_Str(), use.encoding);
    std::string suffix = use.encoding == TextureEncoding::alpha ? "_alpha" : "";
    if (use.channel >= 0) {
        constexpr const char *suffixes[] = {"_red", "_green", "_blue"};
        image = channel_of(image, use.channel);
        suffix = suffixes[use.channel];
    }
    return image != nullptr ? textures_.texture(image, file.C_Str() + suffix, placement) : nullptr;
}

void ModelMaterials::read_physical(const aiMaterial &source, const GltfMaterial *gltf,
                                   const std::string &name, ModelSurface &surface) {
    const GltfMaterial extended = gltf != nullptr ? *gltf : without_extensions(source);
    surface.is_physical = true;
    surface.diffuse = colour(source, "$clr.base", surface.diffuse);
    surface.metalness = number(source, metalness_key, 0);
    double roughness = number(source, roughness_key, 1);
    const MapUse linear{TextureEncoding::linear};
    if (has_map(source, aiTextureType_METALNESS)) {
        // glTF stores roughness in the green channel and metalness in the blue one.
        const std::optional<GltfTextureTransform> placed =
            gltf != nullptr ? from_mesh(*gltf, gltf->roughness) : std::nullopt;
        if (placed.has_value()) {
            const auto map = [&](int channel) {
                MapUse use = linear;
                use.channel = channel;
                return texture(source, aiTextureType_METALNESS, &*placed, name, use);
            };
            surface.roughness_texture = map(1);
            surface.metalness_texture = surface.metalness > 0 ? map(2) : nullptr;
            if (surface.metalness_texture != nullptr) {
                const auto constant = constant_of(*surface.metalness_texture->image(), 0);
                if (constant.has_value()) {
                    surface.metalness *= *constant;
                    surface.metalness_texture = nullptr;
                }
            }
        } else {
            const Vector3d mean = mean_of_map(source, aiTextureType_METALNESS, false);
            notes_.add(
                "metalness and roughness maps are replaced by their mean if their texture "
                "coordinates are not those of the base colour",
                name);
            surface.metalness *= mean.z();
            roughness *= mean.y();
        }
    }
    surface.alpha = roughness * roughness;
    const bool is_scaled = extended.specular != 1 || !extended.specular_colour.isOnes();
    surface.eta = extended.transmission > 0 ? extended.ior : coat_index(extended);
    if (is_scaled) {
        notes_.add(extended.transmission > 0
                       ? "KHR_materials_specular is ignored where light is transmitted"
                       : "KHR_materials_specular is honoured at normal incidence only, as grey",
                   name);
    }
    read_layers(source, extended, name, surface);
    if (extended.transmission > 0) {
        read_transmission(source, extended, gltf != nullptr, name, surface);
    }
}

void ModelMaterials::read_transmission(const aiMaterial &source, const GltfMaterial &material,
                                       bool is_gltf, const std::string &name,
                                       ModelSurface &surface) {
    surface.transmission = material.transmission;
    if (has_map(source, aiTextureType_TRANSMISSION)) {
        const std::optional<GltfTextureTransform> placed =
            is_gltf ? from_mesh(material, material.transmission_map) : std::nullopt;
        if (placed.has_value() && surface.metalness_texture == nullptr) {
            MapUse use{TextureEncoding::linear};
            use.channel = 0;
            surface.transmission_texture =
                texture(source, aiTextureType_TRANSMISSION, &*placed, name, use);
        } else {
            notes_.add(
                "transmission maps are replaced by their mean beside a metalness map, or if their "
                "texture coordinates are not those of the base colour",
                name);
            surface.transmission *= mean_of_map(source, aiTextureType_TRANSMISSION, false).x();
        }
    }
    surface.is_thin = is_gltf && !(material.thickness > 0);
    // A path through a body crosses its surface twice.
    const double share = 0.5 * material.thickness / material.attenuation_distance;
    if (surface.is_thin) {
        notes_.add(surface.alpha > 0
                       ? "transmission without thickness is that of thin walls, which are passed "
                         "without scattering; set thicknessFactor for a solid"
                       : "transmission without thickness is that of thin walls; set "
                         "thicknessFactor for a solid",
                   name);
    } else if (share > 0 && !material.attenuation_colour.isOnes()) {
        notes_.add(
            "absorption in volumes is replaced by a colour at each crossing, for the stated "
            "thickness",
            name);
        surface.transmittance = material.attenuation_colour.array().pow(share).matrix();
    }
    const bool has_layers = surface.clearcoat > 0 || surface.sheen.maxCoeff() > 0;
    const bool is_rough_plate = surface.is_thin && surface.alpha > 0;
    surface.refracts = surface.transmission >= 1 && surface.metalness <= 0 && !has_layers &&
                       !is_rough_plate && surface.transmission_texture == nullptr;
}

void ModelMaterials::read_layers(const aiMaterial &source, const GltfMaterial &material,
                                 const std::string &name, ModelSurface &surface) {
    if (material.clearcoat > 0) {
        notes_.add(
            "clear coats are smooth or rough dielectrics of index 1.5 on a share of the surface; "
            "the coat of the base below them reflects nothing",
            name);
        // Assimp gives the maps of strength and roughness the indices 0 and 1.
        surface.clearcoat =
            material.clearcoat * mean_of_map(source, aiTextureType_CLEARCOAT, false).x();
        const double roughness = material.clearcoat_roughness *
                                 mean_of_map(source, aiTextureType_CLEARCOAT, false, 1).y();
        surface.clearcoat_alpha = roughness * roughness;
        if (has_map(source, aiTextureType_CLEARCOAT)) {
            notes_.add("maps of clear coats are replaced by their mean, normals by none", name);
        }
    }
    if (material.sheen_colour.maxCoeff() > 0) {
        notes_.add("KHR_materials_sheen is Burley's sheen, whatever its roughness", name);
        surface.sheen = material.sheen_colour.cwiseMax(0.0).cwiseMin(1.0);
        const std::optional<GltfTextureTransform> placed = from_mesh(material, material.sheen_map);
        if (!has_map(source, aiTextureType_SHEEN)) {
            return;
        }
        if (placed.has_value()) {
            surface.sheen_texture = texture(source, aiTextureType_SHEEN, &*placed, name);
        } else {
            notes_.add(
                "sheen maps are replaced by their mean if their texture coordinates are not those "
                "of the base colour",
                name);
            surface.sheen =
                surface.sheen.cwiseProduct(mean_of_map(source, aiTextureType_SHEEN, true));
        }
    }
}

void ModelMaterials::read_opacity(const aiMaterial &source, const GltfMaterial *gltf,
                                  const std::string &name, ModelSurface &surface) {
    surface.opacity = number(source, "$mat.opacity", 1);
    const std::string alpha_mode = text(source, "$mat.gltf.alphaMode");
    if (alpha_mode == "OPAQUE") {
        surface.opacity = 1;
        return;
    }
    if (alpha_mode.empty()) {  // another format
        if (has_map(source, aiTextureType_OPACITY)) {
            const int type = aiTextureType_OPACITY;
            surface.opacity_texture = texture(source, type, nullptr, name, TextureEncoding::alpha);
            if (surface.opacity_texture == nullptr) {
                surface.opacity_texture =
                    texture(source, type, nullptr, name, TextureEncoding::linear);
            }
        }
        return;
    }
    surface.opacity_texture =
        texture(source, colour_map(source), gltf != nullptr ? &gltf->base_transform : nullptr, name,
                TextureEncoding::alpha);
    if (alpha_mode == "MASK") {
        surface.opacity_cutoff = number(source, "$mat.gltf.alphaCutoff", 0.5);
        if (!(surface.opacity_cutoff > 0 && surface.opacity_cutoff <= 1)) {
            // Every alpha reaches the cutoff, or none does.
            surface.opacity = surface.opacity_cutoff > 1 ? 0 : 1;
            surface.opacity_cutoff = 0;
            surface.opacity_texture = nullptr;
        }
    }
}

void ModelMaterials::read_normals(const aiMaterial &source, const GltfMaterial *gltf,
                                  const std::string &name, ModelSurface &surface) {
    if (!has_map(source, aiTextureType_NORMALS)) {
        return;
    }
    if (gltf != nullptr && !gltf->normals_use_base_uv) {
        notes_.add(
            "normal maps are ignored if their texture coordinates are rotated or differ from those "
            "of the base colour",
            name);
        return;
    }
    surface.normal_texture =
        texture(source, aiTextureType_NORMALS, gltf != nullptr ? &gltf->normal_transform : nullptr,
                name, TextureEncoding::linear);
    surface.map_scale = gltf != nullptr ? gltf->normal_scale : 1;
}

void ModelMaterials::read_emission_map(const aiMaterial &source, const GltfMaterial *gltf,
                                       const std::string &name, ModelSurface &surface) {
    const int type = has_map(source, aiTextureType_EMISSIVE) ? aiTextureType_EMISSIVE
                                                             : aiTextureType_EMISSION_COLOR;
    if (!has_map(source, static_cast<aiTextureType>(type)) || surface.emission.isZero()) {
        return;
    }
    if (gltf == nullptr) {
        surface.emission_texture = texture(source, type, nullptr, name);
        return;
    }
    const std::optional<GltfTextureTransform> placed = from_mesh(*gltf, gltf->emission);
    if (!placed.has_value()) {
        notes_.add(
            "emission maps with other texture coordinates than the base colour are replaced by "
            "their mean",
            name);
        surface.emission = surface.emission.cwiseProduct(mean_of_map(source, type, true));
        return;
    }
    surface.emission_texture = texture(source, type, &*placed, name);
}

ModelSurface ModelMaterials::read(unsigned index, const std::string &name) {
    const aiMaterial &source = *model_->mMaterials[index];
    const GltfMaterial *const gltf = extended(index);
    ModelSurface surface;
    surface.diffuse = colour(source, "$clr.diffuse", surface.diffuse);
    surface.specular =
        colour(source, "$clr.specular", Vector3d::Zero()) * number(source, "$mat.shinpercent", 1);
    surface.exponent = number(source, "$mat.shininess", 0);
    surface.eta = number(source, "$mat.refracti", 1);
    if (has_number(source, metalness_key) && has_number(source, roughness_key)) {
        read_physical(source, gltf, name, surface);
    }
    read_opacity(source, gltf, name, surface);
    read_normals(source, gltf, name, surface);
    const bool coloured = is_vertex_coloured(index);
    surface.diffuse_texture =
        texture(source, colour_map(source), gltf != nullptr ? &gltf->base_transform : nullptr, name,
                MapUse{TextureEncoding::srgb, coloured});
    if (coloured && surface.diffuse_texture == nullptr) {
        surface.diffuse_texture = textures_.vertex_colours();
    }
    surface.specular_texture =
        surface.is_physical ? nullptr : texture(source, aiTextureType_SPECULAR, nullptr, name);

    // glTF: factor * texture * strength.
    surface.emission =
        colour(source, "$clr.emissive", Vector3d::Zero()) *
        (gltf != nullptr ? gltf->emissive_strength : number(source, "$mat.emissiveIntensity", 1));
    read_emission_map(source, gltf, name, surface);
    if (gltf != nullptr && gltf->is_two_sided && !surface.emission.isZero()) {
        notes_.add("emission of two-sided materials leaves the front only", name);
    }
    for (const UnusedMap &map : unused_maps) {
        const bool is_read = gltf != nullptr && (map.type == aiTextureType_SHEEN ||
                                                 map.type == aiTextureType_CLEARCOAT);
        if (has_map(source, map.type) && !is_read) {
            notes_.add(map.note, name);
        }
    }
    return surface;
}

std::shared_ptr<MaterialCore> ModelMaterials::material(unsigned index, const std::string &name) {
    try {
        return make_model_material(read(index, name), name, notes_);
    } catch (const Error &error) {
        throw Error(error.exit_code(), fmt::format("material '{}': {}", name, error.what()));
    }
}

}  // namespace rtrays
