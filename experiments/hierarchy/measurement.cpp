// SPDX-License-Identifier: MIT
#include "experiments/hierarchy/measurement.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <nlohmann/json.hpp>

#include "experiments/description.h"
#include "experiments/document.h"
#include "experiments/hierarchy/kinds.h"
#include "experiments/hierarchy/meshes.h"
#include "experiments/host.h"
#include "renderer/base/files.h"
#include "renderer/base/progress.h"

namespace rtrays {

namespace fs = std::filesystem;

namespace {

constexpr int measurement_schema_version = 1;

struct Kind {
    const char *name;
    const char *needs;  ///< a key of its profiles that others do not have
    MeasurementPlan (*plan)(const MeasurementSettings &, DeviceContext &);
};
constexpr Kind kinds[] = {{"bvh_animation", "frames", plan_bvh_animation},
                          {"bvh_build", "repetitions", plan_bvh_build},
                          {"ray_rates", "repetitions", plan_ray_rates},
                          {"traversal", "watertight_rays", plan_traversal}};

/// The kind that "measures" names. Throws `Error` (bad input) when the profile lacks what it needs.
const Kind &kind_of(const DescriptionFile &file, const std::string &profile) {
    const std::string measures = file.json.at("measures");
    const Kind &kind =
        *std::find_if(std::begin(kinds), std::end(kinds), [&](const Kind &k) { return k.name == measures; });
    if (!file.json.at("profiles").at(profile).contains(kind.needs)) {
        throw input_error(fmt::format("{}: missing key '{}': {} needs it",
                                      file.location("/profiles/" + profile), kind.needs, measures));
    }
    return kind;
}

/// Names of the meshes to measure; stand-ins for those that are not there go to `stand_ins`, those without
/// one to `absent`.
std::vector<std::string> present_meshes(const Json &description, const Json &wanted, Json &stand_ins,
                                        Json &absent) {
    std::vector<std::string> meshes;
    const Json replacements = description.value("stand_ins", Json::object());
    for (const Json &mesh : wanted) {
        const std::string name = mesh;
        if (has_measured_mesh(name)) {
            meshes.push_back(name);
        } else if (replacements.contains(name)) {
            meshes.push_back(replacements.at(name));
            stand_ins[meshes.back()] = name;
        } else {
            absent.push_back(name);
        }
    }
    return meshes;
}

MeasurementSettings settings_of(const Json &profile, const std::vector<std::string> &meshes) {
    MeasurementSettings settings;
    settings.repetitions = profile.value("repetitions", 0);
    settings.rays = profile.value("rays", size_t{0});
    settings.frames = profile.value("frames", 0);
    settings.watertight_rays = profile.value("watertight_rays", size_t{0});
    settings.meshes = meshes;
    return settings;
}

/// A row of an earlier call, or measured now and kept for a later one.
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
    const Json &profile = file.json.at("profiles").at(options.profile);
    const Kind &kind = kind_of(file, options.profile);
    const std::string name = file.json.at("name"), measures = file.json.at("measures");
    Json stand_ins = Json::object(), absent = Json::array();
    const std::vector<std::string> meshes =
        present_meshes(file.json, profile.at("meshes"), stand_ins, absent);
    if (options.dry_run) {
        fmt::print("{}, profile {}: {} on {}\n", name, options.profile, measures, fmt::join(meshes, ", "));
        return {};
    }
    const fs::path out = options.out.empty() ? fs::path(name + "." + options.profile) : options.out;
    const RunContext context;
    DeviceContext device(options.device);
    const std::string key = content_hash(content_hash(read_file("/proc/self/exe")) + file.text +
                                         options.profile + device.info().name + device.info().driver);
    const fs::path partial = out / ".partial" / key;
    std::error_code error;
    fs::create_directories(partial, error);
    if (error) {
        throw input_error(fmt::format("{}: cannot be created: {}", partial.string(), error.message()));
    }
    require_writable(out / "run.json");

    const MeasurementPlan plan = kind.plan(settings_of(profile, meshes), device);
    Progress progress(name, plan.tasks.size(), "meshes", options.quiet);
    Json rows = Json::array();
    for (const MeasurementTask &task : plan.tasks) {
        progress.update(rows.size());
        rows.push_back(row_of(task, partial));
    }
    progress.update(rows.size());
    const Json summary = plan.summarise(rows);
    if (!summary.value("passed", true)) {
        exit_code = ExitCode::regression;
    }
    Json experiment = file.json;
    experiment.erase("$schema");
    experiment.erase("profiles");
    experiment["profile"] = options.profile;
    experiment["settings"] = profile;
    const Json run = {{"schema_version", measurement_schema_version},
                      {"measures", measures},
                      {"experiment", experiment},
                      {"stand_ins", stand_ins},
                      {"absent", absent},
                      {"rows", rows},
                      {"summary", summary},
                      {"context", context.finish(device.info())}};
    write_file(out / "run.json", run.dump(1) + "\n");
    fs::remove_all(out / ".partial");
    return out;
}

Json scaled(const Interval &interval, double factor) {
    return to_json(Interval{factor * interval.value, factor * interval.low, factor * interval.high});
}

void run_turns(Contest &contest, int repetitions) {
    for (int turn = 0; turn < repetitions; ++turn) {
        if (interrupted()) {
            throw Error(ExitCode::interrupted, "interrupted; the same command continues");
        }
        contest.turn();
    }
}

}  // namespace rtrays
