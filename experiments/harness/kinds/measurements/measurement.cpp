// SPDX-License-Identifier: MIT
#include "experiments/harness/kinds/measurements/measurement.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <nlohmann/json.hpp>

#include "experiments/harness/core/description.h"
#include "experiments/harness/core/document.h"
#include "experiments/harness/core/host.h"
#include "experiments/harness/core/resumption.h"
#include "experiments/harness/kinds/measurements/plans.h"
#include "experiments/harness/models/meshes.h"
#include "experiments/harness/models/timed_scenes.h"
#include "renderer/base/files.h"
#include "renderer/base/progress.h"

namespace rtrays {

namespace fs = std::filesystem;

namespace {

struct Measure {
    const char *name;
    std::vector<const char *> needs;  ///< required keys of its profiles
    MeasurementPlan (*plan)(const MeasurementSettings &, DeviceContext &);
    std::optional<bool> (*passes)(const Json &row) = [](const Json &) -> std::optional<bool> {
        return std::nullopt;
    };
};
const std::vector<Measure> &measures() {
    static const std::vector<Measure> all = {
        {"ablations", {"scenes", "size", "settings", "repetitions"}, plan_ablations},
        {"bounces", {"scenes", "size", "repetitions"}, plan_bounces},
        {"bvh_animation", {"meshes", "rays", "frames"}, plan_bvh_animation},
        {"bvh_build", {"meshes", "rays", "repetitions"}, plan_bvh_build},
        {"frame_times", {"scenes", "size", "repetitions"}, plan_frame_times},
        {"ray_rates", {"meshes", "rays", "repetitions"}, plan_ray_rates},
        {"reference_agreement", {"references", "size", "spp"}, plan_reference_agreement},
        {"renderers", {"references", "size", "spp", "repetitions"}, plan_renderers},
        {"traversal", {"meshes", "rays", "watertight_rays"}, plan_traversal, traversal_passes},
    };
    return all;
}

/// Returns the measure that "kind" names. Throws `Error` (bad input) if the profile lacks a
/// required key.
const Measure &measure_of(const DescriptionFile &file, const std::string &profile) {
    const std::string kind = file.json.at("kind");
    const Measure &measure = *std::find_if(measures().begin(), measures().end(),
                                           [&](const Measure &m) { return m.name == kind; });
    for (const char *key : measure.needs) {
        if (!file.profile(profile).contains(key)) {
            throw input_error(fmt::format("{}: missing key '{}', which {} requires",
                                          file.location("/profiles/" + profile), key, kind));
        }
    }
    return measure;
}

/// Functions of a table of meshes or scenes.
struct Table {
    void (*require_name)(const std::string &);  ///< throws for an unknown name
    bool (*is_present)(const std::string &);
};

/// Returns the requested meshes or scenes that exist, and stand-ins for missing ones. Lists the
/// replaced names in `stand_ins`, and missing names without a stand-in in `absent`.
std::vector<std::string> present(const Json &wanted, const Table &table, const Json &replacements,
                                 Json &stand_ins, Json &absent) {
    std::vector<std::string> names;
    for (const std::string name : wanted) {
        table.require_name(name);
        if (table.is_present(name)) {
            names.push_back(name);
        } else if (replacements.contains(name)) {
            names.push_back(replacements.at(name));
            table.require_name(names.back());
            stand_ins[names.back()] = name;
        } else {
            absent.push_back(name);
        }
    }
    return names;
}

MeasurementSettings settings_of(const Json &description, const Json &profile, Json &stand_ins,
                                Json &absent) {
    const Json replacements = description.value("stand_ins", Json::object()), none = Json::array();
    MeasurementSettings settings;
    settings.repetitions = profile.value("repetitions", 0);
    settings.rays = profile.value("rays", size_t{0});
    settings.frames = profile.value("frames", 0);
    settings.watertight_rays = profile.value("watertight_rays", size_t{0});
    settings.meshes = present(profile.value("meshes", none), {require_mesh_name, has_measured_mesh},
                              replacements, stand_ins, absent);
    settings.scenes = present(profile.value("scenes", none), {require_scene_name, has_timed_scene},
                              replacements, stand_ins, absent);
    settings.references = profile.value("references", std::vector<std::string>());
    settings.probes = profile.value("probes", std::vector<std::string>());
    settings.probe_spp = profile.value("probe_spp", uint64_t{0});
    const Json size = profile.value("size", Json{0, 0});
    settings.width = size.at(0);
    settings.height = size.at(1);
    settings.spp = profile.value("spp", uint64_t{1});
    settings.peers = profile.value("peers", std::vector<std::string>());
    settings.settings = profile.value("settings", std::vector<std::string>());
    return settings;
}

class MeasurementExperiment : public Experiment {
  public:
    MeasurementExperiment(const DescriptionFile &file, const RunOptions &options)
        : measure_(measure_of(file, options.profile)),
          experiment_(file.json),
          settings_(settings_of(file.json, file.profile(options.profile), stand_ins_, absent_)),
          inputs_(file.of_profile(options.profile)) {
        experiment_.erase("$schema");
        experiment_.erase("kind");
        experiment_.erase("profiles");
        experiment_["profile"] = options.profile;
        experiment_["settings"] = file.profile(options.profile);
    }

    std::string plan() const override {
        return fmt::format("{}, profile {}: {} on {}{}{}\n",
                           experiment_.at("name").get<std::string>(),
                           experiment_.at("profile").get<std::string>(), measure_.name,
                           fmt::join(settings_.meshes, ", "), fmt::join(settings_.scenes, ", "),
                           fmt::join(settings_.references, ", "));
    }

    std::string inputs() const override {
        return inputs_ + stand_ins_.dump() + absent_.dump() +
               (settings_.references.empty() ? "" : read_file(references_manifest()));
    }

    Json measure(const Bench &bench) const override {
        const MeasurementPlan plan = measure_.plan(settings_, bench.device);
        Progress progress(experiment_.at("name"), plan.tasks.size(), "rows", bench.quiet);
        Json rows = Json::array();
        for (const MeasurementTask &task : plan.tasks) {
            progress.update(rows.size());
            rows.push_back(finished_part(bench.parts / (task.id + ".json"), task.measure));
        }
        progress.update(rows.size());
        return {{"experiment", experiment_},
                {"stand_ins", stand_ins_},
                {"absent", absent_},
                {"rows", rows},
                {"summary", plan.summarise(rows)}};
    }

    std::optional<bool> passes(const Json &row) const override { return measure_.passes(row); }

  private:
    const Measure &measure_;
    Json experiment_;
    Json stand_ins_ = Json::object(), absent_ = Json::array();
    MeasurementSettings settings_;
    std::string inputs_;
};

}  // namespace

std::unique_ptr<Experiment> make_measurement(const DescriptionFile &file,
                                             const RunOptions &options) {
    return std::make_unique<MeasurementExperiment>(file, options);
}

Json scaled(const Interval &interval, double factor) {
    return to_json(
        Interval{factor * interval.value, factor * interval.low, factor * interval.high});
}

void run_turns(Contest &contest, int repetitions) {
    for (int turn = 0; turn < repetitions; ++turn) {
        require_not_interrupted();
        contest.turn();
    }
}

}  // namespace rtrays
