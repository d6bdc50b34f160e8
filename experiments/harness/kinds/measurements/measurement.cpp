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

constexpr int measurement_schema_version = 1;

struct Kind {
    const char *name;
    std::vector<const char *> needs;  ///< required keys of its profiles
    MeasurementPlan (*plan)(const MeasurementSettings &, DeviceContext &);
};
const std::vector<Kind> &kinds() {
    static const std::vector<Kind> all = {
        {"ablations", {"scenes", "size", "settings", "repetitions"}, plan_ablations},
        {"bounces", {"scenes", "size", "repetitions"}, plan_bounces},
        {"bvh_animation", {"meshes", "rays", "frames"}, plan_bvh_animation},
        {"bvh_build", {"meshes", "rays", "repetitions"}, plan_bvh_build},
        {"frame_times", {"scenes", "size", "repetitions"}, plan_frame_times},
        {"ray_rates", {"meshes", "rays", "repetitions"}, plan_ray_rates},
        {"reference_agreement", {"references", "size", "spp"}, plan_reference_agreement},
        {"traversal", {"meshes", "rays", "watertight_rays"}, plan_traversal},
    };
    return all;
}

/// Returns the kind that "measures" names. Throws `Error` (bad input) if the profile lacks a
/// required key.
const Kind &kind_of(const DescriptionFile &file, const std::string &profile) {
    const std::string measures = file.json.at("measures");
    const Kind &kind = *std::find_if(kinds().begin(), kinds().end(),
                                     [&](const Kind &k) { return k.name == measures; });
    for (const char *key : kind.needs) {
        if (!file.profile(profile).contains(key)) {
            throw input_error(fmt::format("{}: missing key '{}', which {} requires",
                                          file.location("/profiles/" + profile), key, measures));
        }
    }
    return kind;
}

/// Returns the requested meshes or scenes that exist, and stand-ins for missing ones. Lists the
/// replaced names in `stand_ins`, and missing names without a stand-in in `absent`.
std::vector<std::string> present(const Json &wanted, bool (*has)(const std::string &),
                                 const Json &replacements, Json &stand_ins, Json &absent) {
    std::vector<std::string> names;
    for (const std::string name : wanted) {
        if (has(name)) {
            names.push_back(name);
        } else if (replacements.contains(name)) {
            names.push_back(replacements.at(name));
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
    settings.meshes =
        present(profile.value("meshes", none), has_measured_mesh, replacements, stand_ins, absent);
    settings.scenes =
        present(profile.value("scenes", none), has_timed_scene, replacements, stand_ins, absent);
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

/// Returns the stored row of an interrupted call, or measures and stores it.
Json row_of(const MeasurementTask &task, const fs::path &partial) {
    const fs::path file = partial / (task.id + ".json");
    if (fs::exists(file)) {
        return load_json(file);
    }
    Json row = task.measure();
    write_file(file, row.dump(1) + "\n");
    return row;
}

}  // namespace

bool is_measurement(const fs::path &experiment) {
    const Json json = load_json(experiment);
    return json.is_object() && json.contains("measures");
}

fs::path run_measurement(const RunOptions &options, ExitCode &exit_code) {
    const DescriptionFile file = load_description(options.experiment, "measurement.schema.json");
    const Json &profile = file.profile(options.profile);
    const Kind &kind = kind_of(file, options.profile);
    const std::string name = file.json.at("name"), measures = file.json.at("measures");
    Json stand_ins = Json::object(), absent = Json::array();
    const MeasurementSettings settings = settings_of(file.json, profile, stand_ins, absent);
    if (options.compile) {
        throw input_error(
            fmt::format("{}: --compile does not apply to measurements, which compile "
                        "their kernels themselves",
                        options.experiment.string()));
    }
    if (options.dry_run) {
        fmt::print("{}, profile {}: {} on {}{}{}\n", name, options.profile, measures,
                   fmt::join(settings.meshes, ", "), fmt::join(settings.scenes, ", "),
                   fmt::join(settings.references, ", "));
        return {};
    }
    const fs::path out = options.out.empty() ? fs::path(name + "." + options.profile) : options.out;
    const RunContext context;
    DeviceContext device(options.device, Binaries::keep);
    const std::string references =
        settings.references.empty() ? "" : read_file(references_manifest());
    const Resumption resumption(
        out, "run.json",
        file.of_profile(options.profile) + stand_ins.dump() + absent.dump() + references,
        device.info());
    const auto note_failure = [&](const Json &summary) {
        if (!summary.value("passed", true)) {
            exit_code = ExitCode::regression;
        }
    };
    if (const Json run = resumption.finished(); !run.is_null()) {
        note_failure(run.at("summary"));
        return out;
    }

    const MeasurementPlan plan = kind.plan(settings, device);
    Progress progress(name, plan.tasks.size(), "rows", options.quiet);
    Json rows = Json::array();
    for (const MeasurementTask &task : plan.tasks) {
        progress.update(rows.size());
        rows.push_back(row_of(task, resumption.parts()));
    }
    progress.update(rows.size());
    const Json summary = plan.summarise(rows);
    note_failure(summary);
    Json experiment = file.json;
    experiment.erase("$schema");
    experiment.erase("profiles");
    experiment["profile"] = options.profile;
    experiment["settings"] = profile;
    resumption.finish({{"schema_version", measurement_schema_version},
                       {"measures", measures},
                       {"experiment", experiment},
                       {"stand_ins", stand_ins},
                       {"absent", absent},
                       {"rows", rows},
                       {"summary", summary},
                       {"context", context.finish(device.info())}});
    return out;
}

Json scaled(const Interval &interval, double factor) {
    return to_json(
        Interval{factor * interval.value, factor * interval.low, factor * interval.high});
}

void run_turns(Contest &contest, int repetitions) {
    for (int turn = 0; turn < repetitions; ++turn) {
        if (interrupted()) {
            throw Error(ExitCode::interrupted, "interrupted; repeat the command to continue");
        }
        contest.turn();
    }
}

}  // namespace rtrays
