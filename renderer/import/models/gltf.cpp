// SPDX-License-Identifier: MIT
#include "renderer/import/models/gltf.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <cstring>
#include <nlohmann/json.hpp>

#include "renderer/base/error.h"
#include "renderer/base/files.h"
#include "renderer/import/models/statements.h"

namespace rtrays {

namespace {

using Eigen::Vector2d;
using Eigen::Vector3d;

/// Extensions that are honoured, by Assimp or by this file. Notes report approximations.
constexpr const char *supported_extensions[] = {
    "FB_ngon_encoding",        "KHR_draco_mesh_compression",      "KHR_lights_punctual",
    "KHR_materials_clearcoat", "KHR_materials_emissive_strength", "KHR_materials_ior",
    "KHR_materials_sheen",     "KHR_materials_specular",          "KHR_materials_transmission",
    "KHR_materials_volume",    "KHR_texture_transform",
};

/// Textures of extensions that are honoured, or replaced by their mean with a note.
constexpr const char *read_textures[] = {"transmissionTexture", "clearcoatTexture",
                                         "clearcoatRoughnessTexture", "sheenColorTexture"};

constexpr const char *punctual = "KHR_lights_punctual";

bool is_supported(const std::string &extension) {
    return std::find(std::begin(supported_extensions), std::end(supported_extensions), extension) !=
           std::end(supported_extensions);
}

std::string ignored_note(const std::string &extension) {
    return fmt::format("the extension {} is ignored", shown(extension));
}

/// Returns a member of an object, or null if the object lacks it.
const Json &member(const Json &object, const char *key) {
    static const Json null;
    if (!object.is_object()) {
        return null;
    }
    const auto found = object.find(key);
    return found != object.end() ? *found : null;
}

double number(const Json &object, const char *key, double otherwise) {
    const Json &value = member(object, key);
    return value.is_null() ? otherwise : value.get<double>();
}

Vector3d colour(const Json &object, const char *key) {
    const Json &value = member(object, key);
    return value.is_null() ? Vector3d(1, 1, 1)
                           : Vector3d(value.at(0).get<double>(), value.at(1).get<double>(),
                                      value.at(2).get<double>());
}

Vector2d pair(const Json &object, const char *key, const Vector2d &otherwise) {
    const Json &value = member(object, key);
    return value.is_null() ? otherwise
                           : Vector2d(value.at(0).get<double>(), value.at(1).get<double>());
}

/// Returns translation * rotation * scale of the extension, for a v that points up. glTF's v points
/// down, and its angle is counter-clockwise seen in an image.
GltfTextureTransform transform_of(const Json &extension) {
    const Vector2d offset = pair(extension, "offset", {0, 0});
    const Vector2d scale = pair(extension, "scale", {1, 1});
    const double angle = number(extension, "rotation", 0);
    const double c = std::cos(angle);
    const double s = std::sin(angle);
    // u' = c * su * u + s * sv * w + offset, w' = -s * su * u + c * sv * w + offset, w = 1 - v.
    GltfTextureTransform made;
    made.linear << c * scale[0], -s * scale[1], s * scale[0], c * scale[1];
    made.offset = {offset[0] + s * scale[1], 1 - offset[1] - c * scale[1]};
    return made;
}

GltfPlacement placement_of(const Json &texture) {
    const Json &transform = member(member(texture, "extensions"), "KHR_texture_transform");
    // Casting a number that no unsigned integer holds would be undefined.
    const double uv_set =
        std::clamp(number(transform, "texCoord", number(texture, "texCoord", 0)), 0.0, 1e6);
    return {static_cast<unsigned>(uv_set), transform_of(transform)};
}

/// Reads the placements of base colour, normals and emission. Without a base colour the normals
/// have the texture coordinates for themselves, and without both the emission has.
void read_placements(const Json &material, GltfMaterial &made) {
    const Json &physical = member(material, "pbrMetallicRoughness");
    const Json &base_texture = member(physical, "baseColorTexture");
    const Json &normal_texture = member(material, "normalTexture");
    const Json &emission_texture = member(material, "emissiveTexture");
    const GltfPlacement normals = placement_of(normal_texture);
    made.emission = placement_of(emission_texture);
    made.roughness = placement_of(member(physical, "metallicRoughnessTexture"));
    const GltfPlacement base = base_texture.is_object()       ? placement_of(base_texture)
                               : normal_texture.is_object()   ? normals
                               : emission_texture.is_object() ? made.emission
                                                              : made.roughness;
    made.base_uv_set = base.uv_set;
    made.base_transform = base.transform;
    made.normal_scale = number(normal_texture, "scale", 1);
    made.normals_use_base_uv =
        normals.uv_set == base.uv_set && !normals.transform.rotates() && !base.transform.rotates();
    made.normal_transform = normals.transform;
}

/// Notes textures of extensions, which are not read.
void note_textures(const Json &extension, const std::string &what, const std::string &name,
                   ModelNotes &notes) {
    for (const auto &[key, value] : extension.items()) {
        const bool is_read = std::find(std::begin(read_textures), std::end(read_textures), key) !=
                             std::end(read_textures);
        if (value.is_object() && value.contains("index") && !is_read) {
            notes.add(fmt::format("textures of {} are ignored, such as {}", what, shown(key)),
                      name);
        }
    }
}

GltfMaterial read_material(const Json &material, const std::string &name, ModelNotes &notes) {
    const Json &extensions = member(material, "extensions");
    for (const auto &[key, value] : extensions.items()) {
        if (!is_supported(key)) {
            notes.add(ignored_note(key), name);
        } else {
            note_textures(value, key, name, notes);
        }
    }
    GltfMaterial made;
    made.name = name;
    made.emissive_strength =
        number(member(extensions, "KHR_materials_emissive_strength"), "emissiveStrength", 1);
    made.ior = number(member(extensions, "KHR_materials_ior"), "ior", made.ior);
    made.transmission =
        number(member(extensions, "KHR_materials_transmission"), "transmissionFactor", 0);
    const Json &volume = member(extensions, "KHR_materials_volume");
    made.thickness = number(volume, "thicknessFactor", 0);
    made.attenuation_distance = number(volume, "attenuationDistance", made.attenuation_distance);
    made.attenuation_colour = colour(volume, "attenuationColor");
    made.transmission_map = placement_of(
        member(member(extensions, "KHR_materials_transmission"), "transmissionTexture"));
    const Json &clearcoat = member(extensions, "KHR_materials_clearcoat");
    made.clearcoat = number(clearcoat, "clearcoatFactor", 0);
    made.clearcoat_roughness = number(clearcoat, "clearcoatRoughnessFactor", 0);
    const Json &sheen = member(extensions, "KHR_materials_sheen");
    made.sheen_colour = member(sheen, "sheenColorFactor").is_null()
                            ? Vector3d(0, 0, 0)
                            : colour(sheen, "sheenColorFactor");
    made.sheen_map = placement_of(member(sheen, "sheenColorTexture"));
    const Json &specular = member(extensions, "KHR_materials_specular");
    made.specular = number(specular, "specularFactor", 1);
    made.specular_colour = colour(specular, "specularColorFactor");
    const Json &two_sided = member(material, "doubleSided");
    made.is_two_sided = two_sided.is_boolean() && two_sided.get<bool>();
    read_placements(material, made);
    return made;
}

/// Calls `change(entry, index)` for the entries of an array of the document.
template <typename Change>
void change_each(Json &document, const char *key, const Change &change) {
    if (!member(document, key).is_array()) {
        return;
    }
    size_t index = 0;
    for (Json &entry : document[key]) {
        if (entry.is_object()) {
            change(entry, index);
        }
        ++index;
    }
}

/// Appends a copy of the entry that `reference` is the index of, and refers to it.
void separate(Json &reference, const Json &from, Json &to) {
    if (reference.is_number_unsigned() && from.is_array() &&
        reference.get<size_t>() < from.size()) {
        to.push_back(from[reference.get<size_t>()]);
        reference = to.size() - 1;
    }
}

void separate_lights_and_cameras(Json &document) {
    const Json cameras = member(document, "cameras");
    const Json lights = member(member(member(document, "extensions"), punctual), "lights");
    Json own_cameras = Json::array();
    Json own_lights = Json::array();
    change_each(document, "nodes", [&](Json &node, size_t) {
        if (!member(node, "camera").is_null()) {
            separate(node["camera"], cameras, own_cameras);
        }
        if (!member(member(member(node, "extensions"), punctual), "light").is_null()) {
            separate(node["extensions"][punctual]["light"], lights, own_lights);
        }
    });
    if (cameras.is_array()) {
        document["cameras"] = own_cameras;
    }
    if (lights.is_array()) {
        document["extensions"][punctual]["lights"] = own_lights;
    }
}

/// Returns a URI without percent-encoding. Embedded data remain as they are.
std::string decoded(const std::string &uri) {
    if (uri.compare(0, 5, "data:") == 0) {
        return uri;
    }
    std::string text;
    for (size_t i = 0; i < uri.size(); ++i) {
        unsigned code = 0;
        const char *const digits = uri.data() + i + 1;
        if (uri[i] == '%' && i + 2 < uri.size() &&
            std::from_chars(digits, digits + 2, code, 16).ptr == digits + 2) {
            text.push_back(static_cast<char>(code));
            i += 2;
        } else {
            text.push_back(uri[i]);
        }
    }
    return text;
}

/// Returns the entry of an array of the document, or null.
const Json &entry(const Json &document, const char *array, const Json &index) {
    static const Json null;
    const Json &all = member(document, array);
    return index.is_number_unsigned() && all.is_array() && index.get<size_t>() < all.size()
               ? all[index.get<size_t>()]
               : null;
}

/// Throws if colours of vertices have a type that glTF does not allow. Notes their alpha, which
/// would multiply the opacity.
void check_colours(const Json &document, const Json &primitive, const std::string &mesh,
                   ModelNotes &notes) {
    constexpr int floats = 5126, bytes = 5121, shorts = 5123;
    const Json &accessor =
        entry(document, "accessors", member(member(primitive, "attributes"), "COLOR_0"));
    const Json &type = member(accessor, "componentType");
    if (type.is_number_unsigned() && type != floats && type != bytes && type != shorts) {
        throw input_error(fmt::format(
            "mesh '{}': COLOR_0 has the component type {}; it must be 5121, 5123 or 5126", mesh,
            type.get<uint64_t>()));
    }
    const Json &alpha_mode =
        member(entry(document, "materials", member(primitive, "material")), "alphaMode");
    if (member(accessor, "type") == "VEC4" && alpha_mode.is_string() && alpha_mode != "OPAQUE") {
        notes.add("the alpha of vertex colours is ignored", mesh);
    }
}

/// Throws if vertices have attributes of integers, which Assimp reads as the bits of floats.
void check_attributes(const Json &document, ModelNotes &notes) {
    constexpr int floats = 5126;
    for (const Json &mesh : member(document, "meshes")) {
        const Json &name = member(mesh, "name");
        const std::string shown_name = name.is_string() ? shown(name.get<std::string>()) : "";
        for (const Json &primitive : member(mesh, "primitives")) {
            check_colours(document, primitive, shown_name, notes);
            for (const auto &[key, value] : member(primitive, "attributes").items()) {
                const bool is_read =
                    key == "POSITION" || key == "NORMAL" || key.compare(0, 9, "TEXCOORD_") == 0;
                const Json &type = member(entry(document, "accessors", value), "componentType");
                if (is_read && type.is_number_unsigned() && type != floats) {
                    throw input_error(
                        fmt::format("mesh '{}': {} is stored as integers, which is unsupported; "
                                    "export floats",
                                    shown_name, key));
                }
            }
        }
    }
}

/// Notes buffers whose files are longer than stated, beyond the padding to four bytes.
void note_buffers(const Json &document, const std::filesystem::path &folder, ModelNotes &notes) {
    for (const Json &buffer : member(document, "buffers")) {
        const Json &uri = member(buffer, "uri");
        const Json &length = member(buffer, "byteLength");
        if (!uri.is_string() || !length.is_number_unsigned()) {
            continue;
        }
        const std::string name = decoded(uri.get<std::string>());
        std::error_code missing;
        const uintmax_t size = name.compare(0, 5, "data:") == 0
                                   ? 0
                                   : std::filesystem::file_size(folder / name, missing);
        if (!missing && size > length.get<uintmax_t>() + 3) {
            notes.add(
                "buffers are longer than stated; they may be damaged by a change of line "
                "endings",
                shown(name));
        }
    }
}

/// Sizes in a .glb file, little-endian as the host.
constexpr size_t file_size_at = 8;
constexpr size_t json_size_at = 12;
constexpr size_t json_begin = 20;

uint32_t size_in(const std::string &file, size_t at) {
    uint32_t size = 0;
    std::memcpy(&size, file.data() + at, sizeof size);
    return size;
}

void set_size(std::string &file, size_t at, size_t value) {
    const auto size = static_cast<uint32_t>(value);
    std::memcpy(file.data() + at, &size, sizeof size);
}

/// Checks the sizes in a .glb file. A change of line endings makes them wrong, and Assimp would
/// read shifted numbers.
void check_sizes(const std::string &file) {
    if (file.size() < json_begin) {
        throw input_error("unexpected end of file");
    }
    if (size_in(file, file_size_at) != file.size()) {
        throw input_error(fmt::format("the file has {} bytes, but its header states {}",
                                      file.size(), size_in(file, file_size_at)));
    }
    if (size_in(file, json_size_at) > file.size() - json_begin) {
        throw input_error("the JSON is longer than the file");
    }
}

}  // namespace

GltfFile read_gltf(const std::filesystem::path &path) {
    std::string text = read_file(path);
    GltfFile file;
    if (text.compare(0, 4, "glTF") == 0) {
        try {
            check_sizes(text);
        } catch (const Error &error) {
            throw Error(error.exit_code(), fmt::format("{}: {}", path.string(), error.what()));
        }
        file.head = text.substr(0, json_begin);
        const uint32_t size = size_in(text, json_size_at);
        file.chunks = text.substr(json_begin + size);
        text = text.substr(json_begin, size);
    }
    file.document = parse_json(text, path.string());
    return file;
}

std::string for_assimp(GltfFile file) {
    for (const char *key : {"materials", "nodes"}) {
        change_each(file.document, key,
                    [](Json &entry, size_t index) { entry["name"] = std::to_string(index); });
    }
    separate_lights_and_cameras(file.document);
    for (const char *key : {"buffers", "images"}) {
        change_each(file.document, key, [](Json &entry, size_t) {
            if (member(entry, "uri").is_string()) {
                entry["uri"] = decoded(entry["uri"].get<std::string>());
            }
        });
    }
    std::string text = file.document.dump(-1, ' ', false, Json::error_handler_t::replace);
    if (file.head.empty()) {
        return text;
    }
    text.append((4 - text.size() % 4) % 4, ' ');
    set_size(file.head, json_size_at, text.size());
    set_size(file.head, file_size_at, json_begin + text.size() + file.chunks.size());
    return file.head + text + file.chunks;
}

std::vector<std::string> gltf_node_names(const Json &document) {
    std::vector<std::string> names;
    const Json &nodes = member(document, "nodes");
    if (!nodes.is_array()) {
        return names;  // glTF 1.0 has an object
    }
    for (const Json &node : nodes) {
        const Json &name = member(node, "name");
        names.push_back(name.is_string() ? name.get<std::string>() : "");
    }
    return names;
}

void check_gltf(const Json &document, const std::filesystem::path &path, ModelNotes &notes) {
    for (const Json &extension : member(document, "extensionsRequired")) {
        if (!extension.is_string() || !is_supported(extension.get<std::string>())) {
            throw input_error(fmt::format(
                "the file requires the extension {}, which is unsupported; supported extensions "
                "are: {}",
                shown(extension.dump()), fmt::join(supported_extensions, ", ")));
        }
    }
    for (const Json &extension : member(document, "extensionsUsed")) {
        if (!extension.is_string() || !is_supported(extension.get<std::string>())) {
            notes.add(ignored_note(extension.is_string() ? extension.get<std::string>()
                                                         : extension.dump()));
        }
    }
    check_attributes(document, notes);
    note_buffers(document, path.parent_path(), notes);
    if (member(document, "scenes").size() > 1) {
        notes.add("only the default scene is used");
    }
    const Json &lights = member(member(member(document, "extensions"), punctual), "lights");
    for (const Json &light : lights) {
        if (!member(light, "range").is_null()) {
            const Json &name = member(light, "name");
            notes.add("ranges of lights are ignored",
                      name.is_string() ? shown(name.get<std::string>()) : "a light without a name");
        }
    }
}

std::vector<GltfMaterial> gltf_materials(const Json &document, ModelNotes &notes) {
    std::vector<GltfMaterial> made;
    const Json &materials = member(document, "materials");
    if (!materials.is_array()) {
        return made;  // glTF 1.0 has an object
    }
    for (const Json &material : materials) {
        const Json &stated = member(material, "name");
        const std::string name = stated.is_string() ? stated.get<std::string>() : std::string();
        try {
            made.push_back(read_material(material, name, notes));
        } catch (const nlohmann::json::exception &error) {
            throw input_error(fmt::format("material '{}': {}", shown(name), error.what()));
        }
    }
    return made;
}

}  // namespace rtrays
