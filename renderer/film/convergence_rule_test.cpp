// SPDX-License-Identifier: MIT
// Tests the convergence criterion of pixels on hand-made films against closed forms, with the
// device code on the host and on the device. Also tests the list of live pixels.
#define FEATURE_variance 1
#define FEATURE_int64_atomics 1
#include "testing/other_features.h"

#include "renderer/kernels/film/convergence.h"

#include <gtest/gtest.h>

#include <cmath>
#include <nlohmann/json.hpp>
#include <random>

#include "renderer/film/convergence_control.h"
#include "renderer/film/film.h"
#include "renderer/shared/live_pixels.h"
#include "renderer/testing/errors.h"
#include "renderer/testing/temporary_folder.h"

namespace rtrays {
namespace {

/// A film of some pixels, and the half film of the samples with even indices.
struct Films {
    explicit Films(size_t pixels)
        : film(pixels * PIXEL_WORDS), half(pixels * HALF_FILM_PIXEL_WORDS), counts(pixels) {}

    void add(size_t pixel, float3 sample) {
        EXPECT_EQ(film_add_sample(film.data() + pixel * PIXEL_WORDS, sample), 0u);
        EXPECT_EQ(half_film_add_sample(half.data(), pixel, counts[pixel]++, sample), 0u);
    }

    /// Propagates carries in all pixels. `stride` is the number of sums per pixel.
    static void carry(std::vector<int64_t> &words, uint32_t stride) {
        for (size_t pixel = 0; pixel < words.size(); pixel += FILM_WORDS * stride) {
            for (uint32_t sum = 0; sum < stride; ++sum) {
                film_carry_sum(words.data() + pixel, stride, sum,
                               film_step(sum, stride > FILM_CHANNELS));
            }
        }
    }

    bool converged(size_t pixel, float error) {
        carry(film, PIXEL_SUMS);
        carry(half, HALF_FILM_SUMS);
        return has_converged(
            film_colour_sum(film.data() + pixel * PIXEL_WORDS, PIXEL_SUMS, 1),
            film_colour_sum(half.data() + pixel * HALF_FILM_PIXEL_WORDS, HALF_FILM_SUMS, 1), error);
    }

    std::vector<int64_t> film, half;
    std::vector<uint64_t> counts;
};

float3 grey(float value) {
    return make_float3(value, value, value);
}

/// Returns whether a pixel of 2N samples has converged. `even` and `odd` return the i-th sample
/// with an even or odd index.
template <class Even, class Odd>
bool stops(float error, int n, const Even &even, const Odd &odd) {
    Films films(1);
    for (int i = 0; i < n; ++i) {
        films.add(0, even(i));
        films.add(0, odd(i));
    }
    return films.converged(0, error);
}

TEST(ConvergenceRule, ComparesAllSamplesWithHalfOfThem) {
    // I_N = 1, I_2N = 1.02.
    const auto even = [](int) { return grey(1.0f); };
    const auto odd = [](int) { return grey(1.04f); };
    for (const int n : {1, 25, 1000}) {
        EXPECT_TRUE(stops(0.0201f, n, even, odd)) << n;
        EXPECT_FALSE(stops(0.0199f, n, even, odd)) << n;
    }
    // The change is relative to the half film: I_N = 1.04 and I_2N = 1.02 give 0.01923.
    EXPECT_TRUE(stops(0.01925f, 10, odd, even));
    EXPECT_FALSE(stops(0.0192f, 10, odd, even));
}

TEST(ConvergenceRule, TakesTheEuclideanNormOverTheChannels) {
    // |I_N| = 5, and a black channel changes by 0.5.
    const auto even = [](int) { return make_float3(3.0f, 4.0f, 0.0f); };
    const auto odd = [](int) { return make_float3(3.0f, 4.0f, 1.0f); };
    EXPECT_TRUE(stops(0.101f, 8, even, odd));
    EXPECT_FALSE(stops(0.099f, 8, even, odd));
}

TEST(ConvergenceRule, StopsWhatDoesNotChangeAndNeverWhatIsBlack) {
    const auto constant = [](int) { return make_float3(0.1f, 0.7f, 3.0f); };
    const auto black = [](int) { return grey(0.0f); };
    EXPECT_TRUE(stops(1e-5f, 100, constant, constant));
    EXPECT_FALSE(stops(1e30f, 100, black, black));
    EXPECT_FALSE(stops(1e30f, 100, black, constant)) << "a black half film gives no information";
    EXPECT_TRUE(stops(0.5001f, 100, constant, black)) << "losing half the light is a change of 1/2";
    EXPECT_FALSE(stops(0.4999f, 100, constant, black));
}

TEST(ConvergenceRule, GoesOnAfterAFirefly) {
    // All samples are 1 except for one of value F, with N = 100. The change |I_2N - I_N| / |I_N| is
    // (F - 1) / (2 (N - 1 + F)) if F is in the half film, else (F - 1) / (2 N).
    const float f = 1e6f;
    const auto ones = [](int) { return grey(1.0f); };
    const auto firefly = [&](int i) { return grey(i == 57 ? f : 1.0f); };
    EXPECT_TRUE(stops(0.01f, 100, ones, ones));
    EXPECT_FALSE(stops(0.4999f, 100, firefly, ones));
    EXPECT_TRUE(stops(0.49996f, 100, firefly, ones));
    EXPECT_FALSE(stops(4999.0f, 100, ones, firefly));
    EXPECT_TRUE(stops(5001.0f, 100, ones, firefly));
}

TEST(ConvergenceRule, DoesNotDependOnTheScale) {
    std::mt19937 generator(1);
    std::lognormal_distribution<float> distribution(0.0f, 1.0f);
    std::vector<float> samples(400);
    std::generate(samples.begin(), samples.end(), [&] { return distribution(generator); });
    double all = 0, half = 0;
    for (size_t i = 0; i < samples.size(); ++i) {
        all += static_cast<double>(samples[i]) / 400;
        half += i % 2 == 0 ? static_cast<double>(samples[i]) / 200 : 0;
    }
    const auto change = static_cast<float>(std::abs(all - half) / half);
    for (const float scale : {0x1p-40f, 1.0f, 0x1p20f}) {
        const auto even = [&](int i) { return grey(scale * samples[static_cast<size_t>(2 * i)]); };
        const auto odd = [&](int i) {
            return grey(scale * samples[static_cast<size_t>(2 * i + 1)]);
        };
        EXPECT_TRUE(stops(1.001f * change, 200, even, odd)) << scale;
        EXPECT_FALSE(stops(0.999f * change, 200, even, odd)) << scale;
    }
}

TEST(ConvergenceRule, ChecksFromTheStartOnAtIntervals) {
    const ConvergenceRule rule{0.02f, 50, 200};
    uint64_t samples = 0;
    for (const uint64_t expected : {200, 250, 300, 350}) {
        EXPECT_FALSE(rule.is_check(samples + 1));
        EXPECT_EQ(rule.next_check(samples), expected);
        EXPECT_EQ(rule.next_check(expected - 1), expected);
        EXPECT_TRUE(rule.is_check(expected));
        samples = expected;
    }
    EXPECT_EQ(rule.describe(), "biased by convergence control: error 0.02, interval 50, start 200");
}

TEST(ConvergenceReport, CountsLivePixelsAndPaths) {
    const ConvergenceState state{{0.02f, 50, 200}, {200, 0, 300, 200, 0}, {}};
    EXPECT_TRUE(state.is_consistent(320));
    EXPECT_FALSE(state.is_consistent(250)) << "a pixel stopped after the end";
    EXPECT_FALSE((ConvergenceState{{0.02f, 50, 200}, {210}, {}}.is_consistent(320)))
        << "a pixel stopped between checks";
    const nlohmann::json report = convergence_report(state, 320);
    EXPECT_EQ(report["camera_paths"], 200 + 320 + 300 + 200 + 320);
    ASSERT_EQ(report["checks"].size(), 3u);
    EXPECT_EQ(report["checks"][0], (nlohmann::json{{"samples", 200}, {"live", 0.6}}));
    EXPECT_EQ(report["checks"][1], (nlohmann::json{{"samples", 250}, {"live", 0.6}}));
    EXPECT_EQ(report["checks"][2], (nlohmann::json{{"samples", 300}, {"live", 0.4}}));
}

DeviceContext &device() {
    static DeviceContext context;
    return context;
}

ConvergenceControl control(uint32_t pixels, uint32_t group_size, float error = 0.05f) {
    const FeatureMask features = FeatureMask::all()
                                     .with(Feature::from_light, false)
                                     .with(Feature::sequences, false)
                                     .closed();
    return {device(), {error, 2, 2}, pixels, features, group_size, {}};
}

std::vector<uint32_t> live_list(const ConvergenceControl &control) {
    std::vector<uint32_t> list = control.live_pixels().read();
    list.resize(control.live_count());
    return list;
}

// Pixels of many distributions must stop on the device exactly if they stop on the host. The live
// pixels must be listed in ascending order for every group size.
TEST(ConvergenceControl, DecidesAndListsOnTheDeviceAsOnTheHost) {
    constexpr uint32_t pixels = 1000;
    std::mt19937 generator(2);
    std::lognormal_distribution<float> distribution(0.0f, 0.7f);
    Films films(pixels);
    for (size_t pixel = 0; pixel < pixels; ++pixel) {
        for (int i = 0; i < 64; ++i) {
            films.add(pixel, pixel % 7 == 0 ? grey(0.0f)
                                            : make_float3(distribution(generator),
                                                          distribution(generator), 1.0f));
        }
    }
    std::vector<uint32_t> expected;
    for (uint32_t pixel = 0; pixel < pixels; ++pixel) {
        if (!films.converged(pixel, 0.05f)) {
            expected.push_back(pixel);
        }
    }
    ASSERT_GT(expected.size(), pixels / 10) << "enough pixels must be live";
    ASSERT_LT(expected.size(), 9 * pixels / 10);
    const Buffer<int64_t> film(device(), "film", films.film);
    for (const uint32_t group_size : {1u, 16u, 64u}) {
        ConvergenceControl checked = control(pixels, group_size);
        checked.restore({checked.rule(), std::vector<uint64_t>(pixels), films.half});
        EXPECT_EQ(checked.live_count(), pixels);
        checked.check(film, 64);
        EXPECT_EQ(live_list(checked), expected) << group_size;
        const ConvergenceState state = checked.state();
        for (uint32_t pixel = 0; pixel < pixels; ++pixel) {
            const bool live = std::binary_search(expected.begin(), expected.end(), pixel);
            ASSERT_EQ(state.stopped_at[pixel], live ? 0u : 64u);
        }
        // A stopped pixel remains stopped.
        checked.check(film, 66);
        EXPECT_EQ(checked.state().stopped_at, state.stopped_at);
        checked.reset();
        EXPECT_EQ(checked.live_count(), pixels);
        EXPECT_EQ(checked.state().half_words, std::vector<int64_t>(films.half.size()));
    }
}

TEST(ConvergenceControl, ListsAnyNumberOfPixels) {
    std::mt19937 generator(3);
    for (const uint32_t pixels :
         {1u, LIVE_BLOCK - 1, LIVE_BLOCK, LIVE_BLOCK + 1, 40 * LIVE_BLOCK + 3}) {
        for (const uint32_t of_eight : {0u, 1u, 8u}) {  // number of live pixels out of eight
            ConvergenceState state{{0.05f, 2, 2},
                                   std::vector<uint64_t>(pixels),
                                   std::vector<int64_t>(pixels * HALF_FILM_PIXEL_WORDS)};
            std::vector<uint32_t> expected;
            for (uint32_t pixel = 0; pixel < pixels; ++pixel) {
                state.stopped_at[pixel] = generator() % 8 < of_eight ? 0 : 2;
                if (state.stopped_at[pixel] == 0) {
                    expected.push_back(pixel);
                }
            }
            ConvergenceControl restored = control(pixels, 16);
            restored.restore(state);
            EXPECT_EQ(live_list(restored), expected) << pixels << " " << of_eight;
        }
    }
}

// Returns a film of two pixels with 4 samples, the second of which stopped after 2, and a light
// pass of 4 samples.
FilmState stopped_film() {
    Films films(2);
    for (const float value : {1.0f, 2.0f, 5.0f, 8.0f}) {
        films.add(0, grey(value));
    }
    for (const float value : {1.0f, 3.0f}) {
        films.add(1, grey(value));
    }
    Films::carry(films.film, PIXEL_SUMS);
    Films::carry(films.half, HALF_FILM_SUMS);
    FilmState film;
    film.width = 2;
    film.height = 1;
    film.seed = 7;
    film.config = {{"scene", "hash"}};
    film.add_range({0, 4});
    film.words = films.film;
    film.convergence = ConvergenceState{{0.5f, 2, 2}, {0, 2}, films.half};
    return film;
}

TEST(ConvergenceFilm, IsNormalisedPixelByPixel) {
    const Image image = develop_film(stopped_film());
    EXPECT_EQ(image.channel("samples"), (std::vector<float>{4, 2}));
    EXPECT_EQ(image.channel("G"), (std::vector<float>{4, 2}));
    // Variances of the mean: (9 + 4 + 1 + 16) / 3 / 4 and (1 + 1) / 1 / 2.
    EXPECT_NEAR(image.channel("variance.G")[0], 2.5, 1e-6);
    EXPECT_NEAR(image.channel("variance.G")[1], 1.0, 1e-6);
}

TEST(ConvergenceFilm, TakesTheLightPassByAllSamples) {
    FilmState camera = stopped_film(), light = camera;
    light.passes = {PassKind::light};
    light.light_paths = 1;
    light.convergence.reset();
    const FilmState before = light;
    merge_film(light, camera);
    ASSERT_TRUE(light.convergence);
    const Image image = develop_film(light);
    EXPECT_EQ(image.channel("samples"), (std::vector<float>{4, 2}));
    EXPECT_EQ(image.channel("camera.R"), (std::vector<float>{4, 2}));
    EXPECT_EQ(image.channel("light.R"), (std::vector<float>{4, 1}));
    EXPECT_EQ(image.channel("R"), (std::vector<float>{8, 3}));
    merge_film(camera, before);
    EXPECT_EQ(camera.words, light.words);
    EXPECT_EQ(camera.convergence->stopped_at, light.convergence->stopped_at);
}

TEST(ConvergenceFilm, IsNotMergedFromRanges) {
    FilmState film = stopped_film(), other = film;
    other.ranges = {{4, 8}};
    expect_input_error("only another pass can be merged", [&] { merge_film(film, other); });
    other.convergence.reset();
    expect_input_error("films differ in stopped pixels (yes and no)",
                       [&] { merge_film(film, other); });
}

TEST(ConvergenceFilm, IsSavedAndLoadedBitByBit) {
    const TemporaryFolder folder;
    const auto path = folder.path() / "film";
    FilmState film = stopped_film();
    save_film(film, path);
    const FilmState loaded = load_film(path);
    EXPECT_EQ(loaded.words, film.words);
    ASSERT_TRUE(loaded.convergence);
    EXPECT_EQ(loaded.convergence->stopped_at, film.convergence->stopped_at);
    EXPECT_EQ(loaded.convergence->half_words, film.convergence->half_words);
    EXPECT_EQ(loaded.convergence->rule.describe(), film.convergence->rule.describe());
    film.convergence->stopped_at[0] = 3;
    save_film(film, path);
    expect_input_error("stopped between checks", [&] { load_film(path); });
    film.convergence->half_words.pop_back();
    save_film(film, path);
    expect_input_error("wrong length", [&] { load_film(path); });
}

}  // namespace
}  // namespace rtrays
