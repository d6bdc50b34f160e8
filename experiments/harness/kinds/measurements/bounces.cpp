// SPDX-License-Identifier: MIT
// Measures samples per second by path length, on the device and with other renderers (thesis,
// section 4.4.3).
#include <fmt/format.h>
#include <unistd.h>

#include <array>
#include <cmath>
#include <filesystem>
#include <memory>
#include <nlohmann/json.hpp>

#include "experiments/harness/core/document.h"
#include "experiments/harness/kinds/measurements/peer.h"
#include "experiments/harness/kinds/measurements/plans.h"
#include "experiments/harness/models/timed_scenes.h"
#include "reference/renderer.h"
#include "renderer/session/render_session.h"

namespace rtrays {

namespace {

namespace fs = std::filesystem;

/// Numbers of scattering events for 1, 4 and 8 bounces. The first hit counts as an event.
constexpr uint32_t depths[] = {2, 5, 9};

constexpr const char *ours = name_in(pipelines, Pipeline::wavefront),
                     *megakernel = name_in(pipelines, Pipeline::megakernel),
                     *embree = "Embree reference";

RenderSettings settings_for(const MeasurementSettings &measurement, Pipeline pipeline) {
    RenderSettings settings;
    settings.width = measurement.width;
    settings.height = measurement.height;
    settings.variance = false;
    settings.strategies = PathStrategies::explicit_only;
    settings.termination = Termination::fixed;
    settings.max_depth = depths[0];
    settings.pipeline = pipeline;
    return settings;
}

ReferenceSettings reference_settings(const MeasurementSettings &measurement,
                                     const TimedScene &timed, uint32_t depth) {
    ReferenceSettings settings;
    settings.width = measurement.width;
    settings.height = measurement.height;
    settings.camera = static_cast<size_t>(timed.scene.active_camera());
    settings.strategies = Strategies::explicit_only;
    settings.max_depth = depth;
    settings.roulette = false;
    return settings;
}

/// Measurement of one scene at all depths.
class Bounces {
  public:
    Bounces(const std::string &name, const MeasurementSettings &settings, DeviceContext &device)
        : name_(name),
          settings_(settings),
          device_(&device),
          timed_(load_timed_scene(name, Surfaces::diffuse)) {
        load_peers();
    }

    Json row() {
        Json at_depths = Json::array();
        for (const uint32_t depth : depths) {
            at_depths.push_back(at_depth(depth));
        }
        return {{"mesh", name_},
                {"procedural", timed_.is_procedural},
                {"surfaces", timed_.description},
                {"triangles", timed_.scene.meshes().triangle.size()},
                {"absent_peers", absent_peers_},
                {"depths", at_depths}};
    }

  private:
    /// Starts the other renderers, each in its own process, and lists the missing ones.
    void load_peers() {
        if (settings_.peers.empty()) {
            return;
        }
        timed_.scene.set_film_size(settings_.width, settings_.height);
        const fs::path folder =
            fs::temp_directory_path() / fmt::format("rtrays-bounces-{}", getpid());
        fs::create_directories(folder);
        for (const std::string &kind : settings_.peers) {
            auto peer = std::make_unique<Peer>(timed_.scene, folder, kind);
            if (peer->is_there()) {
                peers_.push_back(std::move(peer));
            } else {
                absent_peers_.push_back(Peer::name_of(kind));
            }
        }
        fs::remove_all(folder);
    }

    Json at_depth(uint32_t depth) {
        ReferenceRenderer reference(timed_.scene.arrays(),
                                    reference_settings(settings_, timed_, depth));
        Contest contest(clock_of(device_->info()));
        add(contest, ours, wavefront_, depth);
        add(contest, megakernel, megakernel_, depth);
        uint64_t done = reference.render(0, settings_.spp);
        contest.add(embree, [&] {
            return time_of([&] { done = reference.render(done, done + settings_.spp); });
        });
        for (const std::unique_ptr<Peer> &peer : peers_) {
            peer->render({depth, settings_.spp});  // compiles its kernels
            contest.add(peer->engine(), [&, depth] {
                return peer->render({depth, settings_.spp});
            });
        }
        make_sessions({&wavefront_, &megakernel_});
        run_turns(contest, settings_.repetitions / 2);
        make_sessions({&megakernel_, &wavefront_});
        run_turns(contest, settings_.repetitions - settings_.repetitions / 2);

        const double samples = static_cast<double>(settings_.width) * settings_.height *
                               static_cast<double>(settings_.spp);
        Json contestants = Json::array();
        for (const std::string &contestant : contest.names()) {
            const Interval seconds = contest.wall_seconds(contestant);
            contestants.push_back(
                {{"name", contestant},
                 {"Msamples_s",
                  to_json(Interval{1e-6 * samples / seconds.value, 1e-6 * samples / seconds.high,
                                   1e-6 * samples / seconds.low})},
                 {"processor_ms", scaled(contest.processor_seconds(contestant), 1e3)}});
        }
        Json wavefront_over = Json::object();
        for (const std::string &rival : contest.names()) {
            if (rival != ours) {
                wavefront_over[rival] = to_json(contest.speed_over(ours, rival));
            }
        }
        const RenderStats stats = wavefront_.session->stats();
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

    struct Timed {
        Pipeline pipeline;
        std::unique_ptr<RenderSession> session{};
    };

    /// Creates the sessions in the given order. The session created first is up to 7 % slower
    /// because of the memory it gets, so each half of the turns uses another order. The first frame
    /// touches all memory and is not timed.
    void make_sessions(const std::array<Timed *, 2> &order) {
        for (Timed *timed : order) {
            timed->session.reset();
        }
        for (Timed *timed : order) {
            timed->session = std::make_unique<RenderSession>(
                timed_.scene, settings_for(settings_, timed->pipeline), *device_);
            timed->session->render(0, settings_.spp);
        }
    }

    void add(Contest &contest, const std::string &contestant, Timed &timed, uint32_t depth) {
        contest.add(contestant, [this, &timed, depth] {
            timed.session->restart(1, depth);
            return time_of([&] { timed.session->render(0, settings_.spp); });
        });
    }

    std::string name_;
    MeasurementSettings settings_;
    DeviceContext *device_;
    TimedScene timed_;
    Timed wavefront_{Pipeline::wavefront}, megakernel_{Pipeline::megakernel};
    std::vector<std::unique_ptr<Peer>> peers_;
    Json absent_peers_ = Json::array();
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
        for (size_t i = 0; i < std::size(depths) && !rows.empty(); ++i) {
            Json mean = {{"max_depth", depths[i]}};
            for (const auto &[rival, first] :
                 rows.at(0).at("depths").at(i).at("wavefront_over").items()) {
                double logarithms = 0;
                for (const Json &row : rows) {
                    const Json &speed = row.at("depths").at(i).at("wavefront_over").at(rival);
                    logarithms += std::log(speed.at("value").get<double>());
                }
                mean[rival] = std::exp(logarithms / static_cast<double>(rows.size()));
            }
            means.push_back(mean);
        }
        return Json{{"wavefront_over", means}};
    };
    return plan;
}

}  // namespace rtrays
