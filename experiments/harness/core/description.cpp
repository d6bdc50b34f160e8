// SPDX-License-Identifier: MIT
#include "experiments/harness/core/description.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <set>

#include "embedded/experiment_schemas.h"
#include "renderer/base/error.h"
#include "renderer/base/files.h"

namespace rtrays {

std::filesystem::path DescriptionFile::resolve(const Json &relative) const {
    return (path.parent_path() / relative.get<std::string>()).lexically_normal();
}

std::vector<std::filesystem::path> DescriptionFile::scenes(const Json &profile) const {
    std::vector<std::filesystem::path> files;
    for (const Json &scene : profile.at("scenes")) {
        const std::filesystem::path named = resolve(json.at("folder")) / scene.get<std::string>();
        if (named.filename() != "*") {
            files.push_back(named.string() + ".json");
            continue;
        }
        const size_t before = files.size();
        for (const auto &entry : std::filesystem::directory_iterator(named.parent_path())) {
            if (entry.path().extension() == ".json") {
                files.push_back(entry.path());
            }
        }
        std::sort(files.begin() + static_cast<std::ptrdiff_t>(before), files.end());
    }
    return files;
}

const Json &DescriptionFile::profile(const std::string &name) const {
    const Json &profiles = json.at("profiles");
    if (!profiles.contains(name)) {
        std::vector<std::string> names;
        for (const auto &[known, value] : profiles.items()) {
            names.push_back(known);
        }
        throw input_error(fmt::format("{}: unknown profile '{}'; profiles are: {}", path.string(),
                                      name, fmt::join(names, ", ")));
    }
    return profiles.at(name);
}

std::string DescriptionFile::of_profile(const std::string &name) const {
    Json alone = json;
    alone["profiles"] = {{name, profile(name)}};
    return alone.dump();
}

DescriptionFile read_description(const std::filesystem::path &path) {
    DescriptionFile file{path, read_file(path), {}};
    file.json = parse_json(file.text, path.string());
    return file;
}

void require_schema(const DescriptionFile &file, const std::string &schema) {
    validate_json(file.json, std::string(embedded::experiment_schemas().text(schema)),
                  file.path.string(), file.text);
}

DescriptionFile load_description(const std::filesystem::path &path, const std::string &schema) {
    DescriptionFile file = read_description(path);
    require_schema(file, schema);
    return file;
}

void read_measured_scene(const DescriptionFile &file, const Json &size, MeasuredScene &scene) {
    scene.scene = file.resolve(file.json.at("scene"));
    scene.reference_folder = file.resolve(file.json.at("reference").at("folder"));
    file.json.at("reference").at("engine").get_to(scene.reference_engine);
    size.at(0).get_to(scene.width);
    size.at(1).get_to(scene.height);
    std::set<std::string> ids;
    for (const Json &curve : file.json.at("curves")) {
        scene.curves.push_back({parse_render_settings(curve)});
        if (const std::string id = scene.curves.back().id(); !ids.insert(id).second) {
            throw input_error(
                fmt::format("{}: two curves have the id '{}'; change the algorithm or the settings "
                            "of one",
                            file.location("/curves"), id));
        }
    }
}

void require_increasing(const std::vector<uint64_t> &spp, const std::string &location) {
    for (size_t i = 1; i < spp.size(); ++i) {
        if (spp[i] <= spp[i - 1]) {
            throw input_error(fmt::format("{}: values must increase, got {} after {}", location,
                                          spp[i], spp[i - 1]));
        }
    }
}

std::string CurveDescription::id() const {
    std::string id = fmt::format("{}.{}", settings.algorithm->name,
                                 name_in(path_strategies, settings.strategies));
    const std::string root = "integrator.";
    for (const std::string &setting : changed_settings(settings)) {
        if (setting.rfind(root + "strategies", 0) != 0) {
            id += "," + setting.substr(root.size());
        }
    }
    return id;
}

void apply_settings(RenderSettings &settings, const Json &named) {
    for (const auto &[name, value] : named.items()) {
        apply_setting(settings,
                      name + "=" + (value.is_string() ? value.get<std::string>() : value.dump()));
    }
}

RenderSettings parse_render_settings(const Json &curve) {
    RenderSettings settings;
    settings.algorithm = &algorithm_named(curve.at("algorithm"));
    apply_settings(settings, curve.value("settings", Json::object()));
    require_consistent(settings);
    return settings;
}

}  // namespace rtrays
