// SPDX-License-Identifier: MIT
// Tests that the layers variance.* state the errors of images, for independent samples and for
// Sobol points, whose samples are not independent.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include "renderer/import/load_scene.h"
#include "renderer/session/render_session.h"
#include "renderer/testing/session_films.h"

namespace rtrays {
namespace {

constexpr uint32_t seeds = 64;  // even
constexpr uint64_t spp = 32;

/// Renders the Cornell box with many seeds.
std::vector<Image> render(const RenderSettings &settings) {
    RenderSession session(load_scene(RTRAYS_SCENES "/cornell_box/scene.json"), settings,
                          test::device());
    std::vector<Image> images;
    for (uint32_t seed = 1; seed <= seeds; ++seed) {
        session.restart(seed);
        session.render(0, spp);
        images.push_back(session.develop());
    }
    return images;
}

/// Returns the pixels that do not see the lamp. The few at its edge would hold most of the
/// variance.
std::vector<size_t> dim_pixels(const std::vector<Image> &images) {
    std::vector<size_t> pixels;
    for (size_t pixel = 0; pixel < images.front().pixel_count(); ++pixel) {
        float sum = 0;
        for (const Image &image : images) {
            sum += image.channel("G")[pixel];
        }
        if (sum < 0.5f * seeds) {
            pixels.push_back(pixel);
        }
    }
    return pixels;
}

double mean_of(const Image &image, const std::string &channel, const std::vector<size_t> &pixels) {
    double sum = 0;
    for (const size_t pixel : pixels) {
        sum += static_cast<double>(image.channel(channel)[pixel]);
    }
    return sum / static_cast<double>(pixels.size());
}

/// A mean over pairs of images, and its standard error.
struct Estimate {
    double mean = 0, error = 0;
};

Estimate estimate_of(const std::vector<double> &values) {
    const auto n = static_cast<double>(values.size());
    double sum = 0, squares = 0;
    for (const double value : values) {
        sum += value;
        squares += value * value;
    }
    return {sum / n, std::sqrt((squares / n - sum / n * (sum / n)) / (n - 1))};
}

/// Variances of a pixel's green channel, means over the pixels: as the layers predict them, and as
/// pairs of images have them.
struct Variances {
    Estimate predicted, measured, difference;
};

Variances variances_of(const std::vector<Image> &images, const std::vector<size_t> &pixels) {
    std::vector<double> predicted, measured, difference;
    for (size_t i = 0; i < images.size(); i += 2) {
        const Image &a = images[i], &b = images[i + 1];
        double squares = 0;
        for (const size_t pixel : pixels) {
            const double d = static_cast<double>(a.channel("G")[pixel]) -
                             static_cast<double>(b.channel("G")[pixel]);
            squares += d * d;
        }
        predicted.push_back((mean_of(a, "variance.G", pixels) + mean_of(b, "variance.G", pixels)) /
                            2);
        measured.push_back(squares / 2 / static_cast<double>(pixels.size()));
        difference.push_back(predicted.back() - measured.back());
    }
    return {estimate_of(predicted), estimate_of(measured), estimate_of(difference)};
}

TEST(VarianceLayer, StatesTheErrorOfTheImage) {
    double independent = 0;
    for (const char *sampler : {"independent", "sobol"}) {
        for (const char *algorithm : {"path_tracing", "truncated_bdpt"}) {
            const std::string what = std::string(sampler) + " " + algorithm;
            const std::vector<Image> images = render(
                test::settings_of(algorithm, {std::string("integrator.sampler=") + sampler}));
            const std::vector<size_t> pixels = dim_pixels(images);
            ASSERT_GT(pixels.size(), 180u);
            const Variances found = variances_of(images, pixels);
            EXPECT_LT(std::abs(found.difference.mean), 4 * found.difference.error) << what;
            EXPECT_LT(found.difference.error, 0.1 * found.measured.mean) << "power: " << what;
            if (algorithm != std::string("path_tracing")) {
                continue;  // pixels share splats, so the error of the mean does not follow
            }
            // Intervals of 95 % of the image's mean. The mean over all seeds is the truth, or
            // nearly so. A miss of more than 11 in 64 has a probability of 1e-4.
            std::vector<double> means;
            for (const Image &image : images) {
                means.push_back(mean_of(image, "G", pixels));
            }
            const double truth = estimate_of(means).mean;
            uint32_t covered = 0;
            for (size_t i = 0; i < images.size(); ++i) {
                const double error = std::sqrt(mean_of(images[i], "variance.G", pixels) /
                                               static_cast<double>(pixels.size()));
                covered += std::abs(means[i] - truth) < 1.96 * error ? 1 : 0;
            }
            EXPECT_GE(covered, seeds - 11) << what;
            if (sampler == std::string("independent")) {
                independent = found.measured.mean;
            } else {
                EXPECT_LT(found.predicted.mean, 0.75 * independent)
                    << "the layer must show what stratification gains";
            }
        }
    }
}

}  // namespace
}  // namespace rtrays
