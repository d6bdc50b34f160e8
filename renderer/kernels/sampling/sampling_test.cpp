// SPDX-License-Identifier: MIT
// Tests random numbers, discrete choices and their weights, with the device code compiled for the
// host. Tests of light samplers are in light_sampling_test.cpp, of BSDF samplers in
// bsdf_sampling_test.cpp.
#define FEATURE_sobol 1
#include "testing/other_features.h"

#include "renderer/base/angles.h"
#include "renderer/kernels/sampling/hemisphere.h"
#include "renderer/kernels/sampling/sampler.h"
#include "renderer/kernels/sampling/select.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <functional>
#include <tuple>

#include "renderer/compile/compile_scene.h"
#include "renderer/testing/chi_square.h"

namespace rtrays {
namespace {

constexpr double level = 0.01;  // level of a single chi-square test
constexpr uint32_t sample_count = 1'000'000;

uint4 words(uint32_t sample, uint32_t block = 0) {
    return random_words(11, 0, 3, sample, block);
}

// Known answers from the test suite of Random123 (kat_vectors: philox4x32 10).
TEST(Random, PhiloxKnownAnswers) {
    const uint4 zero = random_words(0, 0, 0, 0, 0);
    EXPECT_EQ(zero.x, 0x6627e8d5u);
    EXPECT_EQ(zero.y, 0xe169c58du);
    EXPECT_EQ(zero.z, 0xbc57ac4cu);
    EXPECT_EQ(zero.w, 0x9b00dbd8u);
    const uint4 ones = random_words(~0u, ~0u, ~0u, ~0ul, ~0u);
    EXPECT_EQ(ones.x, 0x408f276du);
    EXPECT_EQ(ones.y, 0x41c83b0eu);
    EXPECT_EQ(ones.z, 0xa20bc7c6u);
    EXPECT_EQ(ones.w, 0x6d5451fdu);
}

TEST(Random, CountsBeyond32Bits) {
    EXPECT_NE(random_words(1, 0, 0, 5, 0).x, random_words(1, 0, 0, 5 + (1ul << 32), 0).x);
}

TEST(Random, UniformFloatsStayBelowOne) {
    EXPECT_EQ(uniform_float(0), 0.0f);
    EXPECT_LT(uniform_float(~0u), 1.0f);
}

TEST(ChiSquare, GivesKnownProbabilitiesAndLeavesNoSampleOut) {
    // The p-value is erfc(sqrt(x / 2)) for one degree of freedom, and exp(-x / 2) for two.
    EXPECT_NEAR(chi_square_p({600, 400}, {500, 500}) / std::erfc(std::sqrt(20.0)), 1.0, 1e-9);
    EXPECT_NEAR(chi_square_p({104, 100, 84}, {96, 96, 96}) / std::exp(-(64.0 + 16 + 144) / 96 / 2),
                1.0, 1e-9);
    EXPECT_EQ(chi_square_p({1, 500, 499}, {0, 500, 500}), 0.0);
    EXPECT_LT(chi_square_p({50, 100, 1000}, {1e-6, 100, 1000}), 1e-5)
        << "a cell with an expectation near 0";
}

TEST(Random, UniformFloatsPassChiSquareInPairs) {
    constexpr int bins = 64;
    std::vector<uint64_t> observed(bins * bins);
    for (uint32_t i = 0; i < sample_count; ++i) {
        const uint4 w = words(i);
        ++observed[static_cast<size_t>(uniform_float(w.x) * bins) * bins +
                   static_cast<size_t>(uniform_float(w.y) * bins)];
    }
    EXPECT_GT(chi_square_p(observed,
                           std::vector<double>(bins * bins, sample_count / double(bins * bins))),
              level);
}

TEST(Circle, PointsAreThoseOfTheirAngles) {
    double largest = 0;
    for (uint32_t i = 0; i < 1u << 24; i += 5) {
        const float v = static_cast<float>(i) * 0x1p-24f;
        const float2 point = point_on_circle(v);
        const double angle = 2 * pi * static_cast<double>(v);
        largest = std::max({largest, std::abs(static_cast<double>(point.x) - std::cos(angle)),
                            std::abs(static_cast<double>(point.y) - std::sin(angle))});
    }
    EXPECT_LT(largest, 8.6e-8);
    const float2 east = point_on_circle(0.0f), north = point_on_circle(0.25f),
                 west = point_on_circle(0.5f), round = point_on_circle(1.0f);
    EXPECT_EQ(std::pair(east.x, east.y), std::pair(1.0f, 0.0f));
    EXPECT_EQ(std::pair(north.x, north.y), std::pair(0.0f, 1.0f));
    EXPECT_EQ(std::pair(west.x, west.y), std::pair(-1.0f, 0.0f));
    EXPECT_EQ(std::pair(round.x, round.y), std::pair(1.0f, 0.0f));
}

/// Returns the direction numbers of the dimensions 1 to 4, computed from the primitive polynomials
/// and initial values in the table of Joe & Kuo (new-joe-kuo-6).
std::array<std::array<uint32_t, 32>, 4> direction_numbers() {
    struct Row {
        uint32_t degree, coefficients;
        std::vector<uint64_t> m;
    };
    std::array<std::array<uint32_t, 32>, 4> numbers{};
    for (uint32_t i = 0; i < 32; ++i) {
        numbers[0].at(i) = 1u << (31 - i);
    }
    size_t dimension = 1;
    for (Row row : {Row{1, 0, {1}}, Row{2, 1, {1, 3}}, Row{3, 1, {1, 3, 1}}}) {
        for (uint32_t i = row.degree; i < 32; ++i) {
            uint64_t m = row.m[i - row.degree] ^ (row.m[i - row.degree] << row.degree);
            for (uint32_t k = 1; k < row.degree; ++k) {
                m ^= (row.coefficients >> (row.degree - 1 - k) & 1u) != 0 ? row.m[i - k] << k : 0;
            }
            row.m.push_back(m);
        }
        for (uint32_t i = 0; i < 32; ++i) {
            numbers.at(dimension).at(i) = static_cast<uint32_t>(row.m[i] << (31 - i));
        }
        ++dimension;
    }
    return numbers;
}

// The points are by definition the sums modulo 2 of the direction numbers of the index' bits.
TEST(Sobol, PointsAreSumsOfDirectionNumbers) {
    const auto numbers = direction_numbers();
    for (uint32_t i = 0; i < 20'000; ++i) {
        const uint32_t index = i < 32 ? 1u << i : words(i).x >> (i % 32);
        std::array<uint32_t, 4> expected{};
        for (size_t dimension = 0; dimension < 4; ++dimension) {
            for (uint32_t bit = 0; bit < 32; ++bit) {
                expected.at(dimension) ^=
                    (index >> bit & 1u) != 0 ? numbers.at(dimension).at(bit) : 0u;
            }
        }
        const uint4 point = reversed_sobol_point(index);
        ASSERT_EQ((std::array<uint32_t, 4>{reverse_bits(point.x), reverse_bits(point.y),
                                           reverse_bits(point.z), reverse_bits(point.w)}),
                  expected)
            << index;
    }
}

IntegratorSettings settings_of(uint32_t sampler, uint32_t seed) {
    IntegratorSettings settings{};
    settings.seed = seed;
    settings.sampler = sampler;
    return settings;
}
uint4 stratified_words(uint32_t sampler, uint32_t seed, uint32_t pixel, uint64_t sample,
                       uint32_t block) {
    const IntegratorSettings settings = settings_of(sampler, seed);
    return words_of(settings, camera_source(settings, STREAM_CAMERA, pixel, sample), block);
}
uint4 sobol_sample(uint32_t seed, uint32_t pixel, uint64_t sample, uint32_t block) {
    return stratified_words(SAMPLER_SOBOL, seed, pixel, sample, block);
}

/// Tests whether 2^`log_count` points lie in different elementary intervals, of every shape in the
/// first two dimensions, and in each other dimension.
void expect_stratified(const std::vector<uint4> &points, uint32_t log_count) {
    const auto count = static_cast<long>(points.size());
    ASSERT_EQ(count, 1 << log_count);
    for (uint32_t split = 0; split <= log_count; ++split) {
        std::vector<int> cells(points.size());
        for (const uint4 &w : points) {
            const uint32_t x = split > 0 ? w.x >> (32 - split) : 0;
            const uint32_t y = split < log_count ? w.y >> (32 - (log_count - split)) : 0;
            ++cells[(y << split) + x];
        }
        EXPECT_EQ(std::count(cells.begin(), cells.end(), 1), count) << "2^" << split << " columns";
    }
    std::vector<int> z(points.size()), w(points.size());
    for (const uint4 &words : points) {
        ++z[words.z >> (32 - log_count)];
        ++w[words.w >> (32 - log_count)];
    }
    EXPECT_EQ(std::count(z.begin(), z.end(), 1), count);
    EXPECT_EQ(std::count(w.begin(), w.end(), 1), count);
}

class Stratified : public testing::TestWithParam<uint32_t> {};

TEST_P(Stratified, EveryRunOfSamplesOfASequenceIs) {
    const uint64_t sequences = GetParam() == SAMPLER_SOBOL ? SOBOL_SEQUENCES : 1;
    for (const uint32_t log_count : {4u, 8u}) {
        const uint32_t count = 1u << log_count;
        for (const uint64_t first :
             {uint64_t{0}, uint64_t{3} * count, (uint64_t{1} << 32) + count}) {
            for (uint64_t sequence = 0; sequence < sequences; ++sequence) {
                std::vector<uint4> points;
                for (uint32_t i = 0; i < count; ++i) {
                    points.push_back(
                        stratified_words(GetParam(), 5, 77, (first + i) * sequences + sequence, 3));
                }
                expect_stratified(points, log_count);
            }
        }
    }
}

INSTANTIATE_TEST_SUITE_P(Samplers, Stratified, testing::Values(SAMPLER_SOBOL, SAMPLER_REGULAR));

TEST(Regular, BeginsInTheCentreAndIsTheSameEverywhere) {
    for (const uint32_t block : {0u, 1u, 7u}) {
        const uint4 first = stratified_words(SAMPLER_REGULAR, 1, 5, 0, block);
        EXPECT_EQ(uniform_float(first.x), 0.5f);
        EXPECT_EQ(uniform_float(first.y), 0.5f);
        EXPECT_EQ(uniform_float(first.z), 0.0f) << "radius on the lens";
        EXPECT_EQ(uniform_float(first.w), 0.5f);
        const uint4 here = stratified_words(SAMPLER_REGULAR, 1, 5, 9, block),
                    there = stratified_words(SAMPLER_REGULAR, 2, 6, 9, block);
        EXPECT_EQ(here.x, there.x);
        EXPECT_EQ(here.w, there.w);
    }
    // Pairs of a coordinate in the pixel and a coordinate on a light must be uniform.
    constexpr int bins = 32;
    constexpr uint32_t pairs = 200'000;
    std::vector<uint64_t> observed(bins * bins);
    for (uint32_t i = 0; i < pairs; ++i) {
        const float a = uniform_float(stratified_words(SAMPLER_REGULAR, 1, 0, i, BLOCK_CAMERA).x);
        const float b = uniform_float(stratified_words(SAMPLER_REGULAR, 1, 0, i, BLOCK_LIGHT(0)).x);
        ++observed[static_cast<size_t>(a * bins) * bins + static_cast<size_t>(b * bins)];
    }
    EXPECT_GT(chi_square_p(observed, std::vector<double>(bins * bins, pairs / double(bins * bins))),
              level);
}

// Light paths of a sample, and of the next samples of its sequence, are one run of points.
TEST(Sobol, AllLightPathsOfASequenceAreStratified) {
    constexpr uint32_t paths = 16;
    const IntegratorSettings settings = settings_of(SAMPLER_SOBOL, 5);
    for (uint64_t sequence = 0; sequence < SOBOL_SEQUENCES; ++sequence) {
        for (const uint32_t block : {BLOCK_EMISSION(0u), BLOCK_EMISSION(1u), BLOCK_LIGHT(0u)}) {
            std::vector<uint4> points;
            for (uint64_t sample = 0; sample < 4; ++sample) {
                for (uint32_t path = 0; path < paths; ++path) {
                    const WordSource source = {STREAM_LIGHT_PATHS, 0,
                                               sample * SOBOL_SEQUENCES + sequence, paths, path};
                    points.push_back(words_of(settings, source, block));
                }
            }
            expect_stratified(points, 6);
        }
    }
}

TEST(Sobol, LaterEventsAreIndependent) {
    const auto is_independent = [](uint32_t block) {
        const uint4 here = sobol_sample(1, 2, 3, block), plain = random_words(1, 0, 2, 3, block);
        return std::tie(here.x, here.y, here.z, here.w) ==
               std::tie(plain.x, plain.y, plain.z, plain.w);
    };
    for (const uint32_t block : {BLOCK_CAMERA, BLOCK_LIGHT(0u), BLOCK_LIGHT(SOBOL_EVENTS - 1u),
                                 BLOCK_SCATTER(SOBOL_EVENTS - 1u), BLOCK_EMISSION(0u)}) {
        EXPECT_FALSE(is_independent(block)) << block;
    }
    EXPECT_TRUE(is_independent(BLOCK_LIGHT(SOBOL_EVENTS)));
    EXPECT_TRUE(is_independent(BLOCK_SCATTER(SOBOL_EVENTS + 7u)));
}

// One sample of each of many pixels must be uniform in all four dimensions together, although the
// order of points follows from the seeds of the dimensions.
TEST(Sobol, PointsOfDifferentPixelsAreUniform) {
    constexpr uint32_t bins = 16, pixels = 4'000'000;
    for (const uint64_t sample : {uint64_t{0}, uint64_t{5}, uint64_t{1'000'003}}) {
        std::vector<uint64_t> observed(bins * bins * bins * bins);
        for (uint32_t pixel = 0; pixel < pixels; ++pixel) {
            const uint4 w = sobol_sample(3, pixel, sample, 1);
            ++observed[((w.x >> 28) * bins + (w.y >> 28)) * bins * bins + (w.z >> 28) * bins +
                       (w.w >> 28)];
        }
        const auto cells = static_cast<double>(observed.size());
        EXPECT_GT(chi_square_p(observed, std::vector<double>(observed.size(), pixels / cells)),
                  level / 3);
    }
}

TEST(Sobol, PixelsBlocksSequencesAndSeedsAreIndependent) {
    // Pairs of the same sample in different pixels, blocks and seeds, and of the same point of
    // different sequences, must be uniform.
    constexpr int bins = 32;
    constexpr uint32_t pairs = 200'000;
    const auto uniform = [&](const std::function<std::pair<uint32_t, uint32_t>(uint32_t)> &pair) {
        std::vector<uint64_t> observed(bins * bins);
        for (uint32_t i = 0; i < pairs; ++i) {
            const auto [a, b] = pair(i);
            ++observed[static_cast<size_t>(uniform_float(a) * bins) * bins +
                       static_cast<size_t>(uniform_float(b) * bins)];
        }
        return chi_square_p(observed,
                            std::vector<double>(bins * bins, pairs / double(bins * bins)));
    };
    EXPECT_GT(uniform([](uint32_t i) {
                  return std::pair(sobol_sample(1, i, 6, 0).x, sobol_sample(1, i + 1, 6, 0).x);
              }),
              level / 5);
    EXPECT_GT(uniform([](uint32_t i) {
                  return std::pair(sobol_sample(1, i, 6, 0).x, sobol_sample(1, i, 6, 2).x);
              }),
              level / 5);
    EXPECT_GT(uniform([](uint32_t i) {
                  return std::pair(sobol_sample(1, i, 6, 0).y, sobol_sample(2, i, 6, 0).y);
              }),
              level / 5);
    EXPECT_GT(uniform([](uint32_t i) {
                  return std::pair(sobol_sample(1, i, 6, 0).z, sobol_sample(1, i, 6, 0).w);
              }),
              level / 5);
    EXPECT_GT(uniform([](uint32_t i) {
                  return std::pair(sobol_sample(1, i, 4, 0).x, sobol_sample(1, i, 5, 0).x);
              }),
              level / 5);
}

TEST(Frame, IsOrthonormalInAllDirections) {
    for (uint32_t i = 0; i < 10000; ++i) {
        const uint4 w = words(i, 3);
        const float3 n =
            i == 0   ? make_float3(0, 0, -1)
            : i == 1 ? make_float3(0, 0, 1)
                     : normalize(sample_uniform_sphere(uniform_float(w.x), uniform_float(w.y)));
        const Frame f = frame_from_z(n);
        EXPECT_NEAR(dot(f.x, f.y), 0.0f, 1e-6f);
        EXPECT_NEAR(dot(f.x, f.z), 0.0f, 1e-6f);
        EXPECT_NEAR(length(f.x), 1.0f, 1e-6f);
        EXPECT_NEAR(dot(cross(f.x, f.y), f.z), 1.0f, 1e-6f);
    }
}

TEST(SelectionTable, ProbabilitiesAreThoseOfTheWords) {
    const SelectionTable table = selection_table({0.0, 1.0, 2.0, 0.0, 5.0, 1e-20, 0.0});
    double sum = 0, previous = 0;
    for (size_t i = 0; i < table.end.size(); ++i) {
        const double end = i + 1 == table.end.size() ? 0x1p32 : table.end[i];
        EXPECT_EQ(table.probability[i], (end - previous) * 0x1p-32);
        previous = end;
        sum += table.probability[i];
    }
    EXPECT_EQ(sum, 1.0);
    EXPECT_EQ(table.probability[0], 0.0);
    EXPECT_NEAR(table.probability[4], 5.0 / 8.0, 1e-9);
}

// Words are counted exactly, also those of a last entry that has few.
TEST(SelectionTable, RangesHaveTheWordsOfTheirProbabilities) {
    const std::vector<double> lists[] = {
        {1.0}, {1.0, 1.0}, {1.0, 1e-8}, {1.0, 3.0, 1e-20}, {0.0, 1.0, 0.0}};
    for (const std::vector<double> &weights : lists) {
        const SelectionTable table = selection_table(weights);
        const auto count = static_cast<uint>(weights.size());
        for (uint i = 0; i < count; ++i) {
            EXPECT_NEAR(static_cast<double>(selection_range(table.end.data(), 0, count, i).count),
                        table.probability[i] * 0x1p32, table.probability[i] * 0x1p32 * 0x1p-24);
        }
    }
}

}  // namespace
}  // namespace rtrays
