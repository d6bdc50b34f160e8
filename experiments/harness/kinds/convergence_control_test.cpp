// SPDX-License-Identifier: MIT
// Tests the comparison of renders with and without convergence control on images with known bias
// and cost.
#include "experiments/harness/kinds/convergence_control.h"

#include <gtest/gtest.h>

#include <cmath>
#include <nlohmann/json.hpp>
#include <random>

#include "renderer/base/error.h"

namespace rtrays {
namespace {

constexpr int size = 48;
constexpr int seeds = 10;

Image grey(float value) {
    Image image = Image::rgb(size, size);
    for (const std::string &name : rgb_names()) {
        image.channel(name).assign(image.pixel_count(), value);
    }
    return image;
}

/// Adds independent normal noise to every pixel.
Image with_noise(Image image, float deviation, uint32_t seed) {
    std::mt19937 generator(seed);
    std::normal_distribution<float> noise(0.0f, deviation);
    for (const std::string &name : rgb_names()) {
        for (float &value : image.channel(name)) {
            value += noise(generator);
        }
    }
    return image;
}

/// Scales channel G in the block of 16 x 16 pixels at (16, 32).
Image with_biased_block(Image image, float factor) {
    for (int y = 32; y < 48; ++y) {
        for (int x = 16; x < 32; ++x) {
            image.channel("G")[static_cast<size_t>(y * size + x)] *= factor;
        }
    }
    return image;
}

std::vector<ControlledRender> without() {
    std::vector<ControlledRender> renders;
    for (uint32_t seed = 0; seed < seeds; ++seed) {
        renders.push_back({with_noise(grey(2.0f), 0.2f, seed), 1000, 8000, 1.0 + 0.1 * seed, 1});
    }
    return renders;
}

/// Returns the renders of `without` with less work and additional noise, as if pixels had stopped.
std::vector<ControlledRender> stopped(float own_noise) {
    std::vector<ControlledRender> renders = without();
    for (uint32_t seed = 0; seed < seeds; ++seed) {
        ControlledRender &render = renders[seed];
        render = {with_noise(render.image, own_noise, 100 + seed), 250, 1600, render.seconds / 3,
                  0.25};
    }
    return renders;
}

TEST(ConvergenceControl, FindsNoBiasWhereThereIsNone) {
    const nlohmann::json row = compare_control(stopped(0.05f), without(), grey(2.0f));
    EXPECT_EQ(row["bias"]["rejected"], 0);
    EXPECT_EQ(row["bias"]["tests"], 3 * (9 + 1));
    const nlohmann::json mean = row["bias"]["mean"];
    EXPECT_LT(mean["low"], 0);
    EXPECT_GT(mean["high"], 0);
    // Shared noise does not widen the interval. Its half width is 0.05 / 2 over the square root of
    // 10 x 48 x 48 x 3 values, times t with 9 degrees of freedom.
    EXPECT_LT(mean["high"].get<double>() - mean["low"].get<double>(),
              2 * 3.25 * 0.025 / std::sqrt(10.0 * 48 * 48 * 3) * 2);
    EXPECT_DOUBLE_EQ(row["paths"], 0.25);
    EXPECT_DOUBLE_EQ(row["rays"], 0.2);
    EXPECT_DOUBLE_EQ(row["live"], 0.25);
    EXPECT_NEAR(row["seconds"]["value"], 1.0 / 3, 1e-12);
}

TEST(ConvergenceControl, FindsABiasWhereItIs) {
    std::vector<ControlledRender> with = stopped(0.05f);
    for (ControlledRender &render : with) {
        render.image = with_biased_block(render.image, 0.99f);
    }
    const nlohmann::json row = compare_control(with, without(), grey(2.0f));
    EXPECT_EQ(row["bias"]["rejected"], 2) << "the block and the full image of its channel";
    EXPECT_EQ(row["bias"]["largest_z_at"], "G (16, 32)");
    const nlohmann::json mean = row["bias"]["mean"];
    const double bias = -0.01 / 27;  // one of nine blocks, one of three channels
    EXPECT_LT(mean["low"], bias);
    EXPECT_GT(mean["high"], bias);
    EXPECT_LT(mean["high"], 0);
}

TEST(ConvergenceControl, ComparesErrorsAtEqualRays) {
    // First equal errors with a fifth of the rays, then the error of a fifth of evenly spread rays.
    const nlohmann::json same = compare_control(stopped(0.0f), without(), grey(2.0f));
    for (const char *end : {"value", "low", "high"}) {
        EXPECT_NEAR(same["efficiency"][end], 5, 1e-9);
    }
    EXPECT_EQ(same["rmse"], same["rmse_without"]);
    const nlohmann::json even =
        compare_control(stopped(0.2f * std::sqrt(4.0f)), without(), grey(2.0f));
    EXPECT_LT(even["efficiency"]["low"], 1);
    EXPECT_GT(even["efficiency"]["high"], 1);
    EXPECT_NEAR(even["efficiency"]["value"], 1, 0.03);
}

TEST(ConvergenceControl, NeedsEightPairs) {
    std::vector<ControlledRender> renders = without();
    renders.resize(7);
    EXPECT_THROW(compare_control(renders, renders, grey(2.0f)), Error);
}

}  // namespace
}  // namespace rtrays
