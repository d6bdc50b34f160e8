// SPDX-License-Identifier: MIT
#include "experiments/harness/kinds/curves.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <memory>
#include <nlohmann/json.hpp>
#include <utility>

#include "experiments/harness/core/document.h"
#include "experiments/harness/core/host.h"
#include "experiments/harness/core/references.h"
#include "experiments/harness/core/rendering.h"
#include "experiments/harness/kinds/curves_description.h"
#include "experiments/harness/kinds/ladder.h"
#include "experiments/harness/kinds/throughput.h"
#include "reference/renderer.h"
#include "renderer/base/error.h"
#include "renderer/base/process.h"
#include "renderer/base/progress.h"
#include "renderer/device/context.h"
#include "renderer/import/load_scene.h"

namespace rtrays {

namespace fs = std::filesystem;

namespace {

Json describe_experiment(const CurvesDescription &experiment) {
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

std::string plan_of(const CurvesDescription &experiment, const StoredReference &reference) {
    const double pixels = static_cast<double>(experiment.width) * experiment.height;
    std::string plan = fmt::format("{}, profile {}: {}x{}\n", experiment.name, experiment.profile,
                                   experiment.width, experiment.height);
    for (const auto &curve : experiment.curves) {
        plan += fmt::format("  {:40} {:4} to {:4} spp, {:3} seeds {:8.1f} Msamples\n", curve.id(),
                            curve.spp.front(), curve.spp.back(), curve.seeds,
                            1e-6 * pixels * static_cast<double>(curve.spp.back() * curve.seeds));
    }
    if (experiment.throughput) {
        const double samples = 2 * pixels * static_cast<double>(experiment.throughput->spp) *
                               experiment.throughput->repetitions;
        plan += fmt::format("  {:68} {:8.1f} Msamples\n", "throughput, both sides", samples / 1e6);
    }
    plan += fmt::format("  reference: {} spp ({}), noise floor RMSE {:.3g}\n",
                        reference.description.at("spp").get<uint64_t>(),
                        reference.description.at("engine").get<std::string>(),
                        std::sqrt(reference.reference.noise_mse));
    return plan;
}

RenderSettings settings_of(const CurvesDescription &experiment, const CurveDescription &curve) {
    RenderSettings settings = curve.settings;
    settings.width = experiment.width;
    settings.height = experiment.height;
    apply_settings(settings, experiment.settings);
    return settings;
}

ReferenceSettings reference_settings_of(const CurvesDescription &experiment, const Scene &scene) {
    ReferenceSettings settings;
    settings.width = experiment.width;
    settings.height = experiment.height;
    settings.camera = static_cast<size_t>(scene.active_camera());
    return settings;
}

/// Describes the classes of pixels, and writes their picture.
Json describe_first_hits(const FirstHits &classes, const StoredReference &reference,
                         const fs::path &out) {
    const Image &image = reference.reference.image;
    const std::string picture = "images/first_hits.exr";
    write_exr(picture_of(classes, image.width(), image.height()), out / picture);
    // The noise of an average of two halves is a quarter of the error between them.
    ByFirstHit noise = divide_mse(reference.halves[0], reference.halves[1], classes);
    for (double &part : noise) {
        part /= 4;
    }
    return {{"image", picture},
            {"pixels", to_json(pixel_shares(classes))},
            {"noise_mse", to_json(noise)}};
}

/// Measures renderer and reference in interleaved repetitions with the last curve's settings.
Json run_throughput(const CurvesDescription &experiment, const Scene &scene, DeviceContext &device,
                    bool quiet) {
    const CurveDescription &curve = experiment.throughput->curve;
    const RenderSettings settings = settings_of(experiment, curve);
    RenderSession session(scene, settings, device);

    ReferenceSettings reference_settings = reference_settings_of(experiment, scene);
    reference_settings.strategies =
        strategies_from_name(name_in(path_strategies, settings.strategies));
    reference_settings.max_depth = settings.max_depth;
    ReferenceRenderer reference(scene.arrays(), reference_settings);

    const uint64_t spp = experiment.throughput->spp;
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
    rules.repetitions = experiment.throughput->repetitions;
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
    json["curve"] = curve.id();
    return json;
}

/// Measures one entry of "curves" and writes the curve's images.
Json describe_curve(const CurveDescription &description, const LadderTask &task,
                    const std::string &scene, double noise_mse, const fs::path &out) {
    const LadderResult ladder = render_ladders(task);
    const std::string image = "images/" + description.id() + ".exr";
    const Image mean = average_images(ladder.images);
    write_exr(mean, out / image);

    const AgreementPolicy policy;
    Json curve = summarise_curve(ladder.repetitions, noise_mse);
    curve.update(ladder.description);
    curve["id"] = description.id();
    if (!description.label.empty()) {
        curve["label"] = description.label;
    }
    curve["scene"] = scene;
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

class Curves : public Experiment {
  public:
    Curves(const DescriptionFile &file, const RunOptions &options)
        : description_(read_curves(file, options.profile)),
          scene_(load_scene(description_.scene.string())),
          reference_(load_reference(description_, scene_)) {
        for (size_t i = 0; i < description_.curves.size(); ++i) {
            const auto &other = description_.curves[i].other;
            if (other && other->engine == "command" && !program_exists(other->command.front())) {
                throw input_error(fmt::format("{}: program '{}' was not found",
                                              file.location(fmt::format("/curves/{}/command", i)),
                                              other->command.front()));
            }
        }
    }

    std::string plan() const override { return plan_of(description_, reference_); }

    std::string inputs() const override {
        return description_.source + reference_.description.dump();
    }

    void compile(DeviceContext &device) const override {
        for (const CurveDescription &curve : description_.curves) {
            if (!curve.other) {
                compile_kernels(scene_, settings_of(description_, curve), device);
            }
        }
    }

    Json measure(const Bench &bench) const override {
        fs::create_directories(bench.out / "images");
        Json description = reference_.description;
        description["image"] = "images/reference.exr";
        write_exr(reference_.reference.image, bench.out / "images/reference.exr");
        const FirstHits first_hits =
            ReferenceRenderer(scene_.arrays(), reference_settings_of(description_, scene_))
                .first_hits();
        Json document = {{"experiment", describe_experiment(description_)},
                         {"reference", description},
                         {"first_hits", describe_first_hits(first_hits, reference_, bench.out)},
                         {"curves", measure_curves(bench, first_hits)}};
        if (description_.throughput) {
            document["throughput"] =
                run_throughput(description_, scene_, bench.device, bench.quiet);
        }
        return document;
    }

    bool is_whole(const Json &document, const fs::path &out) const override {
        return has_images(document, out);
    }

  private:
    Json measure_curves(const Bench &bench, const FirstHits &first_hits) const {
        uint64_t total = 0, done = 0;
        for (const CurveDescription &curve : description_.curves) {
            total += curve.seeds * curve.spp.back();
        }
        Progress progress(description_.name, total, "spp", bench.quiet);
        progress.update(0);
        SharedScenes scenes(scene_, bench.device);
        const auto source_of = [&](const CurveDescription &curve) {
            const RenderSettings settings = settings_of(description_, curve);
            return curve.other ? other_source(curve, description_.scene, settings,
                                              bench.parts / ("other." + curve.id()))
                               : session_source(scenes, settings);
        };
        // Other renderers start before anything is measured, so that a missing one is an error now.
        std::map<std::string, std::unique_ptr<CurveSource>> others;
        for (const CurveDescription &curve : description_.curves) {
            if (curve.other) {
                others[curve.id()] = source_of(curve);
            }
        }
        Json curves = Json::array();
        for (const CurveDescription &curve : description_.curves) {
            const RenderSettings settings = settings_of(description_, curve);
            const auto make_source = [&] {
                auto started = others.extract(curve.id());
                return started.empty() ? source_of(curve) : std::move(started.mapped());
            };
            const LadderTask task{curve.id(),
                                  make_source,
                                  !curve.other && settings.sampler != Sampler::sobol,
                                  curve.spp,
                                  curve.seeds,
                                  curve.early_images,
                                  reference_.reference.image,
                                  first_hits,
                                  bench.parts,
                                  [&](uint64_t spp) { progress.update(done += spp); }};
            curves.push_back(describe_curve(curve, task, scene_.name(),
                                            reference_.reference.noise_mse, bench.out));
        }
        return curves;
    }

    CurvesDescription description_;
    Scene scene_;
    StoredReference reference_;
};

}  // namespace

std::unique_ptr<Experiment> make_curves(const DescriptionFile &file, const RunOptions &options) {
    return std::make_unique<Curves>(file, options);
}

}  // namespace rtrays
