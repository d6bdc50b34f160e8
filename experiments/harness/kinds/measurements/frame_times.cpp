// SPDX-License-Identifier: MIT
// Times frames of path tracing by kind of ray and by stage (thesis, section 4.4.2).
#include <map>
#include <memory>
#include <nlohmann/json.hpp>

#include "experiments/harness/core/document.h"
#include "experiments/harness/kinds/measurements/plans.h"
#include "experiments/harness/models/timed_scenes.h"
#include "renderer/session/render_session.h"

namespace rtrays {

namespace {

RenderSettings settings_for(const MeasurementSettings &measurement) {
    RenderSettings settings;
    settings.width = measurement.width;
    settings.height = measurement.height;
    settings.variance = false;
    return settings;
}

RenderSettings explicit_paths(RenderSettings settings) {
    settings.strategies = PathStrategies::explicit_only;
    settings.termination = Termination::fixed;
    settings.max_depth = 1;
    return settings;
}

/// Device seconds of one frame by stage, and its numbers of rays.
struct Frame {
    std::map<std::string, double> stages;
    double nearest_rays, shadow_rays;

    explicit Frame(const Json &report)
        : nearest_rays(report.at("rays").at("nearest")),
          shadow_rays(report.at("rays").at("shadow")) {
        for (const Json &stage : report.at("stages")) {
            stages[stage.at("name")] += stage.at("seconds").get<double>();
        }
    }
    double of(const std::string &stage) const {
        const auto found = stages.find(stage);
        return found == stages.end() ? 0 : found->second;
    }
};

/// Returns the median of a value over the turns, in milliseconds, with its interval.
template <typename Value>
Json milliseconds(const std::vector<Frame> &frames, const Value &seconds) {
    std::vector<double> values;
    for (size_t turn = 0; turn < frames.size(); ++turn) {
        values.push_back(1e3 * seconds(turn));
    }
    return to_json(median_interval(values));
}

class FrameContest {
  public:
    FrameContest(const std::string &name, const MeasurementSettings &settings,
                 DeviceContext &device)
        : measured_(load_timed_scene(name, Surfaces::own)),
          name_(name),
          spp_(settings.spp),
          parts_(measured_.scene, explicit_paths(settings_for(settings)), device),
          whole_(measured_.scene, settings_for(settings), device) {
        add("direct light", parts_, direct_, 1);
        add("one bounce", parts_, bounce_, 2);
        add("frame", whole_, frames_, 0);
    }

    Contest &contest() { return contest_; }

    Json row() const {
        const Frame &direct = direct_.front(), &bounce = bounce_.front(), &frame = frames_.front();
        const Json report = whole_.report();
        Json stages = Json::array();
        for (const auto &[stage, seconds] : frame.stages) {
            stages.push_back({{"name", stage}, {"ms", milliseconds(frames_, [&](size_t turn) {
                                                    return frames_[turn].of(stage);
                                                })}});
        }
        return {
            {"mesh", name_},
            {"procedural", measured_.is_procedural},
            {"surfaces", measured_.description},
            {"triangles", report.at("scene").at("triangles")},
            {"turns", contest_.turns()},
            {"foreign_load", contest_.foreign_load()},
            {"bvh_ms", 1e3 * report.at("seconds").at("bvh_wall").get<double>()},
            {"compile_ms", 1e3 * report.at("seconds").at("compile").get<double>()},
            {"rays",
             {{"primary", direct.nearest_rays},
              {"shadow", direct.shadow_rays},
              {"secondary", bounce.nearest_rays - direct.nearest_rays},
              {"frame", frame.nearest_rays + frame.shadow_rays}}},
            {"primary_ms",
             milliseconds(direct_,
                          [&](size_t turn) { return direct_[turn].of("intersect_nearest"); })},
            {"shadow_ms",
             milliseconds(direct_, [&](size_t turn) { return direct_[turn].of("intersect_any"); })},
            {"secondary_ms", milliseconds(bounce_,
                                          [&](size_t turn) {
                                              return bounce_[turn].of("intersect_nearest") -
                                                     direct_[turn].of("intersect_nearest");
                                          })},
            {"frame_ms", scaled(contest_.wall_seconds("frame"), 1e3)},
            {"frame_processor_ms", scaled(contest_.processor_seconds("frame"), 1e3)},
            {"stages", stages}};
    }

  private:
    /// Adds a contestant. Its first frame touches all memory and is discarded.
    void add(const std::string &contestant, RenderSession &session, std::vector<Frame> &frames,
             uint32_t max_depth) {
        const auto render = [this, &session, max_depth] {
            max_depth > 0 ? session.restart(1, max_depth) : session.restart(1);
            return time_of([&] { session.render(0, spp_); });
        };
        render();
        contest_.add(contestant, [render, &session, &frames] {
            const Seconds seconds = render();
            frames.emplace_back(session.report());
            return seconds;
        });
    }

    TimedScene measured_;
    std::string name_;
    uint64_t spp_;
    RenderSession parts_, whole_;
    std::vector<Frame> direct_, bounce_, frames_;
    Contest contest_;
};

}  // namespace

MeasurementPlan plan_frame_times(const MeasurementSettings &settings, DeviceContext &device) {
    MeasurementPlan plan;
    for (const std::string &scene : settings.scenes) {
        plan.tasks.push_back({scene, [settings, scene, &device] {
                                  FrameContest contest(scene, settings, device);
                                  run_turns(contest.contest(), settings.repetitions);
                                  return contest.row();
                              }});
    }
    plan.summarise = [](const Json &) { return Json::object(); };
    return plan;
}

}  // namespace rtrays
