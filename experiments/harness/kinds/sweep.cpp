// SPDX-License-Identifier: MIT
#include "experiments/harness/kinds/sweep.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <filesystem>
#include <nlohmann/json.hpp>
#include <numeric>

#include "experiments/harness/core/document.h"
#include "experiments/harness/core/expression.h"
#include "experiments/harness/core/metrics.h"
#include "experiments/harness/core/rendering.h"
#include "experiments/harness/core/resumption.h"
#include "reference/renderer.h"
#include "renderer/base/error.h"
#include "renderer/base/progress.h"
#include "renderer/import/load_scene.h"
#include "renderer/session/shared_scenes.h"

namespace rtrays {

namespace fs = std::filesystem;

namespace {

/// One scene whose properties are functions of a value x.
struct Sweep {
    Json text;  ///< name, titles and properties, as in the file
    fs::path scene;
    std::vector<double> values;
    /// Formulas of x by the address of their property.
    std::vector<std::pair<std::string, std::vector<std::string>>> properties;

    std::string name() const { return text.at("name"); }
};

struct Description {
    Json experiment;  ///< "experiment" of the document
    std::vector<CurveDescription> curves;
    std::vector<Sweep> sweeps;
    int width = 0, height = 0;
    uint64_t spp = 0;
    uint32_t seeds = 0;
};

Sweep read_sweep(const DescriptionFile &file, const Json &json, const Json &values) {
    Sweep sweep;
    sweep.text = json;
    sweep.scene = file.resolve(json.at("scene"));
    values.get_to(sweep.values);
    for (const auto &[address, formulas] : json.at("properties").items()) {
        sweep.properties.emplace_back(address, formulas.is_string()
                                                   ? std::vector<std::string>{formulas}
                                                   : formulas.get<std::vector<std::string>>());
    }
    return sweep;
}

Description read(const DescriptionFile &file, const std::string &profile) {
    const Json &json = file.json, &chosen = file.profile(profile);
    Description description;
    description.experiment = {{"profile", profile}};
    for (const char *key : {"name", "title", "thesis", "claim", "sweeps"}) {
        description.experiment[key] = json.at(key);
    }
    for (const char *key : {"size", "spp", "seeds"}) {
        description.experiment[key] = chosen.at(key);
    }
    chosen.at("size").at(0).get_to(description.width);
    chosen.at("size").at(1).get_to(description.height);
    chosen.at("spp").get_to(description.spp);
    chosen.at("seeds").get_to(description.seeds);
    for (const Json &curve : json.at("curves")) {
        RenderSettings settings = parse_render_settings(curve);
        settings.width = description.width;
        settings.height = description.height;
        settings.variance = false;
        description.curves.push_back({settings});
    }
    for (const Json &sweep : json.at("sweeps")) {
        const std::string name = sweep.at("name");
        if (!chosen.at("values").contains(name)) {
            throw input_error(fmt::format("{}: the sweep '{}' has no values",
                                          file.location("/profiles/" + profile + "/values"), name));
        }
        description.sweeps.push_back(read_sweep(file, sweep, chosen.at("values").at(name)));
    }
    return description;
}

/// Loads the scene of a sweep and sets its properties for a value.
Scene scene_at(const Sweep &sweep, double value) {
    Scene scene = load_scene(sweep.scene.string());
    const Names names = [&](const std::string &name) {
        if (name != "x") {
            throw input_error(fmt::format("unknown name '{}'; the value of a sweep is x", name));
        }
        return value;
    };
    for (const auto &[address, formulas] : sweep.properties) {
        std::vector<std::string> numbers;
        for (const std::string &formula : formulas) {
            numbers.push_back(fmt::format("{:.9g}", evaluate(formula, names)));
        }
        scene.set_property(address, fmt::format("{}", fmt::join(numbers, ",")));
    }
    scene.update(0);
    return scene;
}

/// Images and times of one curve, seed by seed.
struct Renders {
    std::vector<Image> images;
    std::vector<RenderStats> stats;
};

/// Renders all curves in interleaved repetitions.
std::vector<Renders> render_curves(const Description &description, const Scene &scene,
                                   DeviceContext &device, const std::function<void()> &advance) {
    SharedScenes scenes(scene, device);
    std::vector<RenderSession> sessions;
    for (const CurveDescription &curve : description.curves) {
        sessions.push_back(scenes.session(curve.settings));
    }
    std::vector<Renders> renders(sessions.size());
    for (uint32_t seed = 1; seed <= description.seeds; ++seed) {
        for (size_t turn = 0; turn < sessions.size(); ++turn) {
            // The order alternates, so that other load on the machine affects all curves equally.
            const size_t i = seed % 2 == 0 ? sessions.size() - 1 - turn : turn;
            sessions[i].restart(seed);
            render_whole(sessions[i], 0, description.spp);
            renders[i].images.push_back(sessions[i].develop());
            renders[i].stats.push_back(sessions[i].stats());
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

class SweepExperiment : public Experiment {
  public:
    SweepExperiment(const DescriptionFile &file, const RunOptions &options)
        : description_(read(file, options.profile)), inputs_(file.of_profile(options.profile)) {
        for (const Sweep &sweep : description_.sweeps) {
            for (const double value : sweep.values) {
                inputs_ += scene_at(sweep, value).hash();
            }
        }
    }

    std::string plan() const override {
        std::string plan = fmt::format("{}, profile {}: {} curves, {}x{}, {} spp, {} seeds\n",
                                       description_.experiment.at("name").get<std::string>(),
                                       description_.experiment.at("profile").get<std::string>(),
                                       description_.curves.size(), description_.width,
                                       description_.height, description_.spp, description_.seeds);
        for (const Sweep &sweep : description_.sweeps) {
            plan += fmt::format("  {:24} {}\n", sweep.name(), fmt::join(sweep.values, ", "));
        }
        return plan;
    }

    std::string inputs() const override { return inputs_; }

    Json measure(const Bench &bench) const override {
        uint64_t steps = 0, done = 0;
        for (const Sweep &sweep : description_.sweeps) {
            steps += sweep.values.size() * description_.seeds;
        }
        Progress progress(description_.experiment.at("name"), steps, "seeds", bench.quiet);
        progress.update(0);
        Json rows = Json::array();
        for (const Sweep &sweep : description_.sweeps) {
            for (size_t i = 0; i < sweep.values.size(); ++i) {
                const uint64_t before = done;
                const fs::path file = bench.parts / fmt::format("{}.{}.json", sweep.name(), i);
                rows.push_back(finished_part(file, [&] {
                    return measure_row(sweep, sweep.values[i], bench.device,
                                       [&] { progress.update(++done); });
                }));
                progress.update(done = before + description_.seeds);
            }
        }
        return {{"experiment", description_.experiment}, {"rows", rows}};
    }

  private:
    Json measure_row(const Sweep &sweep, double value, DeviceContext &device,
                     const std::function<void()> &advance) const {
        const Scene scene = scene_at(sweep, value);
        ReferenceSettings settings;
        settings.width = description_.width;
        settings.height = description_.height;
        settings.camera = static_cast<size_t>(scene.active_camera());
        const FirstHits classes = ReferenceRenderer(scene.arrays(), settings).first_hits();
        const std::vector<Renders> renders = render_curves(description_, scene, device, advance);
        Json curves = Json::array();
        for (size_t i = 0; i < renders.size(); ++i) {
            curves.push_back(curve_row(description_.curves[i], renders[i], classes));
        }
        return {{"sweep", sweep.name()},
                {"value", value},
                {"pixels", to_json(pixel_shares(classes))},
                {"curves", curves}};
    }

    Description description_;
    std::string inputs_;
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

std::unique_ptr<Experiment> make_sweep(const DescriptionFile &file, const RunOptions &options) {
    return std::make_unique<SweepExperiment>(file, options);
}

}  // namespace rtrays
