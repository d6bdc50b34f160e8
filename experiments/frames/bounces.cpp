// SPDX-License-Identifier: MIT
// Samples per second by length of path, on the device and by Embree: thesis 4.4.3.
#include <fmt/format.h>

#include <nlohmann/json.hpp>

#include "experiments/document.h"
#include "experiments/frames/scenes.h"
#include "experiments/hierarchy/kinds.h"
#include "reference/renderer.h"
#include "renderer/pipeline/render_session.h"

namespace rtrays {

namespace {

/// Scattering events of 1, 4 and 8 bounces: the first hit is one.
constexpr uint32_t depths[] = {2, 5, 9};

/// What OptiX is replaced by: one kernel for whole paths, and another program.
constexpr const char *rivals[] = {"megakernel", "Embree reference"};

RenderSettings settings_for(const MeasurementSettings &measurement, const std::string &pipeline) {
    RenderSettings settings;
    settings.width = measurement.width;
    settings.height = measurement.height;
    settings.variance = false;
    settings.strategies = "explicit";
    settings.termination = "fixed";
    settings.max_depth = depths[0];
    settings.pipeline = pipeline;
    return settings;
}

ReferenceSettings reference_settings(const MeasurementSettings &measurement, const TimedScene &timed,
                                     uint32_t depth) {
    ReferenceSettings settings;
    settings.width = measurement.width;
    settings.height = measurement.height;
    settings.camera = static_cast<size_t>(timed.scene.active_camera());
    settings.strategies = Strategies::explicit_only;
    settings.max_depth = depth;
    settings.roulette = false;
    return settings;
}

/// One scene on the device, to be rendered at any depth.
class Bounces {
  public:
    Bounces(const std::string &name, const MeasurementSettings &settings, DeviceContext &device)
        : name_(name),
          settings_(settings),
          timed_(load_timed_scene(name, Surfaces::diffuse)),
          wavefront_(timed_.scene, settings_for(settings, "wavefront"), device),
          megakernel_(timed_.scene, settings_for(settings, "megakernel"), device) {}

    Json row() {
        Json at_depths = Json::array();
        for (const uint32_t depth : depths) {
            at_depths.push_back(at_depth(depth));
        }
        return {{"mesh", name_},
                {"procedural", timed_.is_procedural},
                {"surfaces", timed_.description},
                {"triangles", wavefront_.report().at("scene").at("triangles")},
                {"depths", at_depths}};
    }

  private:
    Json at_depth(uint32_t depth) {
        ReferenceRenderer reference(timed_.scene.arrays(), reference_settings(settings_, timed_, depth));
        Contest contest;
        add(contest, "wavefront", wavefront_, depth);
        add(contest, rivals[0], megakernel_, depth);
        const auto render_reference = [&, done = uint64_t{0}]() mutable {
            return time_of([&] { done = reference.render(done, done + settings_.spp); });
        };
        add(contest, rivals[1], render_reference);
        run_turns(contest, settings_.repetitions);

        const double samples =
            static_cast<double>(settings_.width) * settings_.height * static_cast<double>(settings_.spp);
        Json contestants = Json::array();
        for (const std::string &contestant : contest.names()) {
            const Interval seconds = contest.wall_seconds(contestant);
            contestants.push_back({{"name", contestant},
                                   {"Msamples_s", to_json(Interval{1e-6 * samples / seconds.value,
                                                                   1e-6 * samples / seconds.high,
                                                                   1e-6 * samples / seconds.low})},
                                   {"processor_ms", scaled(contest.processor_seconds(contestant), 1e3)}});
        }
        Json wavefront_over;
        for (const char *rival : rivals) {
            wavefront_over[rival] = to_json(contest.speed_over("wavefront", rival));
        }
        const RenderStats stats = wavefront_.stats();
        const ReferenceStats theirs = reference.stats();
        return {{"max_depth", depth},
                {"bounces", depth - 1},
                {"rays_per_sample", static_cast<double>(stats.rays) / samples},
                {"reference_rays_per_sample",
                 static_cast<double>(theirs.camera_rays + theirs.bounce_rays + theirs.shadow_rays) /
                     static_cast<double>(theirs.camera_rays)},
                {"turns", contest.turns()},
                {"foreign_load", contest.foreign_load()},
                {"wavefront_over", wavefront_over},
                {"contestants", contestants}};
    }

    void add(Contest &contest, const std::string &contestant, RenderSession &session, uint32_t depth) {
        add(contest, contestant, [this, &session, depth] {
            session.restart(1, depth);
            return time_of([&] { session.render(0, settings_.spp); });
        });
    }

    /// The first run touches all memory and is not counted.
    static void add(Contest &contest, const std::string &contestant, std::function<Seconds()> render) {
        render();
        contest.add(contestant, render);
    }

    std::string name_;
    MeasurementSettings settings_;
    TimedScene timed_;
    RenderSession wavefront_, megakernel_;
};

}  // namespace

MeasurementPlan plan_bounces(const MeasurementSettings &settings, DeviceContext &device) {
    MeasurementPlan plan;
    for (const std::string &scene : settings.scenes) {
        plan.tasks.push_back(
            {scene, [settings, scene, &device] { return Bounces(scene, settings, device).row(); }});
    }
    plan.summarise = [](const Json &rows) {
        // Geometric means over the scenes of the wavefront's speed over each rival's, by depth.
        Json means = Json::array();
        for (size_t i = 0; i < std::size(depths); ++i) {
            Json mean = {{"max_depth", depths[i]}};
            for (const char *rival : rivals) {
                double logarithms = 0;
                for (const Json &row : rows) {
                    logarithms += std::log(
                        row.at("depths").at(i).at("wavefront_over").at(rival).at("value").get<double>());
                }
                mean[rival] = std::exp(logarithms / static_cast<double>(std::max<size_t>(1, rows.size())));
            }
            means.push_back(mean);
        }
        return Json{{"wavefront_over", means}};
    };
    return plan;
}

}  // namespace rtrays
