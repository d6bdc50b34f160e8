// SPDX-License-Identifier: MIT
// Compares references of other renderers, the Embree reference and RTRays' own image pair by pair.
// Probe scenes show why renderers differ.
#include <fmt/format.h>
#include <unistd.h>

#include <cmath>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <string>
#include <utility>
#include <vector>

#include "experiments/harness/core/agreement.h"
#include "experiments/harness/core/document.h"
#include "experiments/harness/core/metrics.h"
#include "experiments/harness/core/references.h"
#include "experiments/harness/core/rendering.h"
#include "experiments/harness/kinds/measurements/plans.h"
#include "reference/peer.h"
#include "reference/renderer.h"
#include "renderer/base/error.h"
#include "renderer/base/resources.h"
#include "renderer/import/load_scene.h"
#include "renderer/session/render_session.h"

namespace rtrays {

namespace {

namespace fs = std::filesystem;

constexpr const char *engines[] = {"embree", "mitsuba", "cycles"};

/// An image with the renderer that made it.
struct Contender {
    /// {"name", "engine", "spp", "noise_rmse"}, and "mean" and "standard_error" if it was rendered
    /// by this measurement.
    Json description;
    Halves halves;
};

/// Describes an image from its variance layers, assuming independent pixels. The standard error of
/// the mean over channels is bounded by the mean of the channels' standard errors.
Contender described(const char *name, const std::string &engine, uint64_t spp, Halves halves) {
    const Image image = average_images({halves[0], halves[1]});
    double mean = 0, variance = 0, standard_error = 0;
    const double values = 3.0 * static_cast<double>(image.pixel_count());
    for (size_t c = 0; c < 3; ++c) {
        double of_channel = 0;
        for (const float value : image.channel(rgb_names("variance")[c])) {
            of_channel += static_cast<double>(value);
        }
        for (const float value : image.channel(rgb_names()[c])) {
            mean += static_cast<double>(value) / values;
        }
        variance += of_channel;
        standard_error += std::sqrt(of_channel) / values;
    }
    return {{{"name", name},
             {"engine", engine},
             {"spp", spp},
             {"noise_rmse", std::sqrt(variance / values)},
             {"mean", mean},
             {"standard_error", standard_error}},
            std::move(halves)};
}

/// Renders two halves with different seeds by `render(seed)`. Scenes with different values of
/// `number`, from 0, share no seed.
template <class Render>
Halves in_halves(uint32_t number, const Render &render) {
    return {render(2 * number + 1), render(2 * number + 2)};
}

Contender rendered(const Scene &scene, uint64_t spp, uint32_t number, DeviceContext &device) {
    RenderSettings settings;
    settings.width = scene.film_width();
    settings.height = scene.film_height();
    RenderSession session(scene, settings, device);
    const auto render = [&](uint32_t seed) {
        session.restart(seed);
        render_whole(session, 0, spp / 2);
        return session.develop();
    };
    return described("renderer", "RTRays, path tracing (MIS)", spp / 2 * 2,
                     in_halves(number, render));
}

/// Images of a scene, and the renderers without one.
struct Contenders {
    std::vector<Contender> there;
    Json absent = Json::array();

    /// Tests all pairs and returns the row.
    Json row(const char *kind, const std::string &name) const {
        const AgreementPolicy policy;
        Json descriptions = Json::array(), pairs = Json::array();
        for (size_t i = 0; i < there.size(); ++i) {
            descriptions.push_back(there[i].description);
            for (size_t j = 0; j < i; ++j) {
                pairs.push_back(
                    {{"image", there[i].description.at("name")},
                     {"against", there[j].description.at("name")},
                     {"agreement",
                      to_json(test_agreement(there[i].halves, there[j].halves, policy), policy)}});
            }
        }
        return {{kind, name}, {"renderers", descriptions}, {"absent", absent}, {"pairs", pairs}};
    }
};

Json row_of_scene(const std::string &name, const MeasurementSettings &wanted, uint32_t number,
                  DeviceContext &device) {
    const fs::path path = resource_folder() / "scenes" / name / "scene.json";
    Scene scene = load_scene(path.string());
    Contenders contenders;
    for (const char *engine : engines) {
        try {
            StoredReference stored =
                load_reference({references_manifest().parent_path(), scene.name(), scene.hash(),
                                engine, wanted.width, wanted.height, path.string()});
            contenders.there.push_back(
                {{{"name", engine},
                  {"engine", stored.description.at("engine")},
                  {"spp", stored.description.at("spp")},
                  {"noise_rmse", stored.description.at("noise_floor").at("rmse")}},
                 std::move(stored.halves)});
        } catch (const Error &error) {
            if (error.exit_code() != ExitCode::reference_missing) {
                throw;
            }
            contenders.absent.push_back(engine);
        }
    }
    scene.set_film_size(wanted.width, wanted.height);
    contenders.there.push_back(rendered(scene, wanted.spp, number, device));
    return contenders.row("scene", name);
}

Contender rendered_by_embree(const Scene &scene, ReferenceSettings settings, uint64_t spp) {
    std::string engine;
    const auto render = [&](uint32_t seed) {
        settings.seed = seed;
        ReferenceRenderer renderer(scene.arrays(), settings);
        render_whole(renderer, 0, spp / 2);
        engine = renderer.stats().engine;
        return renderer.develop();
    };
    Halves halves = in_halves(0, render);
    return described("embree", engine, spp / 2 * 2, std::move(halves));
}

/// Renders with a peer. The samples of a half are rounded up to full steps.
Contender rendered_by_peer(const Scene &scene, ReferenceSettings settings, const char *name,
                           uint64_t spp) {
    const fs::path folder = fs::temp_directory_path() / fmt::format("rtrays-probe-{}", getpid());
    std::string engine;
    uint64_t samples = 0;
    const auto render = [&](uint32_t seed) {
        settings.seed = seed;
        reference::PeerRenderer renderer(scene, settings, name, folder);
        const uint64_t steps = renderer.steps_for(spp / 2);
        renderer.plan(steps);
        render_whole(renderer, 0, steps);
        engine = renderer.engine();
        samples += steps * renderer.samples_per_step();
        return renderer.develop();
    };
    Halves halves = in_halves(0, render);
    return described(name, engine, samples, std::move(halves));
}

/// Renders a small scene that shows why renderers differ with all of them.
Json row_of_probe(const std::string &name, uint64_t spp, DeviceContext &device) {
    const Scene scene =
        load_scene((resource_folder() / "scenes/probes" / (name + ".json")).string());
    ReferenceSettings settings;
    settings.width = scene.film_width();
    settings.height = scene.film_height();
    settings.camera = static_cast<size_t>(scene.active_camera());
    Contenders contenders;
    contenders.there.push_back(rendered_by_embree(scene, settings, spp));
    for (const char *peer : {"mitsuba", "cycles"}) {
        try {
            contenders.there.push_back(rendered_by_peer(scene, settings, peer, spp));
        } catch (const Error &error) {
            if (error.exit_code() != ExitCode::skipped) {
                throw;
            }
            contenders.absent.push_back(peer);
        }
    }
    contenders.there.push_back(rendered(scene, spp, 0, device));
    return contenders.row("probe", name);
}

}  // namespace

fs::path references_manifest() {
    return resource_folder() / "results/references/manifest.json";
}

MeasurementPlan plan_reference_agreement(const MeasurementSettings &settings,
                                         DeviceContext &device) {
    MeasurementPlan plan;
    uint32_t number = 0;  // own seeds: otherwise equal paths would light the Cornell boxes
    for (const std::string &name : settings.references) {
        plan.tasks.push_back(
            {name, [=, &device] { return row_of_scene(name, settings, number, device); }});
        ++number;
    }
    for (const std::string &name : settings.probes) {
        plan.tasks.push_back(
            {name, [=, &device] { return row_of_probe(name, settings.probe_spp, device); }});
    }
    plan.summarise = [](const Json &) { return Json::object(); };
    return plan;
}

}  // namespace rtrays
