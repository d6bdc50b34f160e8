// SPDX-License-Identifier: MIT
// Tests convergence control in the pipeline: when pixels stop, that their values do not change
// otherwise, and that no bit depends on the partition of the work.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>
#include <set>

#include "renderer/device/context.h"
#include "renderer/film/film.h"
#include "renderer/import/load_scene.h"
#include "renderer/session/render_session.h"
#include "renderer/shared/film_layout.h"
#include "renderer/testing/errors.h"
#include "renderer/testing/temporary_folder.h"

namespace rtrays {
namespace {

constexpr uint64_t start = 24, interval = 8, end = 72;

DeviceContext &device() {
    static DeviceContext context;
    return context;
}

Scene cornell_box() {
    return load_scene(RTRAYS_SCENES "/cornell_box/scene.json");
}

RenderSettings small(const std::vector<std::string> &assignments = {},
                     const std::string &algorithm = "path_tracing") {
    RenderSettings settings;
    settings.algorithm = &algorithm_named(algorithm);
    settings.width = settings.height = 32;
    settings.stream_capacity = 512;
    settings.convergence_start = start;
    settings.convergence_interval = interval;
    for (const std::string &assignment : assignments) {
        apply_setting(settings, assignment);
    }
    return settings;
}

RenderSettings controlled(std::vector<std::string> assignments = {},
                          const std::string &algorithm = "path_tracing") {
    assignments.emplace_back("integrator.convergence.error=0.1");
    return small(assignments, algorithm);
}

FilmState render(const RenderSettings &settings, const std::vector<SampleRange> &ranges) {
    RenderSession session(cornell_box(), settings, device());
    for (const SampleRange &range : ranges) {
        session.render(range.begin, range.end);
    }
    FilmState film = session.film();
    require_valid(film);
    return film;
}

std::vector<int64_t> pixel_words(const FilmState &film, size_t pixel) {
    const auto first =
        film.words.begin() + static_cast<long>(pixel * FILM_PIXEL_WORDS(true, false));
    return {first, first + FILM_PIXEL_WORDS(true, false)};
}

void expect_same(const FilmState &a, const FilmState &b, const std::string &what) {
    EXPECT_EQ(a.words, b.words) << what;
    ASSERT_TRUE(a.convergence && b.convergence) << what;
    EXPECT_EQ(a.convergence->stopped_at, b.convergence->stopped_at) << what;
    EXPECT_EQ(a.convergence->half_words, b.convergence->half_words) << what;
}

TEST(Convergence, GivesTheSameBitsHoweverTheWorkIsCut) {
    for (const char *algorithm : {"path_tracing", "truncated_bdpt"}) {
        const FilmState whole = render(controlled({}, algorithm), {{0, end}});
        const std::set<uint64_t> stops(whole.convergence->stopped_at.begin(),
                                       whole.convergence->stopped_at.end());
        ASSERT_EQ(stops.size(), (end - start) / interval + 2)
            << "pixels must stop at every check, and some must not stop";
        // These settings are tested together, because most of them recompile every stage. Any
        // change of the image would show.
        std::vector<std::string> cut = {"device.group_size=16", "device.stream_capacity=3000"};
        if (algorithm == std::string("path_tracing")) {  // both have this camera pass
            cut.insert(cut.end(), {"device.stream_chunk=7", "device.path_layout=arrays"});
            for (const char *assignment : {"device.features=all", "device.pipeline=megakernel"}) {
                expect_same(render(controlled({assignment}, algorithm), {{0, end}}), whole,
                            assignment);
            }
        }
        expect_same(render(controlled(cut, algorithm), {{0, end}}), whole,
                    algorithm + std::string(" cut otherwise"));
        // Split the samples before, at and after checks.
        const std::vector<SampleRange> cuts = {
            {0, start - 1}, {start - 1, start}, {start, start + 5}, {start + 5, end}};
        expect_same(render(controlled({}, algorithm), cuts), whole,
                    std::string(algorithm) + " in parts");
    }
}

// A stopped pixel has the value that it has without control after the same number of samples. It
// stopped there because the mean of all samples and the mean of every other sample differ by less
// than the error. Here, separate renders give these means, which are compared in double precision.
TEST(Convergence, StopsEachPixelWhereItsMeansSay) {
    const FilmState film = render(controlled(), {{0, end}});
    const std::vector<uint64_t> &stopped_at = film.convergence->stopped_at;
    RenderSession free(cornell_box(), small(), device());
    RenderSession half(cornell_box(), small(), device());
    std::vector<bool> stopped(stopped_at.size());
    uint64_t paths = 0;
    size_t decisions = 0;
    for (uint64_t samples = 0; samples < end; ++samples) {
        free.render(samples, samples + 1);
        if (samples % 2 == 0) {
            half.render(samples, samples + 1);
        }
        if (samples + 1 < start || (samples + 1 - start) % interval != 0) {
            continue;
        }
        const FilmState so_far = free.film();
        const Image all = develop_film(so_far), every_other = develop_film(half.film());
        for (size_t pixel = 0; pixel < stopped_at.size(); ++pixel) {
            if (stopped[pixel]) {
                continue;
            }
            double change = 0, norm = 0;
            for (const std::string &channel : rgb_names()) {
                const auto mean = static_cast<double>(every_other.channel(channel)[pixel]);
                change += std::pow(static_cast<double>(all.channel(channel)[pixel]) - mean, 2);
                norm += mean * mean;
            }
            const double relative = std::sqrt(change / norm);  // NaN for a black pixel: not below
            stopped[pixel] = stopped_at[pixel] == samples + 1;
            if (std::abs(relative - 0.1) > 1e-5) {  // rounding does not decide
                ASSERT_EQ(stopped[pixel], relative < 0.1) << pixel << " at " << samples + 1;
                ++decisions;
            }
            if (stopped[pixel]) {
                ASSERT_EQ(pixel_words(film, pixel), pixel_words(so_far, pixel))
                    << pixel << " at " << samples + 1;
                paths += samples + 1;
            }
        }
    }
    const FilmState last = free.film();
    for (size_t pixel = 0; pixel < stopped_at.size(); ++pixel) {
        if (!stopped[pixel]) {
            ASSERT_EQ(pixel_words(film, pixel), pixel_words(last, pixel)) << pixel;
            paths += end;
        }
    }
    EXPECT_GT(decisions, 2000u);
    EXPECT_EQ(film.convergence->camera_paths(end), paths);
}

TEST(Convergence, StopsAllThatIsNotBlackAtTheFirstCheckOfAHugeError) {
    RenderSettings settings = small();
    settings.convergence_error = 1e30f;
    RenderSession session(cornell_box(), settings, device());
    session.render(0, end);
    const FilmState film = session.film(), at_start = render(small(), {{0, start}});
    std::vector<SampleRange> even;
    for (uint64_t sample = 0; sample < start; sample += 2) {
        even.push_back({sample, sample + 1});
    }
    const Image image = session.develop(), every_other = develop_film(render(small(), even));
    const std::vector<std::string> channels = rgb_names();
    size_t live = 0, late = 0;
    uint64_t paths = 0;
    for (size_t pixel = 0; pixel < image.pixel_count(); ++pixel) {
        const uint64_t stopped_at = film.convergence->stopped_at[pixel];
        const bool black = std::all_of(
            channels.begin(), channels.end(),
            [&](const std::string &channel) { return every_other.channel(channel)[pixel] == 0; });
        ASSERT_EQ(stopped_at == start, !black) << pixel;
        live += stopped_at == 0;
        late += black;
        if (!black) {
            ASSERT_EQ(pixel_words(film, pixel), pixel_words(at_start, pixel)) << pixel;
        }
        ASSERT_EQ(image.channel("samples")[pixel],
                  static_cast<float>(stopped_at == 0 ? end : stopped_at));
        paths += stopped_at == 0 ? end : stopped_at;
    }
    EXPECT_GT(late, 0u) << "some pixels are black at first";
    EXPECT_LT(late, image.pixel_count() / 10);
    EXPECT_EQ(session.stats().samples, paths) << "no more paths are traced";
    const nlohmann::json report = session.report();
    EXPECT_EQ(report["samples"], paths);
    EXPECT_EQ(report["convergence"]["camera_paths"], paths);
    EXPECT_EQ(report["convergence"]["checks"].size(), (end - start) / interval + 1);
    EXPECT_EQ(report["convergence"]["checks"].back()["live"],
              static_cast<double>(live) / static_cast<double>(image.pixel_count()));
    EXPECT_EQ(std::get<std::string>(image.attributes().at("rtrays:convergence")),
              "biased by convergence control: error 1e+30, interval 8, start 24");
    EXPECT_EQ(session.is_complete(), live == 0);
}

TEST(Convergence, ATinyErrorStopsNothing) {
    const FilmState film =
        render(small({"integrator.convergence.error=1e-30"}, "truncated_bdpt"), {{0, end}});
    const FilmState free = render(small({}, "truncated_bdpt"), {{0, end}});
    EXPECT_EQ(film.words, free.words);
    EXPECT_EQ(film.convergence->camera_paths(end), end * 32 * 32);
}

TEST(Convergence, StopsTheSamePixelsWithoutSecondMoments) {
    RenderSettings settings = controlled();
    const FilmState film = render(settings, {{0, end}});
    settings.variance = false;
    const FilmState lean = render(settings, {{0, end}});
    EXPECT_EQ(lean.convergence->stopped_at, film.convergence->stopped_at);
    EXPECT_EQ(develop_film(lean).channel("G"), develop_film(film).channel("G"));
}

TEST(Convergence, WorksOnSobolSamples) {
    const FilmState film = render(controlled({"integrator.sampler=sobol"}), {{0, end}});
    expect_same(render(controlled({"integrator.sampler=sobol", "device.group_size=16"}),
                       {{0, 50}, {50, end}}),
                film, "sobol");
    EXPECT_LT(film.convergence->camera_paths(end), end * 32 * 32);
    EXPECT_NE(film.words, render(controlled(), {{0, end}}).words);
}

TEST(Convergence, ResumesToTheSameBits) {
    const TemporaryFolder folder;
    const FilmState whole = render(controlled(), {{0, end}});
    for (const uint64_t cut : {start - 3, start, start + interval + 3}) {
        const auto path = folder.path() / "film";
        save_film(render(controlled(), {{0, cut}}), path);
        RenderSession session(cornell_box(), controlled(), device());
        session.restore(load_film(path));
        session.render(cut, end);
        expect_same(session.film(), whole, "resumed at " + std::to_string(cut));
        EXPECT_EQ(session.film().samples(), end);
    }
    // A restarted session has no stopped pixels.
    RenderSession session(cornell_box(), controlled(), device());
    session.render(0, end);
    session.restart(1);
    session.render(0, end);
    expect_same(session.film(), whole, "restarted");
}

TEST(Convergence, StopsCameraPathsAloneInTruncatedBdpt) {
    const FilmState both = render(controlled({}, "truncated_bdpt"), {{0, end}});
    const FilmState free = render(small({}, "truncated_bdpt"), {{0, end}});
    const auto half = [](const FilmState &film, size_t pass) {
        const auto size = static_cast<long>(film.words.size() / 2);
        const auto first = film.words.begin() + static_cast<long>(pass) * size;
        return std::vector<int64_t>(first, first + size);
    };
    EXPECT_NE(half(both, 0), half(free, 0));
    EXPECT_EQ(half(both, 1), half(free, 1)) << "all samples have light paths";
    // The passes are rendered separately, and the light pass in two ranges.
    RenderSettings settings = controlled({}, "truncated_bdpt");
    settings.only_pass = PassKind::camera;
    FilmState camera = render(settings, {{0, end}});
    settings.only_pass = PassKind::light;
    FilmState light = render(settings, {{30, end}});
    EXPECT_FALSE(light.convergence);
    merge_film(light, render(settings, {{0, 30}}));
    merge_film(light, camera);
    expect_same(light, both, "merged");
}

TEST(Convergence, LeavesNothingBehindWhereItIsOff) {
    const auto mentions = [](const nlohmann::json &report, const std::string &what) {
        return report.dump().find(what) != std::string::npos;
    };
    const nlohmann::json off =
        RenderSession(cornell_box(), small({"device.features=all"}), device()).report();
    RenderSession session(cornell_box(), controlled(), device());
    session.render(0, start);
    const nlohmann::json on = session.report();
    for (const char *what :
         {"half_film", "stopped_at", "live_pixels", "stop_converged", "list_live_pixels"}) {
        EXPECT_TRUE(mentions(on, what)) << what;
        EXPECT_FALSE(mentions(off, what)) << what;
    }
    EXPECT_EQ(off["bytes_per_path"],
              RenderSession(cornell_box(), controlled({"device.features=all"}), device())
                  .report()["bytes_per_path"]);
    EXPECT_FALSE(off.contains("convergence"));
}

TEST(Convergence, RefusesWhatItCannotDo) {
    for (const char *algorithm : {"ray_casting", "whitted", "light_tracing", "bdpt"}) {
        expect_input_error(
            algorithm +
                std::string(
                    " does not support convergence control; path_tracing and truncated_bdpt do"),
            [&] { require_consistent(controlled({}, algorithm)); });
        EXPECT_NO_THROW(require_consistent(small({}, algorithm)));
    }
    RenderSettings separate = controlled();
    separate.separate_strategies = true;
    separate.variance = false;
    expect_input_error("which layers of strategies split", [&] { require_consistent(separate); });
    for (const char *assignment :
         {"integrator.convergence.start=25", "integrator.convergence.interval=0"}) {
        expect_input_error("must be even and not 0",
                           [&] { require_consistent(controlled({assignment})); });
    }
    for (const char *assignment :
         {"integrator.convergence.error=-1", "integrator.convergence.error=nan"}) {
        expect_input_error("0 or a number above 0", [&] { small({assignment}); });
    }
    EXPECT_TRUE(has_convergence_control(controlled()));
    EXPECT_FALSE(has_convergence_control(small({"integrator.convergence.error=0"})));
    RenderSession session(cornell_box(), controlled(), device());
    expect_input_error("in order; the film has 0: expected sample 0, got 4",
                       [&] { session.render(4, 8); });
    session.render(0, 8);
    expect_input_error("expected sample 8, got 16", [&] { session.render(16, 24); });
    EXPECT_EQ(session.render(4, 4), 4u) << "an empty range";
    FilmState film = session.film();
    film.convergence.reset();
    expect_input_error("rendered with stopped pixels = no, and this render has yes",
                       [&] { session.restore(film); });
}

}  // namespace
}  // namespace rtrays
