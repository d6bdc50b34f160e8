// SPDX-License-Identifier: MIT
// Tests the exact sums of the film, with the device code on the host and on the device, and the
// film state that is saved, resumed and merged.
#define FEATURE_variance 1
#define FEATURE_int64_atomics 1
#include "testing/other_features.h"

#include "renderer/kernels/film/film.h"

#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <limits>
#include <random>
#include <tuple>

#include "renderer/base/files.h"
#include "renderer/device/kernel.h"
#include "renderer/film/film.h"
#include "renderer/testing/errors.h"

namespace rtrays {
namespace {

constexpr size_t pixel_words = FILM_PIXEL_WORDS(true, false);

FilmState empty_film() {
    FilmState film;
    film.width = film.height = 1;
    film.seed = 7;
    film.config = {{"integrator.beta", "2"}};
    film.words.assign(pixel_words, 0);
    return film;
}

void carry_pixel(std::vector<int64_t> &words) {
    for (uint32_t sum = 0; sum < PIXEL_SUMS; ++sum) {
        film_carry_sum(words.data(), PIXEL_SUMS, sum, film_step(sum, HOLDS_SQUARES));
    }
}

FilmState film_of(const std::vector<float> &samples) {
    FilmState film = empty_film();
    for (const float x : samples) {
        EXPECT_EQ(film_add_sample(film.words.data(), make_float3(x, -x, 0.5f * x)), 0u);
    }
    carry_pixel(film.words);
    film.add_range({0, samples.size()});
    return film;
}

/// Returns samples of both signs over many decades.
std::vector<float> heavy_tailed(size_t count, uint32_t seed) {
    std::mt19937 generator(seed);
    std::normal_distribution<float> normal;
    std::vector<float> samples(count);
    for (float &x : samples) {
        x = normal(generator) * std::exp(5.0f * normal(generator));
    }
    return samples;
}

float mean_of(const std::vector<float> &samples) {
    return develop_film(film_of(samples)).channel("R")[0];
}

TEST(Film, TwoHundredThousandEqualSamplesAverageToTheSample) {
    // A plain float sum would be off by 0.2 % here.
    EXPECT_EQ(mean_of(std::vector<float>(200000, 0.1f)), 0.1f);
    EXPECT_EQ(mean_of(std::vector<float>(200000, 1.0f / 3.0f)), 1.0f / 3.0f);
}

TEST(Film, MovesWhatFillsAWordToTheNext) {
    // Just below the limits of words, where 2^19 additions overflow.
    for (const float x : {0x1.fffffep-41f, 0x1.fffffep-1f, 0x1.fffffep19f}) {
        EXPECT_EQ(mean_of(std::vector<float>(3 << 20, x)), x);
    }
}

TEST(Film, KeepsSmallSamplesBesideAFirefly) {
    std::vector<float> samples(200000, 1e-3f);
    samples[100000] = 1e8f;
    double exact = 0;
    for (const float x : samples) {
        exact += static_cast<double>(x);
    }
    EXPECT_EQ(mean_of(samples), static_cast<float>(exact / 200000.0));
    // Subtracting the firefly must leave exactly the sum without it.
    FilmState film = film_of(samples);
    film_add_value(film.words.data(), PIXEL_SUMS, -1e8f, FILM_SUM_LOWEST, FILM_SUM_STEP);
    carry_pixel(film.words);
    std::vector<float> rest(199999, 1e-3f);
    FilmState without = film_of(rest);
    for (size_t k = 0; k < FILM_WORDS; ++k) {
        EXPECT_EQ(film.words[k * PIXEL_SUMS], without.words[k * PIXEL_SUMS]);
    }
}

TEST(Film, MatchesFloat64OverSeventeenDecades) {
    std::mt19937 generator(1);
    std::uniform_real_distribution<float> exponent(-20.0f, 20.0f);
    std::vector<float> samples(200000);
    long double sum = 0;
    for (float &x : samples) {
        x = std::exp(exponent(generator));
        sum += static_cast<long double>(x);
    }
    const auto expected = static_cast<double>(sum / 200000.0L);
    EXPECT_NEAR(mean_of(samples), expected, 1e-7 * expected);
}

TEST(Film, DoesNotDependOnTheOrderOfAdditions) {
    std::vector<float> samples = heavy_tailed(5000, 2);
    const FilmState first = film_of(samples);
    std::shuffle(samples.begin(), samples.end(), std::mt19937(2));
    EXPECT_EQ(film_of(samples).words, first.words);
}

TEST(Film, HoldsEveryFiniteMagnitudeBelowItsLimit) {
    for (const float x : {0.0f, -0.0f, 1.4e-45f, 1e-38f, 0x1p-60f, 0x1.fffffep-41f, 0x1p-40f, 1.0f,
                          0x1.fffffep-1f, 0x1p19f, 0x1.fffffep39f}) {
        const double mean = static_cast<double>(mean_of({x}));
        EXPECT_NEAR(mean, static_cast<double>(x), 0x1p-105) << x;
        EXPECT_EQ(mean_of({x, -x}), 0.0f);
    }
}

TEST(Film, ReportsWhatItCannotHold) {
    std::vector<int64_t> words(pixel_words, 0);
    const float infinity = std::numeric_limits<float>::infinity();
    EXPECT_EQ(film_add_sample(words.data(), make_float3(0.0f, NAN, 0.0f)), FILM_NON_FINITE);
    EXPECT_EQ(film_add_sample(words.data(), make_float3(infinity, 0.0f, 0.0f)), FILM_NON_FINITE);
    EXPECT_EQ(film_add_sample(words.data(), make_float3(0.0f, 0.0f, 0x1p40f)), FILM_OUT_OF_RANGE);
    EXPECT_EQ(words, std::vector<int64_t>(pixel_words, 0)) << "nothing must be added";

    FilmState film = empty_film();
    EXPECT_NO_THROW(require_valid(film));
    film.non_finite = 3;
    expect_run_error("3 samples were not finite and 0 beyond", [&] { require_valid(film); });
    film.non_finite = 0;
    film.out_of_range = 2;
    expect_run_error("0 samples were not finite and 2 beyond", [&] { require_valid(film); });
}

TEST(Film, VarianceOfTheMean) {
    std::mt19937 generator(3);
    std::lognormal_distribution<float> distribution(-3.0f, 1.5f);
    std::vector<float> samples(10000);
    for (float &x : samples) {
        x = distribution(generator);
    }
    double mean = 0, square = 0;
    for (const float x : samples) {
        mean += static_cast<double>(x) / 10000.0;
    }
    for (const float x : samples) {
        square += std::pow(static_cast<double>(x) - mean, 2.0);
    }
    const double expected = square / 9999.0 / 10000.0;
    EXPECT_NEAR(develop_film(film_of(samples)).channel("variance.R")[0], expected, 1e-5 * expected);
    EXPECT_EQ(develop_film(film_of(std::vector<float>(100, 0.25f))).channel("variance.R")[0], 0.0f);
}

/// Returns a film of Sobol sequences: `samples` are those of `ranges`, in order.
FilmState film_of_sequences(const std::vector<float> &samples,
                            const std::vector<SampleRange> &ranges) {
    FilmState film = empty_film();
    film.sequences = true;
    film.words.assign(FILM_PIXEL_WORDS(true, true), 0);
    constexpr uint32_t sums = FILM_PIXEL_SUMS(true, true);
    size_t next = 0;
    for (const SampleRange &range : ranges) {
        film.add_range(range);
        for (uint64_t i = range.begin; i < range.end; ++i) {
            const float x = samples.at(next++);
            film_add_colour(film.words.data() + i % SOBOL_SEQUENCES * FILM_CHANNELS, sums,
                            make_float3(x, -x, 0.5f * x));
        }
    }
    for (uint32_t sum = 0; sum < sums; ++sum) {
        film_carry_sum(film.words.data(), sums, sum, FILM_SUM_STEP);
    }
    return film;
}

// The means of the sequences, not the samples, are independent.
TEST(Film, VarianceOfSequencesIsTheScatterOfTheirMeans) {
    ASSERT_EQ(SOBOL_SEQUENCES, 2u);
    const Image even = develop_film(film_of_sequences({1, 2, 3, 6, 3, 4, 5, 8}, {{4, 12}}));
    EXPECT_EQ(even.channel("R")[0], 4.0f);
    EXPECT_EQ(even.channel("variance.R")[0], 1.0f) << "means 3 and 5";
    EXPECT_EQ(even.channel("variance.B")[0], 0.25f);
    // Sample 3 is of sequence 1, samples 4 and 8 are of sequence 0.
    const Image uneven = develop_film(film_of_sequences({9, 1, 2}, {{3, 5}, {8, 9}}));
    EXPECT_EQ(uneven.channel("R")[0], 4.0f);
    EXPECT_EQ(uneven.channel("variance.R")[0], (25 + 2 * 2.5f * 2.5f) / 1 / 3) << "means 9, 1.5";
    EXPECT_EQ(develop_film(film_of_sequences({7}, {{2, 3}})).channel("variance.R")[0], 0.0f);
}

TEST(Film, SequencesDoNotChangeTheMean) {
    const std::vector<float> samples = heavy_tailed(1000, 6);
    const Image sequences = develop_film(film_of_sequences(samples, {{0, 1000}}));
    const Image squares = develop_film(film_of(samples));
    for (const std::string &name : rgb_names()) {
        EXPECT_EQ(sequences.channel(name)[0], squares.channel(name)[0]);
    }
    FilmState parts = film_of_sequences({samples.begin(), samples.begin() + 333}, {{0, 333}});
    merge_film(parts, film_of_sequences({samples.begin() + 333, samples.end()}, {{333, 1000}}));
    EXPECT_EQ(parts.words, film_of_sequences(samples, {{0, 1000}}).words);
    FilmState other = film_of(samples);
    expect_input_error("films differ in sums of sequences (no and yes)",
                       [&] { merge_film(other, parts); });
}

TEST(Film, MergesExactlyInAnyOrder) {
    std::mt19937 generator(4);
    std::uniform_real_distribution<float> uniform(0.0f, 3.0f);
    std::vector<float> samples(300);
    std::generate(samples.begin(), samples.end(), [&] { return uniform(generator); });
    const auto part = [&](size_t begin, size_t end) {
        FilmState film = film_of(
            {samples.begin() + static_cast<long>(begin), samples.begin() + static_cast<long>(end)});
        film.ranges = {{begin, end}};
        return film;
    };
    FilmState forward = part(0, 100), backward = part(200, 300);
    merge_film(forward, part(100, 200));
    merge_film(forward, part(200, 300));
    merge_film(backward, part(100, 200));
    merge_film(backward, part(0, 100));
    EXPECT_EQ(forward.words, film_of(samples).words);
    EXPECT_EQ(backward.words, forward.words);
    EXPECT_EQ(backward.ranges.size(), 1u);
    EXPECT_EQ(backward.samples(), 300u);
}

TEST(Film, RefusesWhatDoesNotBelongTogether) {
    FilmState film = film_of({1.0f, 2.0f});
    const FilmState before = film;
    expect_input_error("samples 0:1 overlap 0:2", [&] { merge_film(film, film_of({1.0f})); });
    const auto refuse = [&](const char *what, auto &&change) {
        FilmState other = empty_film();
        EXPECT_NO_THROW(merge_film(film, other));
        change(other);
        expect_input_error(std::string("films differ in ") + what,
                           [&] { merge_film(film, other); });
    };
    refuse("size (1 x 1 and 2 x 1)", [](FilmState &other) { other.width = 2; });
    refuse("sums for variances (yes and no)", [](FilmState &other) { other.variance = false; });
    refuse("seed (7 and 8)", [](FilmState &other) { other.seed = 8; });
    refuse("integrator.beta (2 and 1)",
           [](FilmState &other) { other.config["integrator.beta"] = "1"; });
    refuse("crop (none and 0 0 of 4 x 4)",
           [](FilmState &other) { other.config["crop"] = "0 0 of 4 x 4"; });
    refuse("integrator.beta (2 and none)", [](FilmState &other) {
        other.config = {};
        other.seed = 8;
    });
    refuse("passes (camera and camera and light)", [](FilmState &other) {
        other.passes = {PassKind::camera, PassKind::light};
    });
    EXPECT_EQ(film.words, before.words);
    EXPECT_EQ(film.samples(), 2u);
}

TEST(Film, SavesAndLoadsEveryBitAndNoticesDamage) {
    const auto path =
        std::filesystem::temp_directory_path() / ("rtrays_film_" + std::to_string(getpid()));
    FilmState film = film_of({0.5f, 1e-30f, 1e10f});
    save_film(film_of_sequences({0.5f, 1e-30f, 1e10f}, {{0, 3}}), path);
    EXPECT_TRUE(load_film(path).sequences);
    EXPECT_EQ(load_film(path).words, film_of_sequences({0.5f, 1e-30f, 1e10f}, {{0, 3}}).words);
    film.ranges = {{0, 1}, {7, 9}};
    film.device_seconds = 1.5;
    film.wall_seconds = 0.1;
    film.non_finite = 4;
    film.out_of_range = 5;
    save_film(film, path);
    const FilmState loaded = load_film(path);
    EXPECT_EQ(loaded.words, film.words);
    EXPECT_EQ(std::tie(loaded.width, loaded.height, loaded.variance, loaded.seed, loaded.config),
              std::tie(film.width, film.height, film.variance, film.seed, film.config));
    EXPECT_EQ(std::tie(loaded.device_seconds, loaded.wall_seconds, loaded.non_finite,
                       loaded.out_of_range),
              std::tie(film.device_seconds, film.wall_seconds, film.non_finite, film.out_of_range));
    ASSERT_EQ(loaded.ranges.size(), 2u);
    EXPECT_EQ(loaded.ranges[1].begin, 7u);
    EXPECT_EQ(loaded.samples(), 3u);

    const std::string content = read_file(path);
    for (const size_t length : {size_t{0}, size_t{10}, size_t{40}, content.size() - 1}) {
        write_file(path, content.substr(0, length));
        expect_input_error(length < 42 ? "not a film state" : "truncated or damaged",
                           [&] { load_film(path); });
    }
    std::string damaged = content;
    damaged.back() = static_cast<char>(damaged.back() ^ 1);
    write_file(path, damaged);
    expect_input_error("truncated or damaged", [&] { load_film(path); });
    std::filesystem::remove(path);
}

// Many concurrent work-items add the same bits, with 64-bit atomics and with the 32-bit fallback.
TEST(Film, DeviceAddsTheSameBitsWithAndWithout64BitAtomics) {
    std::vector<float> samples = heavy_tailed(20000, 5);
    samples.resize(1 << 20, 0x1.fffffep-1f);  // fills a word many times
    const std::vector<int64_t> expected = film_of(samples).words;
    const SourceOverlays source = {{"kernels/test.cl", R"(
#include "kernels/film/film.h"
__kernel void test(__global const float *samples, __global long *film, uint count) {
    const uint i = get_global_id(0);
    if (i < count) film_add_sample(film, make_float3(samples[i], -samples[i], 0.5f * samples[i]));
})"}};
    DeviceContext device;
    for (const char *atomics : {"1", "0"}) {
        if (std::string(atomics) == "1" && !device.info().has_int64_atomics) {
            continue;
        }
        const Program program(device, {"kernels/test.cl"},
                              {{"FEATURE_variance", "1"},
                               {"FEATURE_sequences", "0"},
                               {"FEATURE_int64_atomics", atomics}},
                              source);
        Kernel kernel(program, "test", 64);
        const Buffer<float> input(device, "samples", samples);
        Buffer<int64_t> film(device, "film", std::vector<int64_t>(pixel_words, 0));
        kernel.bind({input, film, static_cast<uint32_t>(samples.size())});
        kernel.enqueue(samples.size());
        device.finish();
        std::vector<int64_t> words = film.read();
        carry_pixel(words);
        EXPECT_EQ(words, expected) << "int64 atomics " << atomics;
    }
}

}  // namespace
}  // namespace rtrays
