// SPDX-License-Identifier: MIT
#include "experiments/harness/kinds/unreferenced.h"

#include <fmt/format.h>

#include <filesystem>
#include <nlohmann/json.hpp>
#include <numeric>
#include <optional>

#include "experiments/harness/core/document.h"
#include "experiments/harness/core/metrics.h"
#include "experiments/harness/core/rendering.h"
#include "experiments/harness/core/resumption.h"
#include "reference/renderer.h"
#include "renderer/base/error.h"
#include "renderer/base/progress.h"
#include "renderer/session/pilot.h"
#include "renderer/session/shared_scenes.h"

namespace rtrays {

namespace fs = std::filesystem;

namespace {

struct Description {
    Json experiment;  ///< "experiment" of the document
    std::vector<CurveDescription> curves;
    int width = 0, height = 0;
    uint64_t spp = 0;
    uint32_t seeds = 0;
};

Description read(const DescriptionFile &file, const std::string &profile,
                 const std::vector<std::string> &shown) {
    const Json &chosen = file.profile(profile);
    Description description;
    description.experiment = {{"profile", profile}};
    for (const std::string &key : shown) {
        description.experiment[key] = file.json.at(key);
    }
    for (const char *key : {"size", "spp", "seeds"}) {
        description.experiment[key] = chosen.at(key);
    }
    chosen.at("size").at(0).get_to(description.width);
    chosen.at("size").at(1).get_to(description.height);
    chosen.at("spp").get_to(description.spp);
    chosen.at("seeds").get_to(description.seeds);
    for (const Json &curve : file.json.at("curves")) {
        RenderSettings settings = parse_render_settings(curve);
        settings.width = description.width;
        settings.height = description.height;
        settings.variance = false;
        description.curves.push_back({settings});
    }
    return description;
}

/// Images and times of one curve, seed by seed.
struct Renders {
    std::vector<Image> images;
    std::vector<RenderStats> stats;
};

/// Returns the colours alone: an image has layers of the passes that its pilot chose.
Image without_layers(const Image &image) {
    Image colours = Image::rgb(image.width(), image.height());
    for (const std::string &name : rgb_names()) {
        colours.channel(name) = image.channel(name);
    }
    return colours;
}

/// Renders all curves in interleaved repetitions.
std::vector<Renders> render_curves(const Description &description, const Scene &scene,
                                   DeviceContext &device, const std::function<void()> &advance) {
    SharedScenes scenes(scene, device);
    std::vector<std::optional<RenderSession>> sessions(description.curves.size());
    std::vector<Renders> renders(sessions.size());
    for (uint32_t seed = 1; seed <= description.seeds; ++seed) {
        for (size_t turn = 0; turn < sessions.size(); ++turn) {
            // The order alternates, so that other load on the machine affects all curves equally.
            const size_t i = seed % 2 == 0 ? sessions.size() - 1 - turn : turn;
            RenderSettings settings = description.curves[i].settings;
            settings.seed = seed;
            std::optional<RenderSession> &session = sessions[i];
            if (!session || needs_pilot(settings)) {  // what a pilot chooses depends on its seed
                session.emplace(scenes.session(settings));
            } else {
                session->restart(seed);
            }
            render_whole(*session, 0, description.spp);
            renders[i].images.push_back(without_layers(session->develop()));
            renders[i].stats.push_back(session->stats());
        }
        advance();
    }
    return renders;
}

Json curve_row(const CurveDescription &curve, const Renders &renders, const FirstHits &classes) {
    const std::vector<ByFirstHit> errors = errors_without_reference(renders.images, classes);
    Json repetitions = Json::array();
    for (size_t i = 0; i < errors.size(); ++i) {
        repetitions.push_back({{"seed", i + 1},
                               {"rays", renders.stats[i].rays},
                               {"seconds_device", renders.stats[i].device_seconds},
                               {"seconds_wall", renders.stats[i].wall_seconds},
                               {"mse", std::accumulate(errors[i].begin(), errors[i].end(), 0.0)},
                               {"mse_parts", to_json(errors[i])}});
    }
    return {{"id", curve.id()},
            {"algorithm", curve.settings.algorithm->name},
            {"settings", image_settings(curve.settings)},
            {"repetitions", repetitions}};
}

class Unreferenced : public Experiment {
  public:
    Unreferenced(Description description, std::vector<UnreferencedCase> cases,
                 const std::string &cases_plan, std::string inputs)
        : description_(std::move(description)),
          cases_(std::move(cases)),
          cases_plan_(cases_plan),
          inputs_(std::move(inputs)) {
        for (const UnreferencedCase &each : cases_) {
            inputs_ += each.load().hash();
        }
    }

    std::string plan() const override {
        return fmt::format("{}, profile {}: {} curves, {}x{}, {} spp, {} seeds\n{}",
                           description_.experiment.at("name").get<std::string>(),
                           description_.experiment.at("profile").get<std::string>(),
                           description_.curves.size(), description_.width, description_.height,
                           description_.spp, description_.seeds, cases_plan_);
    }

    std::string inputs() const override { return inputs_; }

    Json measure(const Bench &bench) const override {
        uint64_t done = 0;
        Progress progress(description_.experiment.at("name"), cases_.size() * description_.seeds,
                          "seeds", bench.quiet);
        progress.update(0);
        Json rows = Json::array();
        for (const UnreferencedCase &each : cases_) {
            const uint64_t before = done;
            rows.push_back(finished_part(bench.parts / each.file, [&] {
                return measure_row(each, bench.device, [&] { progress.update(++done); });
            }));
            progress.update(done = before + description_.seeds);
        }
        return {{"experiment", description_.experiment}, {"rows", rows}};
    }

  private:
    Json measure_row(const UnreferencedCase &each, DeviceContext &device,
                     const std::function<void()> &advance) const {
        const Scene scene = each.load();
        ReferenceSettings settings;
        settings.width = description_.width;
        settings.height = description_.height;
        settings.camera = static_cast<size_t>(scene.active_camera());
        const FirstHits classes = ReferenceRenderer(scene.arrays(), settings).first_hits();
        const std::vector<Renders> renders = render_curves(description_, scene, device, advance);
        Json row = each.keys;
        row["pixels"] = to_json(pixel_shares(classes));
        for (size_t i = 0; i < renders.size(); ++i) {
            row["curves"].push_back(curve_row(description_.curves[i], renders[i], classes));
        }
        return row;
    }

    Description description_;
    std::vector<UnreferencedCase> cases_;
    std::string cases_plan_, inputs_;
};

}  // namespace

std::vector<ByFirstHit> errors_without_reference(const std::vector<Image> &images,
                                                 const FirstHits &classes) {
    if (images.size() < 2) {
        throw input_error("an error without a reference needs at least two images");
    }
    const auto n = static_cast<double>(images.size());
    const Image mean = average_images(images);
    std::vector<ByFirstHit> errors;
    for (const Image &image : images) {
        errors.push_back(divide_mse(image, mean, classes));
        for (double &part : errors.back()) {
            part *= n / (n - 1);
        }
    }
    return errors;
}

std::unique_ptr<Experiment> make_unreferenced(const DescriptionFile &file,
                                              const std::string &profile,
                                              const std::vector<std::string> &shown,
                                              std::vector<UnreferencedCase> cases,
                                              const std::string &plan) {
    return std::make_unique<Unreferenced>(read(file, profile, shown), std::move(cases), plan,
                                          file.of_profile(profile));
}

}  // namespace rtrays
