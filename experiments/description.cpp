// SPDX-License-Identifier: MIT
#include "experiments/description.h"

#include <fmt/format.h>

#include <set>

#include "embedded/experiment_schemas.h"
#include "renderer/base/error.h"
#include "renderer/base/files.h"

namespace rtrays {

namespace {

void check_description(const ExperimentDescription &experiment, const std::string &source) {
    for (size_t i = 1; i < experiment.spp.size(); ++i) {
        if (experiment.spp[i] <= experiment.spp[i - 1]) {
            throw input_error(fmt::format("{}: profile {}: \"spp\" must increase; {} follows {}", source,
                                          experiment.profile, experiment.spp[i], experiment.spp[i - 1]));
        }
    }
    std::set<std::string> ids;
    for (const auto &curve : experiment.curves) {
        if (!ids.insert(curve.id()).second) {
            throw input_error(fmt::format("{}: two curves are both {}", source, curve.id()));
        }
    }
}

}  // namespace

RenderSettings parse_render_settings(const Json &curve) {
    RenderSettings settings;
    settings.algorithm = curve.at("algorithm").get<std::string>();
    if (curve.contains("settings")) {
        for (const auto &[name, value] : curve.at("settings").items()) {
            apply_setting(settings,
                          name + "=" + (value.is_string() ? value.get<std::string>() : value.dump()));
        }
    }
    require_consistent(settings);
    return settings;
}

ExperimentDescription load_experiment(const std::filesystem::path &path, const std::string &profile) {
    const std::string source = path.string(), text = read_file(path);
    const Json json = parse_json(text, source);
    validate_json(json, std::string(embedded::experiment_schemas().text("experiment.schema.json")), source,
                  text);
    if (!json.at("profiles").contains(profile)) {
        throw input_error(
            fmt::format("{}: there is no profile '{}'; there are: quick, full, ci", source, profile));
    }

    const auto folder = path.parent_path();
    const Json &chosen = json.at("profiles").at(profile);
    ExperimentDescription experiment;
    json.at("name").get_to(experiment.name);
    json.at("title").get_to(experiment.title);
    json.at("thesis").get_to(experiment.thesis);
    json.at("claim").get_to(experiment.claim);
    json.at("expected_slope").at("value").get_to(experiment.expected_slope);
    json.at("expected_slope").at("tolerance").get_to(experiment.slope_tolerance);
    experiment.scene = (folder / json.at("scene").get<std::string>()).lexically_normal();
    experiment.reference_folder =
        (folder / json.at("reference").at("folder").get<std::string>()).lexically_normal();
    json.at("reference").at("engine").get_to(experiment.reference_engine);
    for (const Json &curve : json.at("curves")) {
        experiment.curves.push_back({parse_render_settings(curve)});
    }
    experiment.profile = profile;
    chosen.at("size").at(0).get_to(experiment.width);
    chosen.at("size").at(1).get_to(experiment.height);
    chosen.at("spp").get_to(experiment.spp);
    chosen.at("seeds").get_to(experiment.seeds);
    chosen.at("throughput").at("repetitions").get_to(experiment.throughput.repetitions);
    chosen.at("throughput").at("spp").get_to(experiment.throughput.spp);
    experiment.source = json;
    check_description(experiment, source);
    return experiment;
}

}  // namespace rtrays
