// SPDX-License-Identifier: MIT
#include "renderer/import/json/material.h"

#include <fmt/format.h>

#include <utility>

#include "renderer/scene/cores/composite.h"

namespace rtrays {

namespace {

const std::string texture_suffix = "_texture";

/// Reads the "NAME_texture" members of `object`, where NAME is a parameter of the table. Appends
/// all such keys to `keys`.
ParameterTextures read_textures(const Json &object, const ParameterTable &table,
                                const std::string &prefix, const std::string &name,
                                const std::string &path, const TextureLookup &lookup,
                                std::vector<std::string> &keys) {
    ParameterTextures textures;
    for (const Parameter &parameter : table) {
        if (!parameter.textured || parameter.name.rfind(prefix, 0) != 0) {
            continue;
        }
        const std::string key = parameter.name.substr(prefix.size()) + texture_suffix;
        keys.push_back(key);
        if (object.contains(key)) {
            textures[parameter.name] = lookup(
                object.at(key), name + "." + parameter.name + texture_suffix, path + "/" + key);
        }
    }
    return textures;
}

/// Returns the rows of the table whose names begin with `prefix`, with the prefix removed.
ParameterTable without_prefix(const ParameterTable &table, const std::string &prefix) {
    ParameterTable rows;
    for (const Parameter &parameter : table) {
        if (parameter.name.rfind(prefix, 0) == 0) {
            rows.push_back(parameter);
            rows.back().name.erase(0, prefix.size());
        }
    }
    return rows;
}

void add_with_prefix(const ParameterValues &from, const std::string &prefix, ParameterValues &to) {
    for (const auto &[name, value] : from) {
        to.emplace(prefix + name, value);
    }
}

std::shared_ptr<MaterialCore> read_composite(const Json &value, const std::string &name,
                                             const SceneSource &source, const std::string &path,
                                             const TextureLookup &lookup) {
    const ParameterTable &common = common_material_parameters();
    std::vector<std::string> others = {"components"};
    ParameterTextures textures = read_textures(value, common, "", name, path, lookup, others);
    ParameterValues values = parameter_values(value, "composite", common, others, source, path);
    if (!value.contains("components")) {
        throw input_error("missing key 'components' of the composite");
    }
    const Json &components = value.at("components");
    std::vector<CompositePart> parts;
    for (const Json &component : components) {
        CompositePart part{component.at("bxdf")};
        if (component.contains("fresnel")) {
            part.fresnel = component.at("fresnel").at("type");
        }
        parts.push_back(part);
    }
    const std::shared_ptr<const MaterialType> type = composite_type(parts);
    for (size_t i = 0; i < parts.size(); ++i) {
        const std::string at = fmt::format("{}/components/{}", path, i);
        const std::string prefix = part_prefix(i);
        const std::string fresnel_prefix = prefix + "fresnel_";
        const Json &component = components[i];
        std::vector<std::string> other_keys = {"bxdf", "fresnel"};
        textures.merge(
            read_textures(component, type->parameters, prefix, name, at, lookup, other_keys));

        ParameterTable rows;
        for (Parameter &row : without_prefix(type->parameters, prefix)) {
            if (row.name.rfind("fresnel_", 0) != 0) {
                rows.push_back(std::move(row));
            }
        }
        add_with_prefix(parameter_values(component, parts[i].bxdf, rows, other_keys, source, at),
                        prefix, values);
        if (component.contains("fresnel")) {
            add_with_prefix(
                parameter_values(component.at("fresnel"), parts[i].fresnel + " Fresnel term",
                                 without_prefix(type->parameters, fresnel_prefix), {}, source,
                                 at + "/fresnel"),
                fresnel_prefix, values);
        }
    }
    return std::make_shared<MaterialCore>(name, type, values, textures);
}

}  // namespace

std::shared_ptr<Texture> read_texture(const Json &value, const std::string &name,
                                      const SceneSource &source, const std::string &path,
                                      TextureFiles &files) {
    const ParameterValues values = parameter_values(value, "texture", Texture::parameter_table(),
                                                    {"file", "encoding"}, source, path);
    const bool has_file = value.contains("file");
    if (has_file != value.contains("encoding") ||
        (!has_file && !value.value("vertex_colours", false))) {
        return source.located(path, []() -> std::shared_ptr<Texture> {
            throw input_error("a texture needs a file and its encoding, vertex_colours, or both");
        });
    }
    if (!has_file) {
        return std::make_shared<Texture>(name, white_image(), values);
    }
    return source.located(path + "/file", [&] {
        const std::string &encoding_name = value.at("encoding").get_ref<const std::string &>();
        const TextureEncoding encoding = encoding_name == "srgb"    ? TextureEncoding::srgb
                                         : encoding_name == "alpha" ? TextureEncoding::alpha
                                                                    : TextureEncoding::linear;
        return std::make_shared<Texture>(name, files.load(source.file(value.at("file")), encoding),
                                         values);
    });
}

std::shared_ptr<MaterialCore> read_material(const Json &value, const std::string &name,
                                            const SceneSource &source, const std::string &path,
                                            const TextureLookup &lookup) {
    return source.located(path, [&] {
        const std::string type_name = value.at("type");
        if (type_name == "composite") {
            return read_composite(value, name, source, path, lookup);
        }
        const MaterialType &type = find_type(material_types(), type_name, "material");
        std::vector<std::string> others;
        const ParameterTextures textures =
            read_textures(value, type.parameters, "", name, path, lookup, others);
        const ParameterValues values =
            parameter_values(value, type.name, type.parameters, others, source, path);
        return std::make_shared<MaterialCore>(name, type.name, values, textures);
    });
}

}  // namespace rtrays
