// SPDX-License-Identifier: MIT
// Tests the documentation of the scene format: its examples load, and the documentation, the schema
// and the tables of types contain the same names.
#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>
#include <set>

#include "embedded/scene_schemas.h"
#include "renderer/base/files.h"
#include "renderer/base/image.h"
#include "renderer/base/json.h"
#include "renderer/import/json/scene_json.h"
#include "renderer/import/load_scene.h"
#include "renderer/scene/cores/composite.h"
#include "renderer/scene/cores/metals.h"
#include "renderer/testing/scene_builder.h"

namespace rtrays {
namespace {

using Names = std::set<std::string>;

/// Returns the JSON blocks of docs/scene-format.md, in order.
std::vector<Json> examples() {
    const std::string path = std::string(RTRAYS_SCENES) + "/../docs/scene-format.md";
    const std::string text = read_file(path);
    const std::string opening = "```json\n";
    std::vector<Json> blocks;
    for (size_t at = text.find(opening); at != std::string::npos; at = text.find(opening, at)) {
        at += opening.size();
        const size_t end = text.find("```", at);
        const auto line =
            1 + std::count(text.begin(), text.begin() + static_cast<std::ptrdiff_t>(at), '\n');
        blocks.push_back(parse_json(text.substr(at, end - at), path + ":" + std::to_string(line)));
    }
    return blocks;
}

/// Completes a part of a scene. Adds missing required members, and a node for every shared material
/// and geometry, so that all of them reach the arrays.
Json completed(Json part) {
    part.emplace("version", 1);
    part.emplace("film", Json{{"width", 1}, {"height", 1}});
    part.emplace("nodes", Json::array());
    const Json black = {{"type", "lambert"}, {"reflectance", {0, 0, 0}}};
    int count = 0;
    for (const char *section : {"materials", "geometries"}) {
        const Json shared = part.value(section, Json::object());
        for (const auto &item : shared.items()) {
            const bool is_material = std::string(section) == "materials";
            part["nodes"].push_back(
                {{"name", "added " + std::to_string(count++)},
                 {"material", is_material ? Json(item.key()) : black},
                 {"geometry", is_material ? Json{{"type", "rectangle"}} : Json(item.key())}});
        }
    }
    if (!part.contains("camera")) {
        part["nodes"].push_back(
            {{"name", "eye"}, {"camera", {{"type", "pinhole"}, {"fov", 40}, {"fov_axis", "x"}}}});
        part["camera"] = "eye";
    }
    return part;
}

/// Collects the values of `key` at all depths below `value`, in objects that are the value of
/// `owner` or an item of that value.
void collect(const Json &value, const std::string &owner, const std::string &key, bool inside,
             Names &names) {
    if (inside && value.is_object() && value.contains(key)) {
        names.insert(value.at(key).get<std::string>());
    }
    if (value.is_structured()) {
        for (const auto &item : value.items()) {
            const bool is_owner = value.is_object() && (item.key() == owner);
            const bool keeps = inside && !value.contains(key);  // "materials": {NAME: {...}}
            collect(item.value(), owner, key,
                    is_owner || (keeps && item.value().is_object()) || (inside && value.is_array()),
                    names);
        }
    }
}

Names used(const std::vector<std::string> &owners, const std::string &key) {
    Names names;
    for (const Json &block : examples()) {
        for (const std::string &owner : owners) {
            collect(block, owner, key, false, names);
        }
    }
    return names;
}

Names schema_enum(const std::string &definition, const std::string &key) {
    const Json schema =
        parse_json(std::string(embedded::scene_schemas().text("scene.schema.json")), "schema");
    return schema.at("definitions").at(definition).at("properties").at(key).at("enum").get<Names>();
}

template <typename Table>
Names names_of(const Table &table, Names names = {}) {
    for (const auto &row : table) {
        names.insert(row.name);
    }
    return names;
}

class SceneFormat : public WithImages {};

TEST_F(SceneFormat, EveryExampleIsReadAndSerialized) {
    for (const char *name : {"wood.png", "fence.png", "stone.png", "dents.png"}) {
        std::ofstream(testing::TempDir() + name, std::ios::binary) << "P6 1 1 255\nabc";
    }
    for (const auto &[from, to] :
         {std::pair(RTRAYS_CORPUS "/square.ply", "bunny.ply"),
          std::pair(RTRAYS_SCENES "/features/assets/leaf.png", "leaf.png")}) {
        std::filesystem::copy_file(from, testing::TempDir() + to,
                                   std::filesystem::copy_options::overwrite_existing);
    }
    for (const char *name : {"grid.exr", "sky.exr"}) {
        Image image = Image::rgb(1, 1);
        write_exr(image, testing::TempDir() + name);
    }
    size_t properties = 0;
    const std::vector<Json> blocks = examples();
    EXPECT_GE(blocks.size(), 7u);
    for (Json block : blocks) {
        if (block.contains("base")) {
            const std::string folder = std::string(RTRAYS_SCENES) + "/../docs/";
            block["base"] = folder + block.at("base").get<std::string>();
            const std::string overlay = testing::TempDir() + "example_overlay.json";
            write_file(overlay, block.dump(2));
            expect_consistent(load_scene(overlay).graph());
            continue;
        }
        const std::string text = completed(block).dump(2);
        SCOPED_TRACE(text);
        Scene scene = parse_scene_json(
            text, "example", "example", testing::TempDir(),
            {[](const std::filesystem::path &path) { return load_scene(path.string()); }, false});
        expect_consistent(scene.graph());
        const std::string list = scene.describe();
        properties += static_cast<size_t>(std::count(list.begin(), list.end(), '\n'));
    }
    EXPECT_GT(properties, 400u);
}

TEST_F(SceneFormat, ExamplesSchemaAndTablesNameTheSameTypes) {
    const Names materials = names_of(material_types(), {"composite"});
    EXPECT_EQ(schema_enum("material", "type"), materials);
    EXPECT_EQ(used({"materials", "material"}, "type"), materials);
    const Names geometries = names_of(shape_types(), {"mesh", "morph", "file", "rectangle", "box"});
    EXPECT_EQ(schema_enum("geometry", "type"), geometries);
    EXPECT_EQ(used({"geometries", "geometry"}, "type"), geometries);
    EXPECT_EQ(schema_enum("light", "type"), names_of(light_types()));
    EXPECT_EQ(used({"light"}, "type"), names_of(light_types()));
    EXPECT_EQ(schema_enum("camera", "type"), names_of(camera_types()));
    EXPECT_EQ(used({"camera"}, "type"), names_of(camera_types()));
    EXPECT_EQ(schema_enum("material", "preset"), names_of(metals()));
    const Names bxdfs(bxdf_names().begin(), bxdf_names().end());
    EXPECT_EQ(schema_enum("component", "bxdf"), bxdfs);
    EXPECT_EQ(used({"components"}, "bxdf"), bxdfs);
    const Names fresnels(fresnel_names().begin(), fresnel_names().end());
    const Json schema =
        parse_json(std::string(embedded::scene_schemas().text("scene.schema.json")), "schema");
    EXPECT_EQ(
        schema.at("/definitions/component/properties/fresnel/properties/type/enum"_json_pointer)
            .get<Names>(),
        fresnels);
}

/// Returns the keys of a definition of the schema, without those in `others`.
Names schema_keys(const std::string &definition, const Names &others) {
    const Json schema =
        parse_json(std::string(embedded::scene_schemas().text("scene.schema.json")), "schema");
    Names keys;
    for (const auto &property : schema.at("definitions").at(definition).at("properties").items()) {
        if (others.count(property.key()) == 0) {
            keys.insert(property.key());
        }
    }
    return keys;
}

template <typename Types>
Names parameters_of(const Types &types) {
    Names names;
    for (const auto &type : types) {
        for (const Parameter &parameter : type.parameters) {
            names.insert(parameter.name);
            if (parameter.textured) {
                names.insert(parameter.name + "_texture");
            }
        }
    }
    return names;
}

TEST(SceneSchema, HasTheKeysOfTheTables) {
    EXPECT_EQ(schema_keys("material", {"type", "components"}), parameters_of(material_types()));
    EXPECT_EQ(schema_keys("geometry", {"type", "vertices", "polygons", "normals", "uvs", "colours",
                                       "keyframes", "file", "shading_normals"}),
              parameters_of(shape_types()));
    EXPECT_EQ(schema_keys("light", {"type", "file"}), parameters_of(light_types()));
    EXPECT_EQ(schema_keys("camera", {"type"}), parameters_of(camera_types()));
}

}  // namespace
}  // namespace rtrays
