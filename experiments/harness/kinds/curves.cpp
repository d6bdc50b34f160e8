// SPDX-License-Identifier: MIT
#include "experiments/harness/kinds/curves.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>

#include "experiments/harness/core/description.h"
#include "experiments/harness/core/document.h"
#include "experiments/harness/core/host.h"
#include "experiments/harness/core/references.h"
#include "experiments/harness/core/resumption.h"
#include "experiments/harness/kinds/ladder.h"
#include "experiments/harness/kinds/throughput.h"
#include "reference/renderer.h"
#include "renderer/base/error.h"
#include "renderer/base/progress.h"
#include "renderer/device/context.h"
#include "renderer/import/load_scene.h"

namespace rtrays {

namespace fs = std::filesystem;

namespace {

Json describe_experiment(const ExperimentDescription &experiment) {
    Json described = {
        {"name", experiment.name},
        {"title", experiment.title},
        {"thesis", experiment.thesis},
        {"claim", experiment.claim},
        {"expected_slope",
         {{"value", experiment.expected_slope}, {"tolerance", experiment.slope_tolerance}}},
        {"profile", experiment.profile},
        {"size", {experiment.width, experiment.height}}};
    if (!experiment.settings.empty()) {
        described["settings"] = experiment.settings;
    }
    if (!experiment.expected_gain.is_null()) {
        described["expected_gain"] = experiment.expected_gain;
    }
    return described;
}

void print_plan(const ExperimentDescription &experiment, const StoredReference &reference) {
    const double pixels = static_cast<double>(experiment.width) * experiment.height;
    const double throughput = 2 * pixels * static_cast<double>(experiment.throughput.spp) *
                              experiment.throughput.repetitions;
    fmt::print("{} ({}), profile {}: {}x{}\n", experiment.name, experiment.thesis,
               experiment.profile, experiment.width, experiment.height);
    for (const auto &curve : experiment.curves) {
        fmt::print("  {:40} {:4} to {:4} spp, {:3} seeds {:8.1f} Msamples\n", curve.id(),
                   curve.spp.front(), curve.spp.back(), curve.seeds,
                   1e-6 * pixels * static_cast<double>(curve.spp.back() * curve.seeds));
    }
    fmt::print("  {:68} {:8.1f} Msamples\n", "throughput, both sides", throughput / 1e6);
    fmt::print("  reference: {} spp ({}), noise floor RMSE {:.3g}\n",
               reference.description.at("spp").get<uint64_t>(),
               reference.description.at("engine").get<std::string>(),
               std::sqrt(reference.reference.noise_mse));
}

RenderSettings settings_of(const ExperimentDescription &experiment, const CurveDescription &curve) {
    RenderSettings settings = curve.settings;
    settings.width = experiment.width;
    settings.height = experiment.height;
    apply_settings(settings, experiment.settings);
    return settings;
}

/// Measures renderer and reference in interleaved repetitions with the last curve's settings.
Json run_throughput(const ExperimentDescription &experiment, const Scene &scene,
                    DeviceContext &device, bool quiet) {
    const RenderSettings settings = settings_of(experiment, experiment.curves.back());
    RenderSession session(scene, settings, device);

    ReferenceSettings reference_settings;
    reference_settings.width = experiment.width;
    reference_settings.height = experiment.height;
    reference_settings.camera = static_cast<size_t>(scene.active_camera());
    reference_settings.strategies = strategies_from_name(settings.strategies);
    reference_settings.max_depth = settings.max_depth;
    ReferenceRenderer reference(scene.arrays(), reference_settings);

    const uint64_t spp = experiment.throughput.spp;
    const auto contestant = [&](auto &renderer) {
        return [&renderer, spp, done = uint64_t{0}]() mutable {
            render_whole(renderer, done, done + spp);
            done += spp;
        };
    };
    const Contestant first = contestant(session), second = contestant(reference);
    first();  // warm up: caches, threads
    second();

    ThroughputSettings rules;
    rules.repetitions = experiment.throughput.repetitions;
    rules.samples = static_cast<double>(spp) * experiment.width * experiment.height;
    Progress progress(experiment.name + ": throughput", static_cast<uint64_t>(rules.repetitions),
                      "repetitions", quiet);
    CpuMeter meter;
    const auto use_since = [&] {
        const CpuUse use = meter.use();
        meter.start();
        return use;
    };
    const auto measured = measure_throughput(rules, first, second, use_since, [&](int done) {
        progress.update(static_cast<uint64_t>(done));
    });
    Json json = to_json(measured, rules);
    json["curve"] = experiment.curves.back().id();
    return json;
}

/// Measures one entry of "curves" and writes the curve's images.
Json run_curve(const ExperimentDescription &experiment, const CurveDescription &description,
               LadderTask task, double noise_mse, const fs::path &out) {
    task.settings = settings_of(experiment, description);
    task.spp = description.spp;
    task.early_images = description.early_images;
    task.seeds = description.seeds;
    const LadderResult ladder = render_ladders(task);
    const std::string image = "images/" + description.id() + ".exr";
    const Image mean = average_images(ladder.images);
    write_exr(mean, out / image);

    const AgreementPolicy policy;
    Json curve = summarise_curve(ladder.repetitions, noise_mse);
    curve.update(ladder.cost);
    curve["id"] = description.id();
    curve["scene"] = task.scene.name();
    curve["algorithm"] = description.settings.algorithm->name;
    curve["strategies"] = description.settings.strategies;
    curve["settings"] = image_settings(task.settings);
    // Batches are tested even if the image has variance layers. With few samples a pixel's variance
    // misses the rarest paths, and a normal test would be too certain.
    const Agreement agreement = test_agreement(ladder.batches, task.reference, policy,
                                               [&] { return render_fresh_batches(task); });
    curve["agreement"] = to_json(agreement, policy);
    curve["image"] = image;
    curve["image_spp"] = task.spp.back() * task.seeds;
    curve["layers"] = Json::array();
    for (const char *layer : {"camera", "light"}) {
        if (mean.has(rgb_names(layer).front())) {
            curve["layers"].push_back(layer);
        }
    }
    curve["early_images"] = Json::array();
    for (size_t i = 0; i < task.early_images.size(); ++i) {
        const std::string early =
            fmt::format("images/{}.{}spp.exr", description.id(), task.early_images[i]);
        write_exr(ladder.early_images[i], out / early);
        curve["early_images"].push_back({{"spp", task.early_images[i]}, {"image", early}});
    }
    return curve;
}

fs::path output_folder(const RunOptions &options, const ExperimentDescription &experiment) {
    return options.out.empty() ? fs::path(experiment.name + "." + experiment.profile) : options.out;
}

/// Throws `Error` (run failed) if a value is missing, so that no incomplete run is written.
void require_complete(const Json &run) {
    try {
        parse_run(run.dump(), "run.json");
    } catch (const Error &error) {
        throw run_error(fmt::format("the run is incomplete and was not written: {}", error.what()));
    }
}

/// Returns whether the images of a run exist. The repository keeps run.json without its images; a
/// run without images is measured again.
bool has_images(const Json &run, const fs::path &out) {
    const auto is_there = [&](const Json &entry) {
        return fs::exists(out / entry.at("image").get<std::string>());
    };
    return is_there(run.at("reference")) &&
           std::all_of(run.at("curves").begin(), run.at("curves").end(), [&](const Json &curve) {
               return is_there(curve) && std::all_of(curve.at("early_images").begin(),
                                                     curve.at("early_images").end(), is_there);
           });
}

}  // namespace

fs::path run_experiment(const RunOptions &options) {
    const ExperimentDescription experiment = load_experiment(options.experiment, options.profile);
    const Scene scene = load_scene(experiment.scene.string());
    StoredReference reference = load_reference(experiment, scene);
    if (options.dry_run) {
        print_plan(experiment, reference);
        return {};
    }
    DeviceContext device(options.device);
    if (options.compile) {
        for (const CurveDescription &curve : experiment.curves) {
            compile_kernels(scene, settings_of(experiment, curve), device);
        }
        return {};
    }
    const fs::path out = output_folder(options, experiment);
    const RunContext context;
    const Resumption resumption(out, "run.json", experiment.source + reference.description.dump(),
                                device.info());
    if (!resumption.finished([&](const Json &run) { return has_images(run, out); }).is_null()) {
        return out;
    }
    fs::create_directories(out / "images");
    Json run = {{"schema_version", run_schema_version},
                {"experiment", describe_experiment(experiment)}};
    {
        uint64_t done = 0;
        uint64_t total = 0;
        for (const CurveDescription &curve : experiment.curves) {
            total += curve.seeds * curve.spp.back();
        }
        Progress progress(experiment.name, total, "spp", options.quiet);
        progress.update(0);
        const LadderTask task{scene,
                              device,
                              {},
                              {},
                              0,
                              {},
                              reference.reference.image,
                              resumption.parts(),
                              [&](uint64_t spp) { progress.update(done += spp); }};
        for (const auto &description : experiment.curves) {
            run["curves"].push_back(
                run_curve(experiment, description, task, reference.reference.noise_mse, out));
        }
    }
    run["throughput"] = run_throughput(experiment, scene, device, options.quiet);

    reference.description["image"] = "images/reference.exr";
    write_exr(reference.reference.image, out / "images/reference.exr");
    run["reference"] = reference.description;
    run["context"] = context.finish(device.info());
    require_complete(run);
    resumption.finish(run);
    return out;
}

}  // namespace rtrays
