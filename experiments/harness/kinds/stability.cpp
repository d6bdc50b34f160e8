// SPDX-License-Identifier: MIT
#include "experiments/harness/kinds/stability.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <nlohmann/json.hpp>
#include <set>

#include "experiments/harness/core/agreement.h"
#include "experiments/harness/core/document.h"
#include "experiments/harness/core/host.h"
#include "experiments/harness/core/metrics.h"
#include "experiments/harness/core/rendering.h"
#include "experiments/harness/core/resumption.h"
#include "experiments/harness/kinds/stability_cases.h"
#include "experiments/harness/kinds/stability_comparison.h"
#include "reference/renderer.h"
#include "renderer/base/files.h"
#include "renderer/base/progress.h"
#include "renderer/device/context.h"
#include "renderer/import/load_scene.h"
#include "renderer/session/render_session.h"

namespace rtrays {

namespace fs = std::filesystem;

namespace {

constexpr uint64_t batches = 32;
constexpr double family_alpha = 0.01;  // for all tests of a profile together (Bonferroni)
constexpr uint32_t renderer_seed = 31;
constexpr uint64_t reference_seed = 32;

/// Batches of a case rendered by one algorithm.
struct Batches {
    std::vector<Image> images;
    uint64_t non_finite = 0;
    uint64_t out_of_range = 0;
    double seconds = 0;  ///< device time
};

Batches render(const SceneVariant &variant, const StabilityCase &tested,
               const RenderSettings &settings, DeviceContext &device) {
    const Scene scene = variant.load();
    RenderSession session(scene, settings, device);
    Batches result;
    for (uint64_t batch = 0; batch < batches; ++batch) {
        session.restart(renderer_seed);
        const SampleRange range =
            batch_range(session, tested.first_sample, tested.spp, batches, batch);
        render_whole(session, range.begin, range.end);
        const FilmState film = session.film();
        result.non_finite += film.non_finite;
        result.out_of_range += film.out_of_range;
        result.seconds += session.stats().device_seconds;
        result.images.push_back(develop_film(film));
    }
    return result;
}

/// Returns `image` with its colour channels reordered.
Image relabelled(const Image &image, const std::array<size_t, 3> &channels) {
    Image result = Image::rgb(image.width(), image.height());
    for (size_t c = 0; c < 3; ++c) {
        result.channel(rgb_names()[c]) = image.channel(rgb_names()[channels[c]]);
    }
    return result;
}

Image uniform(int size, const std::array<double, 3> &values) {
    Image image = Image::rgb(size, size);
    for (size_t c = 0; c < 3; ++c) {
        std::fill(image.channel(rgb_names()[c]).begin(), image.channel(rgb_names()[c]).end(),
                  static_cast<float>(values[c]));
    }
    return image;
}

Image render_reference(const StabilityCase &tested, const RenderSettings &settings) {
    const Scene scene = tested.scene.load();
    ReferenceSettings wanted;
    wanted.width = settings.width;
    wanted.height = settings.height;
    wanted.camera = static_cast<size_t>(scene.active_camera());
    wanted.seed = reference_seed;
    wanted.max_depth = settings.max_depth;
    ReferenceRenderer reference(scene.arrays(), wanted);
    render_whole(reference, 0, tested.reference_spp);
    return reference.develop();
}

/// Returns mean + (images - others). Equal samples differ little if the scenes are equivalent.
std::vector<Image> paired(const std::vector<Image> &images, const std::vector<Image> &others,
                          const Image &mean) {
    std::vector<Image> result;
    for (size_t i = 0; i < images.size(); ++i) {
        result.push_back(shifted(mean, images[i], others[i]));
    }
    return result;
}

StabilityTest test_case(const StabilityCase &tested, const RenderSettings &settings,
                        const Batches &rendered, const Image &reference, double alpha,
                        DeviceContext &device) {
    if (tested.expectation == Expectation::saturates) {
        StabilityTest result;
        result.tests = 1;
        result.verdict = rendered.out_of_range > 0 ? "ok" : "off";
        return result;
    }
    if (tested.expectation != Expectation::like) {
        const bool noisy = tested.expectation == Expectation::reference;
        const ExpectedImage expected{noisy ? reference : uniform(settings.width, tested.expected),
                                     noisy};
        return test_stability(rendered.images, expected, tested.bound, tested.within, alpha);
    }
    std::vector<Image> others;
    for (const Image &image : render(tested.other, tested, settings, device).images) {
        others.push_back(relabelled(image, tested.channels));
    }
    const Image mean = average_images(others);
    StabilityTest result = test_stability(paired(rendered.images, others, mean), {mean, false},
                                          tested.bound, tested.within, alpha);
    result.mse = mean_squared_error(rendered.images, {mean, false}) / std::pow(result.expected, 2);
    return result;
}

const char *name_of(Expectation expectation) {
    switch (expectation) {
        case Expectation::closed_form:
            return "closed form";
        case Expectation::reference:
            return "reference";
        case Expectation::like:
            return "like";
        case Expectation::saturates:
            return "saturates";
    }
    throw run_error("unknown expectation");
}

/// Measures one case: a row for each algorithm, and for each one that cannot render the case.
Json measure_case(const StabilityCase &tested, double alpha, DeviceContext &device,
                  const fs::path &images) {
    Image reference;
    if (tested.expectation == Expectation::reference) {
        reference = render_reference(tested, tested.runs.front().settings);
        write_exr(reference, images / fmt::format("{}.reference.exr", tested.name));
    }
    Json rows = Json::array();
    for (const auto &[name, settings] : tested.runs) {
        const Batches rendered = render(tested.scene, tested, settings, device);
        const bool finite =
            rendered.non_finite == 0 &&
            (rendered.out_of_range == 0 || tested.expectation == Expectation::saturates);
        const StabilityTest test = test_case(tested, settings, rendered, reference, alpha, device);
        write_exr(average_images(rendered.images),
                  images / fmt::format("{}.{}.exr", tested.name, name));
        rows.push_back({{"case", tested.name},
                        {"group", tested.group},
                        {"stiffness", tested.stiffness},
                        {"title", tested.title},
                        {"algorithm", name},
                        {"settings", changed_settings(settings)},
                        {"against", name_of(tested.expectation)},
                        {"expected", test.expected},
                        {"measured", test.measured},
                        {"difference", to_json(test.difference)},
                        {"bound", tested.bound},
                        {"reason", tested.reason},
                        {"tests", test.tests},
                        {"undecided", test.undecided},
                        {"rejected", test.rejected},
                        {"verdict", finite                    ? test.verdict
                                    : rendered.non_finite > 0 ? "not finite"
                                                              : "saturated"},
                        {"non_finite", rendered.non_finite},
                        {"saturated", rendered.out_of_range},
                        {"spp", tested.spp},
                        {"mse", test.mse},
                        {"mse_expected", test.mse_expected},
                        {"seconds", rendered.seconds}});
    }
    for (const auto &[algorithm, why] : tested.unseen) {
        rows.push_back({{"case", tested.name},
                        {"group", tested.group},
                        {"title", tested.title},
                        {"algorithm", algorithm},
                        {"verdict", "out of reach"},
                        {"reason", why}});
    }
    return rows;
}

bool row_passes(const Json &row, bool survey) {
    const std::string verdict = row.at("verdict");
    return survey ? verdict != "not finite" && verdict != "saturated"
                  : verdict == "ok" || verdict == "out of reach";
}

std::string cells_of(const Json &row) {
    const auto number = [&](const char *key) { return row.at(key).get<double>(); };
    std::string cells = fmt::format("{} | {} | ", row.at("case").get<std::string>(),
                                    row.at("algorithm").get<std::string>());
    if (!row.contains("against")) {
        return cells + fmt::format("| | | | | {} | | | {}", row.at("verdict").get<std::string>(),
                                   row.at("reason").get<std::string>());
    }
    const Json &difference = row.at("difference");
    cells += fmt::format("{} | {:.6g} | {:.6g} | {:+.1e} | {:+.1e} | **{}** | {} | {} | ",
                         row.at("against").get<std::string>(), number("expected"),
                         number("measured"), difference.at("low").get<double>(),
                         difference.at("high").get<double>(), row.at("verdict").get<std::string>(),
                         row.at("non_finite").get<uint64_t>(), row.at("saturated").get<uint64_t>());
    return cells + (row.at("reason") == "" ? ""
                                           : fmt::format("bound {:.0e}: {}", number("bound"),
                                                         row.at("reason").get<std::string>()));
}

class Stability : public Experiment {
  public:
    Stability(const DescriptionFile &file, const RunOptions &options)
        : suite_(read_stability(file, options.profile)), inputs_(file.of_profile(options.profile)) {
        for (const StabilityCase &tested : suite_.cases) {
            for (const StabilityRun &run : tested.runs) {
                ++renders_;
                tests_ += tests_of(run.settings.width);
            }
        }
    }

    std::string plan() const override {
        return fmt::format("{}, profile {}: {} cases, {} renders of {} batches, {} tests\n",
                           suite_.name, suite_.profile, suite_.cases.size(), renders_, batches,
                           tests_);
    }

    std::string inputs() const override {
        std::set<fs::path> paths;
        for (const StabilityCase &tested : suite_.cases) {
            paths.insert(tested.scene.path);
            if (tested.expectation == Expectation::like) {
                paths.insert(tested.other.path);
            }
        }
        std::string inputs = inputs_;
        for (const fs::path &path : paths) {
            inputs += load_scene(path.string()).hash();
        }
        return inputs;
    }

    void compile(DeviceContext &device) const override {
        for (const StabilityCase &tested : suite_.cases) {
            const Scene scene = tested.scene.load();
            for (const StabilityRun &run : tested.runs) {
                compile_kernels(scene, run.settings, device);
            }
        }
    }

    Json measure(const Bench &bench) const override {
        fs::create_directories(bench.out / "images");
        Json rows = Json::array();
        size_t finished = 0;
        Progress progress(suite_.name, suite_.cases.size(), "cases", bench.quiet);
        for (const StabilityCase &tested : suite_.cases) {
            for (const Json &row : finished_part(bench.parts / (tested.name + ".json"),
                                                 [&] { return rows_of(tested, bench); })) {
                fmt::print("{} {}\n", row_passes(row, suite_.survey) ? "ok  " : "FAIL",
                           cells_of(row));
                rows.push_back(row);
            }
            std::fflush(stdout);
            progress.update(++finished);
        }
        return {{"experiment",
                 {{"name", suite_.name},
                  {"profile", suite_.profile},
                  {"bound", suite_.bound},
                  {"batches", batches}}},
                {"rows", rows}};
    }

    std::optional<bool> passes(const Json &row) const override {
        return row_passes(row, suite_.survey);
    }

  private:
    Json rows_of(const StabilityCase &tested, const Bench &bench) const {
        try {
            return measure_case(tested, family_alpha / static_cast<double>(tests_), bench.device,
                                bench.out / "images");
        } catch (const Error &error) {
            throw Error(error.exit_code(), fmt::format("case '{}': {}", tested.name, error.what()));
        }
    }

    StabilitySuite suite_;
    std::string inputs_;
    size_t renders_ = 0, tests_ = 0;
};

}  // namespace

std::unique_ptr<Experiment> make_stability(const DescriptionFile &file, const RunOptions &options) {
    return std::make_unique<Stability>(file, options);
}

}  // namespace rtrays
