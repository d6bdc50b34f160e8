// SPDX-License-Identifier: MIT
// Measures the effect of single settings: frames and builds with one setting changed, compared with
// the defaults.
#include <fmt/format.h>

#include <memory>
#include <nlohmann/json.hpp>

#include "experiments/harness/core/document.h"
#include "experiments/harness/kinds/measurements/plans.h"
#include "experiments/harness/models/timed_scenes.h"
#include "renderer/bvh/builder.h"
#include "renderer/session/render_session.h"

namespace rtrays {

namespace {

constexpr const char *defaults = "defaults";

/// Returns whether a setting changes the tree.
bool is_of_builder(const std::string &setting) {
    return setting.rfind("device.bvh_builder=", 0) == 0 ||
           setting.rfind("device.bvh_bins=", 0) == 0 || setting.rfind("device.bvh_axes=", 0) == 0;
}

/// Returns the defaults with a setting, NAME=VALUE, changed, or unchanged for `defaults`.
RenderSettings settings_for(const MeasurementSettings &measurement, const std::string &setting) {
    RenderSettings settings;
    settings.width = measurement.width;
    settings.height = measurement.height;
    settings.variance = false;
    if (setting != defaults) {
        apply_setting(settings, setting);
    }
    return settings;
}

BvhBuildParameters build_parameters(const RenderSettings &settings, const DeviceInfo &device) {
    BvhBuildParameters parameters = BvhBuildParameters::for_device(device);
    choose_builder(settings, parameters);
    return parameters;
}

/// Returns the resources of a session: sizes, launches and compile time.
Json facts(const RenderSession &session) {
    const Json report = session.report();
    uint64_t binary = 0, launches = 0;
    for (const Json &program : report.at("programs")) {
        binary += program.at("binary_bytes").get<uint64_t>();
    }
    for (const Json &stage : report.at("stages")) {
        launches += stage.at("launches").get<uint64_t>();
    }
    return {{"features", report.at("features").size()},
            {"binary_bytes", binary},
            {"bytes_per_path", report.at("bytes_per_path")},
            {"launches", launches},
            {"compile_ms", 1e3 * report.at("seconds").at("compile").get<double>()}};
}

/// Returns the names and times of a contest together with the known values of each contestant.
Json results(const Contest &contest, const std::vector<Json> &known) {
    Json entries = Json::array();
    const std::vector<std::string> names = contest.names();
    for (size_t i = 0; i < names.size(); ++i) {
        Json entry = known[i];
        entry["name"] = names[i];
        entry["wall_ms"] = scaled(contest.wall_seconds(names[i]), 1e3);
        entry["processor_ms"] = scaled(contest.processor_seconds(names[i]), 1e3);
        entry["speed_over_defaults"] = to_json(contest.speed_over(names[i], defaults));
        entries.push_back(entry);
    }
    return entries;
}

class Ablations {
  public:
    Ablations(const std::string &scene, const MeasurementSettings &settings, DeviceContext &device)
        : name_(scene),
          settings_(settings),
          device_(&device),
          timed_(load_timed_scene(scene, Surfaces::own)),
          frames_(clock_of(device.info())),
          builds_(clock_of(device.info())) {
        add(defaults);
        for (const std::string &setting : settings.settings) {
            add(setting);
        }
        input_ = std::make_unique<BvhInput>(device, timed_.scene.meshes().position,
                                            timed_.scene.meshes().triangle);
        add_build(defaults);
        for (const std::string &setting : settings.settings) {
            if (is_of_builder(setting)) {
                add_build(setting);
            }
        }
    }

    Json row() {
        run_turns(frames_, settings_.repetitions);
        run_turns(builds_, settings_.repetitions);
        return {{"mesh", name_},
                {"procedural", timed_.is_procedural},
                {"surfaces", timed_.description},
                {"triangles", timed_.scene.meshes().triangle.size()},
                {"turns", frames_.turns()},
                {"foreign_load", std::max(frames_.foreign_load(), builds_.foreign_load())},
                {"frames", results(frames_, known_frames_)},
                {"builds", results(builds_, known_builds_)}};
    }

  private:
    /// Adds frames with a setting. Every turn creates the session again; creation and first frame
    /// are not timed. Otherwise a session would keep its memory for all turns, and the sessions
    /// created first are up to 7 % slower than equal ones created later.
    void add(const std::string &setting) {
        const size_t place = known_frames_.size();
        known_frames_.emplace_back();
        frames_.add(setting, [this, setting, place] {
            RenderSession session(timed_.scene, settings_for(settings_, setting), *device_);
            session.render(0, settings_.spp);
            session.restart(1);
            const Seconds seconds = time_of([&] { session.render(0, settings_.spp); });
            if (known_frames_[place].is_null()) {  // the first turn compiles if the cache is empty
                known_frames_[place] = facts(session);
            }
            return seconds;
        });
    }

    /// Adds builds with a setting. The first build compiles the kernels and is not timed.
    void add_build(const std::string &setting) {
        builders_.push_back(std::make_unique<BvhBuilder>(
            *device_, build_parameters(settings_for(settings_, setting), device_->info())));
        BvhBuilder &builder = *builders_.back();
        const BvhReport report = builder.build(input_->positions, input_->indices).report();
        known_builds_.push_back({{"method", to_string(report.method)},
                                 {"sah", report.sah_cost},
                                 {"depth", report.depth},
                                 {"bytes_peak", report.bytes_peak}});
        builds_.add(setting, [this, &builder] {
            return time_of([&] { builder.build(input_->positions, input_->indices); });
        });
    }

    std::string name_;
    MeasurementSettings settings_;
    DeviceContext *device_;
    TimedScene timed_;
    std::unique_ptr<BvhInput> input_;
    std::vector<std::unique_ptr<BvhBuilder>> builders_;
    std::vector<Json> known_frames_, known_builds_;
    Contest frames_, builds_;
};

}  // namespace

MeasurementPlan plan_ablations(const MeasurementSettings &settings, DeviceContext &device) {
    MeasurementPlan plan;
    for (const std::string &scene : settings.scenes) {
        plan.tasks.push_back({scene, [settings, scene, &device] {
                                  return Ablations(scene, settings, device).row();
                              }});
    }
    plan.summarise = [](const Json &) { return Json::object(); };
    return plan;
}

}  // namespace rtrays
