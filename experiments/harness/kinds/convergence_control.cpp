// SPDX-License-Identifier: MIT
#include "experiments/harness/kinds/convergence_control.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <nlohmann/json.hpp>

#include "experiments/harness/core/agreement.h"
#include "experiments/harness/core/description.h"
#include "experiments/harness/core/document.h"
#include "experiments/harness/core/metrics.h"
#include "experiments/harness/core/references.h"
#include "experiments/harness/core/rendering.h"
#include "experiments/harness/core/resumption.h"
#include "renderer/base/progress.h"
#include "renderer/device/context.h"
#include "renderer/import/load_scene.h"
#include "renderer/session/shared_scenes.h"

namespace rtrays {

namespace fs = std::filesystem;

namespace {

struct Description {
    std::string name, profile;
    std::vector<fs::path> paths;         ///< scene files
    std::vector<RenderSettings> curves;  ///< with size
    std::vector<double> errors;
    int size = 0;
    uint64_t spp = 0;
    uint32_t seeds = 0;
};

RenderSettings with_error(RenderSettings settings, double error) {
    apply_setting(settings, fmt::format("integrator.convergence.error={}", error));
    return settings;
}

Description read(const DescriptionFile &file, const std::string &profile) {
    const Json &json = file.json, &chosen = file.profile(profile);
    Description description;
    description.profile = profile;
    json.at("name").get_to(description.name);
    json.at("errors").get_to(description.errors);
    chosen.at("size").get_to(description.size);
    chosen.at("spp").get_to(description.spp);
    chosen.at("seeds").get_to(description.seeds);
    for (const Json &scene : chosen.at("scenes")) {
        description.paths.push_back(file.resolve(json.at("folder")) / scene.get<std::string>() /
                                    "scene.json");
    }
    for (const Json &curve : json.at("curves")) {
        RenderSettings settings = parse_render_settings(curve);
        settings.width = settings.height = description.size;
        settings.variance = false;
        for (const double error : description.errors) {
            require_consistent(with_error(settings, error));
        }
        description.curves.push_back(settings);
    }
    return description;
}

double sum_of(const Image &image) {
    double sum = 0;
    for (const std::string &channel : rgb_names()) {
        for (const float value : image.channel(channel)) {
            sum += static_cast<double>(value);
        }
    }
    return sum;
}

/// Returns the mean of the images with zero variances, so that tests treat it as exact.
Image mean_of(const std::vector<ControlledRender> &renders) {
    std::vector<Image> images;
    for (const ControlledRender &render : renders) {
        images.push_back(render.image);
    }
    Image mean = average_images(images);
    for (const std::string &name : rgb_names("variance")) {
        mean.add_channel(name);
    }
    return mean;
}

ControlledRender render(RenderSession &session, uint32_t seed, uint64_t spp) {
    session.restart(seed);
    render_whole(session, 0, spp);
    ControlledRender result;
    result.image = session.develop();
    const RenderStats stats = session.stats();
    result.paths = static_cast<double>(stats.samples);
    result.rays = static_cast<double>(stats.rays);
    result.seconds = stats.device_seconds;
    const nlohmann::json report = session.report();
    if (report.contains("convergence") && !report.at("convergence").at("checks").empty()) {
        result.live = report.at("convergence").at("checks").back().at("live");
    }
    return result;
}

/// Measures one scene with one curve: one row for each error limit.
Json measure_curve(const Description &description, const Scene &scene, const RenderSettings &curve,
                   const Image &reference, DeviceContext &device,
                   const std::function<void()> &advance) {
    std::vector<RenderSettings> settings = {curve};
    for (const double error : description.errors) {
        settings.push_back(with_error(curve, error));
    }
    SharedScenes scenes(scene, device);
    std::vector<RenderSession> sessions;
    for (const RenderSettings &s : settings) {
        sessions.push_back(scenes.session(s));
    }
    std::vector<std::vector<ControlledRender>> renders(sessions.size());
    for (uint32_t seed = 1; seed <= description.seeds; ++seed) {
        // The order alternates, so that other load on the machine affects all settings equally.
        for (size_t turn = 0; turn < sessions.size(); ++turn) {
            const size_t i = seed % 2 == 0 ? sessions.size() - 1 - turn : turn;
            renders[i].push_back(render(sessions[i], seed, description.spp));
            advance();
        }
    }
    Json rows = Json::array();
    for (size_t i = 0; i < description.errors.size(); ++i) {
        Json row = compare_control(renders[i + 1], renders.front(), reference);
        row["scene"] = scene.name();
        row["algorithm"] = curve.algorithm->name;
        row["error"] = description.errors[i];
        row["settings"] = image_settings(settings[i + 1]);
        rows.push_back(row);
    }
    return rows;
}

}  // namespace

Json compare_control(const std::vector<ControlledRender> &with,
                     const std::vector<ControlledRender> &without, const Image &reference) {
    if (with.size() != without.size() || with.size() < 8) {
        throw run_error(
            fmt::format("a bias estimate needs at least 8 pairs of renders, got {} and {}",
                        with.size(), without.size()));
    }
    const auto n = static_cast<double>(with.size());
    const Image base = mean_of(without);
    const double scale = sum_of(base);
    std::vector<Image> batches;
    std::vector<double> seconds, bias, cost_with, cost_without;
    double paths = 0, paths_without = 0, rays = 0, rays_without = 0, live = 0, mse = 0,
           mse_without = 0;
    for (size_t i = 0; i < with.size(); ++i) {
        const double own = compute_metrics(with[i].image, reference).mse,
                     other = compute_metrics(without[i].image, reference).mse;
        mse += own / n;
        mse_without += other / n;
        cost_with.push_back(own * with[i].rays);
        cost_without.push_back(other * without[i].rays);
        paths += with[i].paths;
        paths_without += without[i].paths;
        rays += with[i].rays;
        rays_without += without[i].rays;
        live += with[i].live / n;
        seconds.push_back(with[i].seconds / without[i].seconds);
        bias.push_back((sum_of(with[i].image) - sum_of(without[i].image)) / scale);
        batches.push_back(shifted(base, with[i].image, without[i].image));
    }
    const Agreement blocks = test_agreement(batches, base);
    const Interval change =
        paired_error_ratio(cost_without, cost_with, 0.995);  // two one-sided bounds: 99 % together
    return {{"paths", paths / paths_without},
            {"rays", rays / rays_without},
            {"live", live},
            {"seconds", to_json(median_interval(seconds))},
            {"rmse", std::sqrt(mse)},
            {"rmse_without", std::sqrt(mse_without)},
            {"efficiency", to_json(Interval{1 + change.value, 1 + change.low, 1 + change.high})},
            {"bias",
             {{"mean", to_json(mean_interval(bias, 0.99))},
              {"tests", blocks.tests},
              {"rejected", blocks.rejected},
              {"undecided", blocks.undecided},
              {"largest_z", blocks.largest_z},
              {"largest_z_at", blocks.largest_z_at}}}};
}

namespace {

class ControlExperiment : public Experiment {
  public:
    ControlExperiment(const DescriptionFile &file, const RunOptions &options)
        : description_(read(file, options.profile)), inputs_(file.of_profile(options.profile)) {
        const Json &wanted = file.json.at("reference");
        for (const fs::path &path : description_.paths) {
            scenes_.push_back(load_scene(path.string()));
            StoredReference reference = load_reference(
                {file.resolve(wanted.at("folder")), scenes_.back().name(), scenes_.back().hash(),
                 wanted.at("engine"), description_.size, description_.size, path.string()});
            references_.push_back(std::move(reference.reference.image));
            inputs_ += reference.description.dump();
        }
    }

    std::string plan() const override {
        return fmt::format("{}, profile {}: {} scenes x {} curves x {} error limits, {} seeds\n",
                           description_.name, description_.profile, scenes_.size(),
                           description_.curves.size(), description_.errors.size(),
                           description_.seeds);
    }

    std::string inputs() const override { return inputs_; }

    Json measure(const Bench &bench) const override {
        return {{"experiment",
                 {{"name", description_.name},
                  {"profile", description_.profile},
                  {"size", description_.size},
                  {"spp", description_.spp},
                  {"seeds", description_.seeds}}},
                {"rows", measure_rows(bench)}};
    }

  private:
    Json measure_rows(const Bench &bench) const {
        const uint64_t renders_of_row = description_.seeds * (description_.errors.size() + 1);
        Progress progress(description_.name,
                          renders_of_row * scenes_.size() * description_.curves.size(), "renders",
                          bench.quiet);
        uint64_t finished = 0;
        progress.update(finished);
        Json rows = Json::array();
        for (size_t scene = 0; scene < scenes_.size(); ++scene) {
            for (const RenderSettings &curve : description_.curves) {
                const uint64_t before = finished;
                const Json part =
                    finished_part(bench.parts / fmt::format("{}.{}.json", scenes_[scene].name(),
                                                            curve.algorithm->name),
                                  [&] {
                                      return measure_curve(description_, scenes_[scene], curve,
                                                           references_[scene], bench.device,
                                                           [&] { progress.update(++finished); });
                                  });
                rows.insert(rows.end(), part.begin(), part.end());
                progress.update(finished = before + renders_of_row);
            }
        }
        return rows;
    }

    Description description_;
    std::string inputs_;
    std::vector<Scene> scenes_;
    std::vector<Image> references_;
};

}  // namespace

std::unique_ptr<Experiment> make_convergence_control(const DescriptionFile &file,
                                                     const RunOptions &options) {
    return std::make_unique<ControlExperiment>(file, options);
}

}  // namespace rtrays
