// SPDX-License-Identifier: MIT
// Selects the scene reader by file name extension.
#include <fmt/format.h>

#include <filesystem>

#include "renderer/base/error.h"
#include "renderer/base/files.h"
#include "renderer/import/json/scene_json.h"
#include "renderer/import/load_scene.h"
#include "renderer/import/mitsuba/mitsuba_xml.h"
#include "renderer/import/models/model_file.h"

namespace rtrays {

Scene load_scene(const std::string &path, bool quiet,
                 const std::map<std::string, std::string> &defines) {
    const std::filesystem::path file(path);
    const bool is_mitsuba = file.extension() == ".xml";
    if (!is_mitsuba && !defines.empty()) {
        throw input_error(fmt::format(
            "{}: --define requires a Mitsuba scene (.xml); use --set for other formats", path));
    }
    if (!is_mitsuba && is_model_file(file)) {
        return load_model(file, quiet);
    }
    // Read first, so that a missing file is reported as missing and not as an unknown format.
    const std::string text = read_file(file);
    if (!is_mitsuba && file.extension() != ".json") {
        throw input_error(fmt::format(
            "{}: unknown scene format '{}'; known formats are: .json, .xml (Mitsuba 3) and model "
            "files (.ply, .obj, .gltf, .glb, .fbx, .dae, .3ds, .stl, ...)",
            path, file.extension().string()));
    }
    // scenes/cornell_box/scene.json is named cornell_box by its folder.
    // scenes/analytic/furnace_050.json is named furnace_050 by its file.
    const bool named_by_folder =
        file.stem() == "scene" && std::filesystem::absolute(file).has_parent_path();
    const std::filesystem::path named =
        named_by_folder ? std::filesystem::absolute(file).parent_path().filename() : file.stem();
    return is_mitsuba ? parse_mitsuba_xml(text, path, named.string(), file.parent_path(), defines)
                      : parse_scene_json(text, path, named.string(), file.parent_path());
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
