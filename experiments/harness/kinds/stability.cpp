// SPDX-License-Identifier: MIT
#include "experiments/harness/kinds/stability.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <nlohmann/json.hpp>

#include "experiments/harness/core/agreement.h"
#include "experiments/harness/core/document.h"
#include "experiments/harness/core/host.h"
#include "experiments/harness/core/metrics.h"
#include "experiments/harness/core/resumption.h"
#include "experiments/harness/kinds/ladder.h"
#include "experiments/harness/kinds/stability_cases.h"
#include "reference/renderer.h"
#include "renderer/base/commit.h"
#include "renderer/base/files.h"
#include "renderer/base/progress.h"
#include "renderer/device/context.h"
#include "renderer/session/render_session.h"

namespace rtrays {

namespace fs = std::filesystem;

namespace {

constexpr uint64_t batches = 32;
constexpr int block_size = 8;          // pixels along a side
constexpr double family_alpha = 0.01;  // for all tests of a profile together (Bonferroni)
constexpr uint32_t renderer_seed = 31;
constexpr uint64_t reference_seed = 32;

/// Returns the means of a channel over every block and, last, over the full image.
std::vector<double> block_means(const Image &image, const std::string &channel) {
    const int columns = (image.width() + block_size - 1) / block_size,
              rows = (image.height() + block_size - 1) / block_size;
    std::vector<double> sums(static_cast<size_t>(columns * rows) + 1), pixels(sums.size());
    const std::vector<float> &values = image.channel(channel);
    for (size_t i = 0; i < values.size(); ++i) {
        const int x = static_cast<int>(i) % image.width(), y = static_cast<int>(i) / image.width();
        for (const size_t block :
             {static_cast<size_t>(y / block_size * columns + x / block_size), sums.size() - 1}) {
            sums[block] += static_cast<double>(values[i]);
            pixels[block] += 1;
        }
    }
    for (size_t block = 0; block < sums.size(); ++block) {
        sums[block] /= pixels[block];
    }
    return sums;
}

/// Returns the variances of the block means, assuming independent pixels.
std::vector<double> block_variances(const Image &image, const std::string &channel) {
    std::vector<double> variances = block_means(image, channel);
    for (size_t block = 0; block < variances.size(); ++block) {
        const bool whole = block + 1 == variances.size();
        const int across = whole ? image.width() : std::min(block_size, image.width());
        const int down = whole ? image.height() : std::min(block_size, image.height());
        variances[block] /= across * down;
    }
    return variances;
}

/// Moments of the batches' values of one block and channel.
struct Moments {
    double mean = 0, standard_error = 0, skewness = 0;
};

Moments moments_of(const std::vector<double> &values) {
    const auto n = static_cast<double>(values.size());
    Moments result;
    for (const double value : values) {
        result.mean += value / n;
    }
    double second = 0, third = 0;
    for (const double value : values) {
        second += std::pow(value - result.mean, 2) / n;
        third += std::pow(value - result.mean, 3) / n;
    }
    result.standard_error = std::sqrt(second / (n - 1));
    result.skewness = second > 0 ? third / std::pow(second, 1.5) : 0;
    return result;
}

/// Returns the mean variance of the pixels of an expected image.
double expected_error(const ExpectedImage &expected) {
    double sum = 0;
    for (const std::string &channel : rgb_names()) {
        const std::vector<double> means = expected.noisy
                                              ? block_means(expected.mean, "variance." + channel)
                                              : std::vector<double>{0};
        sum += means.back() / 3;
    }
    return sum;
}

/// Returns the mean squared error of the pixels, averaged over the batches. A noisy expected image
/// adds its variance on average, so this variance is subtracted.
double mean_squared_error(const std::vector<Image> &images, const ExpectedImage &expected) {
    double mse = -expected_error(expected);
    for (const Image &image : images) {
        mse += compute_metrics(image, expected.mean).mse / static_cast<double>(images.size());
    }
    return mse;
}

size_t tests_of(int size) {
    const auto across = static_cast<size_t>((size + block_size - 1) / block_size);
    return 3 * (across * across + 1);
}

}  // namespace

StabilityTest test_stability(const std::vector<Image> &images, const ExpectedImage &expected,
                             double bound, double within, double alpha) {
    if (images.size() < 2) {
        throw run_error("an interval needs at least two batches");
    }
    StabilityTest result;
    const double freedom = static_cast<double>(images.size() - 1);
    const double far = student_quantile_two_sided(1 - alpha, freedom),
                 near = student_quantile_two_sided(0.99, freedom);
    double error = 0;  // upper bound of the standard error of the mean over channels
    for (const std::string &channel : rgb_names()) {
        std::vector<std::vector<double>> by_batch;
        for (const Image &image : images) {
            by_batch.push_back(block_means(image, channel));
        }
        const std::vector<double> wanted = block_means(expected.mean, channel);
        const std::vector<double> noise =
            expected.noisy ? block_variances(expected.mean, "variance." + channel)
                           : std::vector<double>(wanted.size());
        for (size_t block = 0; block < wanted.size(); ++block) {
            std::vector<double> values;
            for (const auto &batch : by_batch) {
                values.push_back(batch[block]);
            }
            const Moments moments = moments_of(values);
            const double standard_error =
                std::hypot(moments.standard_error, std::sqrt(noise[block]));
            const double off = std::abs(moments.mean - wanted[block]),
                         allowed = bound * wanted[block];
            if (std::abs(moments.skewness) > AgreementPolicy().largest_skewness &&
                off + far * standard_error > allowed) {
                ++result.undecided;
            } else {
                ++result.tests;
                result.rejected += off - far * standard_error > allowed ? 1 : 0;
            }
            if (block + 1 == wanted.size()) {
                result.expected += wanted[block] / 3;
                result.measured += moments.mean / 3;
                error += standard_error / 3;
            }
        }
    }
    if (!(result.expected > 0)) {
        throw input_error("the expected image is black, so a relative difference is undefined");
    }
    const double difference = (result.measured - result.expected) / result.expected,
                 reach = near * error / result.expected;
    result.difference = {difference, difference - reach, difference + reach};
    result.mse = mean_squared_error(images, expected) / std::pow(result.expected, 2);
    result.mse_expected = expected_error(expected) / std::pow(result.expected, 2);
    result.verdict = result.rejected > 0                ? "off"
                     : result.tests <= result.undecided ? "undecided"
                     : reach > within                   ? "imprecise"
                                                        : "ok";
    return result;
}

namespace {

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
        render_whole(session, tested.first_sample + batch * tested.spp / batches,
                     tested.first_sample + (batch + 1) * tested.spp / batches);
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
    std::vector<Image> shifted;
    for (size_t i = 0; i < images.size(); ++i) {
        shifted.push_back(Image::rgb(mean.width(), mean.height()));
        for (const std::string &channel : rgb_names()) {
            std::vector<float> &values = shifted.back().channel(channel);
            for (size_t pixel = 0; pixel < values.size(); ++pixel) {
                values[pixel] = mean.channel(channel)[pixel] + (images[i].channel(channel)[pixel] -
                                                                others[i].channel(channel)[pixel]);
            }
        }
    }
    return shifted;
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
Json measure(const StabilityCase &tested, double alpha, DeviceContext &device,
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

bool passes(const Json &row, bool survey) {
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

std::string table_of(const Json &document) {
    std::string table = fmt::format(
        "# Stiff and extreme cases\n\nProfile {}, {} batches each, on {}.\n\n"
        "*expected* and *measured*: mean radiance over pixels and channels. *from*, *to*: 99 % "
        "interval of the relative difference. "
        "A case is *off* if a block of {} x {} pixels or the full image differs from the expected "
        "value in a channel by more than its bound ({:.0e} unless the case states one), at a level "
        "of {:.2g} over all tests. "
        "It is *imprecise* if its interval is wider than the case allows, and *undecided* if its "
        "batches are too skewed.\n\n"
        "| case | algorithm | against | expected | measured | from | to | verdict | not finite | "
        "saturated | |\n"
        "| --- | --- | --- | ---: | ---: | ---: | ---: | --- | ---: | ---: | --- |\n",
        document.at("profile").get<std::string>(), batches,
        document.at("device").get<std::string>(), block_size, block_size,
        document.at("bound").get<double>(), family_alpha);
    for (const Json &row : document.at("rows")) {
        table += "| " + cells_of(row) + " |\n";
    }
    std::string group;
    table += "\n";
    for (const Json &row : document.at("rows")) {
        if (row.at("group") != group) {
            group = row.at("group").get<std::string>();
            table += fmt::format("* `{}`: {}\n", group, row.at("title").get<std::string>());
        }
    }
    return table;
}

}  // namespace

bool is_stability(const fs::path &path) {
    const Json json = load_json(path);
    return json.is_object() &&
           fs::path(json.value("$schema", "")).filename() == "stability.schema.json";
}

ExitCode run_stability(const RunOptions &options) {
    const StabilitySuite suite = load_stability(options.experiment, options.profile);
    size_t rows = 0, tests = 0;
    for (const StabilityCase &tested : suite.cases) {
        rows += tested.runs.size();
        for (const StabilityRun &run : tested.runs) {
            tests += tests_of(run.settings.width);
        }
    }
    if (options.dry_run) {
        fmt::print("{}, profile {}: {} cases, {} renders of {} batches, {} tests\n", suite.name,
                   suite.profile, suite.cases.size(), rows, batches, tests);
        return ExitCode::ok;
    }
    DeviceContext device(options.device);
    if (options.compile) {
        for (const StabilityCase &tested : suite.cases) {
            const Scene scene = tested.scene.load();
            for (const StabilityRun &run : tested.runs) {
                compile_kernels(scene, run.settings, device);
            }
        }
        return ExitCode::ok;
    }
    const fs::path out =
        options.out.empty() ? fs::path(suite.name + "." + suite.profile) : options.out;
    const Resumption resumption(out, "stability.json",
                                read_file(options.experiment) + suite.profile, device.info());
    const auto conclude = [&](const Json &results) {
        const auto failed = std::count_if(results.begin(), results.end(), [&](const Json &row) {
            return !passes(row, suite.survey);
        });
        fmt::print("{} of {} rows failed; see {}\n", failed, results.size(),
                   (out / "stability.md").string());
        return failed > 0 ? ExitCode::regression : ExitCode::ok;
    };
    if (const Json document = resumption.finished(); !document.is_null()) {
        return conclude(document.at("rows"));
    }
    fs::create_directories(out / "images");
    Json document = {{"schema_version", 1},
                     {"commit", commit()},
                     {"dirty", built_from_changed_sources()},
                     {"device", device.info().name},
                     {"host", describe_host()},
                     {"profile", suite.profile},
                     {"bound", suite.bound},
                     {"batches", batches},
                     {"rows", Json::array()}};
    size_t finished = 0;
    Progress progress(suite.name, suite.cases.size(), "cases", options.quiet);
    for (const StabilityCase &tested : suite.cases) {
        const fs::path done = resumption.parts() / (tested.name + ".json");
        if (!fs::exists(done)) {
            try {
                write_file(done, measure(tested, family_alpha / static_cast<double>(tests), device,
                                         out / "images")
                                         .dump(1) +
                                     "\n");
            } catch (const Error &error) {
                throw Error(error.exit_code(),
                            fmt::format("case '{}': {}", tested.name, error.what()));
            }
        }
        for (const Json &row : load_json(done)) {
            fmt::print("{} {}\n", passes(row, suite.survey) ? "ok  " : "FAIL", cells_of(row));
            document["rows"].push_back(row);
        }
        std::fflush(stdout);
        progress.update(++finished);
    }
    write_file(out / "stability.md", table_of(document));
    resumption.finish(document);
    return conclude(document["rows"]);
}

}  // namespace rtrays
