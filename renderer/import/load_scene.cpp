// SPDX-License-Identifier: MIT
// Selects the scene reader by file name extension.
#include <fmt/format.h>

#include <filesystem>
#include <nlohmann/json.hpp>

#include "embedded/scene_schemas.h"
#include "renderer/base/error.h"
#include "renderer/base/files.h"
#include "renderer/base/json.h"
#include "renderer/import/json/scene_json.h"
#include "renderer/import/json/values.h"
#include "renderer/import/load_scene.h"
#include "renderer/import/mitsuba/mitsuba_xml.h"
#include "renderer/import/models/model_file.h"

namespace rtrays {

namespace {

using Defines = std::map<std::string, std::string>;

/// Deepest nesting of overlays and imports. A deeper one is a file that contains itself.
constexpr int most_nested = 16;

/// A file to load, and its place among the files that contain it.
struct Loading {
    bool quiet;
    const Defines &defines;
    int depth;     ///< number of files that contain this one
    bool is_part;  ///< imported: it needs neither camera nor light
};

/// Returns the name of a scene that has none of its own. scenes/cornell_box/scene.json is named
/// cornell_box by its folder, scenes/analytic/furnace_050.json furnace_050 by its file.
std::string name_of_file(const std::filesystem::path &file) {
    const std::filesystem::path absolute = std::filesystem::absolute(file);
    return (file.stem() == "scene" && absolute.has_parent_path() ? absolute.parent_path().filename()
                                                                 : file.stem())
        .string();
}

void require_no_defines(const std::string &path, const Defines &defines) {
    if (!defines.empty()) {
        throw input_error(fmt::format(
            "{}: --define requires a Mitsuba scene (.xml); use --set for other formats", path));
    }
}

Scene load(const std::filesystem::path &file, const Loading &loading);

/// Returns how a file is loaded that `outer` contains.
Loading contained_in(const Loading &outer) {
    if (outer.depth == most_nested) {
        throw input_error("files are nested too deeply; does one contain itself?");
    }
    Loading inner = outer;
    ++inner.depth;
    return inner;
}

Scene load_overlay(const Json &document, const SceneSource &source, const Loading &loading) {
    validate_json(document, std::string(embedded::scene_schemas().text("overlay.schema.json")),
                  source.name, source.text);
    Scene scene = source.located(
        "/base", [&] { return load(source.file(document.at("base")), contained_in(loading)); });
    scene.set_name(document.value("name", name_of_file(source.name)));
    set_properties(scene, document, "", source);
    source.located("", [&] { scene.update(0); });
    if (document.contains("camera")) {
        source.located("/camera", [&] { scene.set_active_camera(document.at("camera")); });
    }
    if (document.contains("film")) {
        const Json &film = document.at("film");
        scene.set_film_size(film.at("width"), film.at("height"));
    }
    return scene;
}

Scene load(const std::filesystem::path &file, const Loading &loading) {
    const std::string path = file.string();
    const bool is_mitsuba = file.extension() == ".xml";
    if (!is_mitsuba && is_model_file(file)) {
        require_no_defines(path, loading.defines);
        return load_model(file, loading.quiet, loading.is_part);
    }
    // Read first, so that a missing file is reported as missing and not as an unknown format.
    const std::string text = read_file(file);
    if (is_mitsuba) {
        return parse_mitsuba_xml(text, path, name_of_file(file), file.parent_path(),
                                 loading.defines, loading.is_part);
    }
    if (file.extension() != ".json") {
        throw input_error(fmt::format(
            "{}: unknown scene format '{}'; known formats are: .json, .xml (Mitsuba 3) and model "
            "files (.ply, .obj, .gltf, .glb, .fbx, .dae, .3ds, .stl, ...)",
            path, file.extension().string()));
    }
    if (text.find("\"base\"") != std::string::npos) {
        const Json document = parse_json(text, path);
        if (document.is_object() && document.contains("base")) {
            return load_overlay(document, {text, path, file.parent_path()}, loading);
        }
    }
    require_no_defines(path, loading.defines);
    const auto load_import = [&](const std::filesystem::path &part) {
        Loading of_part = contained_in(loading);
        of_part.is_part = true;
        return load(part, of_part);
    };
    return parse_scene_json(text, path, name_of_file(file), file.parent_path(),
                            {load_import, loading.is_part});
}

}  // namespace

Scene load_scene(const std::string &path, bool quiet, const Defines &defines) {
    return load(path, {quiet, defines, 0, false});
}

std::map<std::string, std::string> parse_defines(const std::vector<std::string> &texts) {
    std::map<std::string, std::string> defines;
    for (const std::string &text : texts) {
        const size_t equals = text.find('=');
        if (equals == std::string::npos || equals == 0) {
            throw input_error(fmt::format("--define {}: expected NAME=VALUE", text));
        }
        defines[text.substr(0, equals)] = text.substr(equals + 1);
    }
    return defines;
}

}  // namespace rtrays
