// SPDX-License-Identifier: MIT
#include "experiments/harness/core/description.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cctype>
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

std::string DescriptionFile::default_profile() const {
    const Json &profiles = json.at("profiles");
    return profiles.size() == 1 ? profiles.begin().key() : "quick";
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

namespace {

/// Reads another renderer. Throws `Error` (bad input) for members that do not belong together.
OtherRenderer parse_other_renderer(const Json &curve, const std::string &location) {
    OtherRenderer other;
    curve.at("engine").get_to(other.engine);
    const auto require = [&](bool fits, const char *expected) {
        if (!fits) {
            throw input_error(fmt::format("{}: {}", location, expected));
        }
    };
    const bool is_mitsuba = other.engine == "mitsuba", is_command = other.engine == "command";
    require(
        !curve.contains("algorithm") && !curve.contains("settings"),
        "\"algorithm\" and \"settings\" are of this renderer; a curve with \"engine\" has none");
    require(is_mitsuba || !(curve.contains("variant") || curve.contains("roulette_start")),
            "\"variant\" and \"roulette_start\" need \"engine\": \"mitsuba\"");
    require(is_command == curve.contains("command"),
            "expected \"command\" together with \"engine\": \"command\"");
    require(!is_command || curve.contains("label"), "a command needs a \"label\", which names it");
    if (is_mitsuba) {
        other.variant = curve.value("variant", "llvm_ad_rgb");
        other.roulette_start = curve.value("roulette_start", 5u);  // Mitsuba's default
    }
    other.command = curve.value("command", std::vector<std::string>());
    return other;
}

CurveDescription parse_curve(const Json &curve, const std::string &location) {
    CurveDescription description;
    description.label = curve.value("label", "");
    if (curve.contains("engine")) {
        description.other = parse_other_renderer(curve, location);
    } else if (curve.contains("algorithm")) {
        try {
            description.settings = parse_render_settings(curve);
        } catch (const Error &error) {
            throw input_error(fmt::format("{}: {}", location, error.what()));
        }
    } else {
        throw input_error(fmt::format(
            "{}: expected an \"algorithm\" of this renderer or the \"engine\" of another one",
            location));
    }
    return description;
}

}  // namespace

void read_measured_scene(const DescriptionFile &file, const Json &size, MeasuredScene &scene) {
    scene.scene = file.resolve(file.json.at("scene"));
    scene.reference_folder = file.resolve(file.json.at("reference").at("folder"));
    file.json.at("reference").at("engine").get_to(scene.reference_engine);
    size.at(0).get_to(scene.width);
    size.at(1).get_to(scene.height);
    std::set<std::string> ids;
    const Json &curves = file.json.at("curves");
    for (size_t i = 0; i < curves.size(); ++i) {
        const std::string location = file.location(fmt::format("/curves/{}", i));
        scene.curves.push_back(parse_curve(curves.at(i), location));
        if (const std::string id = scene.curves.back().id(); !ids.insert(id).second) {
            throw input_error(
                fmt::format("{}: two curves have the id '{}'; change the algorithm, the settings "
                            "or the renderer of one",
                            location, id));
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

std::string file_name_of(const std::string &text) {
    std::string name;
    for (const char c : text) {
        const auto letter = static_cast<unsigned char>(c);
        name += std::isalnum(letter) != 0 ? static_cast<char>(std::tolower(letter)) : '_';
    }
    return name;
}

std::string CurveDescription::id() const {
    if (other) {
        return other->engine == "mitsuba"
                   ? fmt::format("mitsuba.{},roulette_start={}", other->variant,
                                 other->roulette_start)
                   : other->engine + (other->engine == "command" ? "." + file_name_of(label) : "");
    }
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
