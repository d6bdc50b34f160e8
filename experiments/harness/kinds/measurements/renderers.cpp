// SPDX-License-Identifier: MIT
// Measures error and time of images by this renderer and by others.
#include <fmt/format.h>
#include <unistd.h>

#include <filesystem>
#include <map>
#include <memory>
#include <nlohmann/json.hpp>

#include "experiments/harness/core/description.h"
#include "experiments/harness/core/document.h"
#include "experiments/harness/core/references.h"
#include "experiments/harness/core/rendering.h"
#include "experiments/harness/kinds/measurements/peer.h"
#include "experiments/harness/kinds/measurements/plans.h"
#include "renderer/base/resources.h"
#include "renderer/import/load_scene.h"
#include "renderer/session/shared_scenes.h"

namespace rtrays {

namespace {

namespace fs = std::filesystem;

/// Settings of this renderer that take part. The first is comparable with Mitsuba: independent
/// samples, and roulette from the first event.
std::vector<RenderSettings> own_settings(int width, int height) {
    const Json sobol = {{"integrator.sampler", "sobol"}};
    const Json automatic = {{"integrator.sampler", "sobol"},
                            {"integrator.light_paths", "auto"},
                            {"integrator.guided_emission", "trained"},
                            {"integrator.guided_scattering", "trained"}};
    const std::pair<const Algorithm *, Json> chosen[] = {
        {&algorithms::path_tracing, Json::object()},
        {&algorithms::path_tracing, sobol},
        {&algorithms::truncated_bdpt, automatic}};
    std::vector<RenderSettings> all;
    for (const auto &[algorithm, named] : chosen) {
        RenderSettings &settings = all.emplace_back();
        settings.algorithm = algorithm;
        settings.width = width;
        settings.height = height;
        settings.variance = false;
        apply_settings(settings, named);
    }
    return all;
}

/// First events of roulette with which a renderer takes part: that of the thesis and Mitsuba's
/// default. Cycles has its own.
std::vector<uint32_t> roulettes_of(const std::string &kind) {
    return kind == "cycles" ? std::vector<uint32_t>{1} : std::vector<uint32_t>{1, 5};
}

/// Contest of all renderers on one scene.
class SceneContest {
  public:
    SceneContest(const std::string &name, const MeasurementSettings &settings,
                 DeviceContext &device)
        : name_(name),
          settings_(settings),
          scene_(load_scene((resource_folder() / "scenes" / name / "scene.json").string())),
          folder_(fs::temp_directory_path() / fmt::format("rtrays-renderers-{}", getpid())),
          contest_(clock_of(device.info())) {
        scene_.update(0);
        stored_ = load_reference({resource_folder() / "results/references", name, scene_.hash(),
                                  "embree", settings.width, settings.height, name});
        scene_.set_film_size(settings.width, settings.height);
        fs::create_directories(folder_);
        SharedScenes scenes(scene_, device);
        for (const RenderSettings &own : own_settings(settings.width, settings.height)) {
            add_own(own, scenes);
        }
        for (const std::string &kind : settings.peers) {
            add_peer(kind);
        }
    }
    SceneContest(const SceneContest &) = delete;
    SceneContest &operator=(const SceneContest &) = delete;
    ~SceneContest() { fs::remove_all(folder_); }

    Json row() {
        run_turns(contest_, settings_.repetitions);
        const double samples = static_cast<double>(settings_.width) * settings_.height *
                               static_cast<double>(settings_.spp);
        for (Json &contestant : contestants_) {
            const Interval seconds = contest_.wall_seconds(contestant.at("name"));
            contestant["Msamples_s"] =
                to_json(Interval{1e-6 * samples / seconds.value, 1e-6 * samples / seconds.high,
                                 1e-6 * samples / seconds.low});
            contestant["turns"] = turns_[contestant.at("name")];
        }
        return {{"scene", name_},
                {"absent_peers", absent_peers_},
                {"foreign_load", contest_.foreign_load()},
                {"contestants", contestants_}};
    }

  private:
    /// Keeps duration and error of a turn.
    void keep(const std::string &name, const Seconds &seconds, const Image &image) {
        const double mse = unbiased_mse(compute_metrics(image, stored_.reference.image).mse,
                                        stored_.reference.noise_mse);
        turns_[name].push_back({{"seconds_wall", seconds.wall},
                                {"seconds_processor", seconds.processor},
                                {"mse", mse}});
    }

    void add_own(const RenderSettings &settings, SharedScenes &scenes) {
        auto session = std::make_shared<RenderSession>(scenes.session(settings));
        session->render(0, settings_.spp);  // touches all memory
        const std::string name = CurveDescription{settings}.id();
        contestants_.push_back({{"name", name},
                                {"is_ours", true},
                                {"algorithm", settings.algorithm->name},
                                {"settings", image_settings(session->settings())}});
        contest_.add(name, [this, session, name, seed = uint32_t{0}]() mutable {
            session->restart(++seed);
            const Seconds render = time_of([&] { render_whole(*session, 0, settings_.spp); });
            // The pilot keeps all processors as busy as the render.
            const Json report = session->report();
            const double pilot =
                report.contains("pilot") ? report.at("pilot").at("seconds_wall").get<double>() : 0;
            const double factor = 1 + pilot / render.wall;
            const Seconds whole{factor * render.wall, factor * render.processor};
            keep(name, whole, session->develop());
            return whole;
        });
    }

    void add_peer(const std::string &kind) {
        auto peer = std::make_shared<Peer>(scene_, folder_, kind);
        if (!peer->is_there()) {
            absent_peers_.push_back(Peer::name_of(kind));
            return;
        }
        for (const uint32_t roulette : roulettes_of(kind)) {
            const PeerFrame frame{0, settings_.spp, roulette, folder_ / (kind + ".exr")};
            peer->render(frame);  // compiles its kernels
            const std::string name = kind == "cycles" ? peer->engine()
                                                      : fmt::format("{}, roulette from event {}",
                                                                    peer->engine(), roulette);
            contestants_.push_back({{"name", name}, {"is_ours", false}, {"roulette", roulette}});
            contest_.add(name, [this, peer, frame, name] {
                const Seconds seconds = peer->render(frame);
                keep(name, seconds, read_exr(frame.image));
                return seconds;
            });
        }
    }

    std::string name_;
    MeasurementSettings settings_;
    Scene scene_;
    fs::path folder_;
    Contest contest_;
    StoredReference stored_;
    std::map<std::string, Json> turns_;
    Json contestants_ = Json::array(), absent_peers_ = Json::array();
};

}  // namespace

MeasurementPlan plan_renderers(const MeasurementSettings &settings, DeviceContext &device) {
    MeasurementPlan plan;
    for (const std::string &scene : settings.references) {
        plan.tasks.push_back({scene, [settings, scene, &device] {
                                  return SceneContest(scene, settings, device).row();
                              }});
    }
    plan.summarise = [](const Json &) { return Json::object(); };
    return plan;
}

}  // namespace rtrays
