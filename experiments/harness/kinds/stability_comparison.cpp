// SPDX-License-Identifier: MIT
#include "experiments/harness/kinds/stability_comparison.h"

#include <algorithm>
#include <cmath>

#include "experiments/harness/core/agreement.h"
#include "experiments/harness/core/blocks.h"
#include "experiments/harness/core/metrics.h"
#include "renderer/base/error.h"

namespace rtrays {

namespace {

constexpr int block_size = stability_block_size;

/// Expected means of the blocks of a channel and, last, of the full image, with their variances.
std::vector<NoisySum> expected_means(const ExpectedImage &expected, size_t channel,
                                     const std::vector<double> &pixels) {
    std::vector<NoisySum> means;
    if (expected.noisy) {
        means = sums_by_layer(expected.mean, channel, block_size);
    } else {
        for (const double sum : block_sums(expected.mean, rgb_names()[channel], block_size)) {
            means.emplace_back().value = sum;
        }
    }
    for (size_t block = 0; block < means.size(); ++block) {
        means[block].value /= pixels[block];
        means[block].variance /= pixels[block] * pixels[block];
    }
    return means;
}

/// Returns the mean variance of the pixels of an expected image.
double expected_error(const ExpectedImage &expected) {
    double sum = 0;
    for (const std::string &channel : rgb_names("variance")) {
        sum += expected.noisy ? block_sums(expected.mean, channel, block_size).back() : 0;
    }
    return sum / 3 / static_cast<double>(expected.mean.pixel_count());
}

/// Means of a channel of the full image.
struct ChannelResult {
    double expected = 0, measured = 0, standard_error = 0;
};

/// Tests every block and the full image, and counts the tests in `result`.
ChannelResult test_channel(const std::vector<NoisySum> &measured,
                           const std::vector<NoisySum> &expected, const std::vector<double> &pixels,
                           double bound, double far, StabilityTest &result) {
    ChannelResult channel;
    for (size_t block = 0; block < pixels.size(); ++block) {
        const double mean = measured[block].value / pixels[block];
        const double standard_error = std::sqrt(
            measured[block].variance / std::pow(pixels[block], 2) + expected[block].variance);
        const double off = std::abs(mean - expected[block].value),
                     allowed = bound * expected[block].value;
        if (std::abs(measured[block].skewness) > AgreementPolicy().largest_skewness &&
            off + far * standard_error > allowed) {
            ++result.undecided;
        } else {
            ++result.tests;
            result.rejected += off - far * standard_error > allowed ? 1 : 0;
        }
        channel = {expected[block].value, mean, standard_error};
    }
    return channel;
}

}  // namespace

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

StabilityTest test_stability(const std::vector<Image> &images, const ExpectedImage &expected,
                             double bound, double within, double alpha) {
    if (images.size() < 2) {
        throw run_error("an interval needs at least two batches");
    }
    StabilityTest result;
    const double freedom = static_cast<double>(images.size() - 1);
    const double far = student_quantile_two_sided(1 - alpha, freedom),
                 near = student_quantile_two_sided(0.99, freedom);
    const std::vector<double> pixels = block_pixels(expected.mean, block_size);
    double error = 0;  // upper bound of the standard error of the mean over channels
    for (size_t c = 0; c < rgb_names().size(); ++c) {
        const ChannelResult channel =
            test_channel(sums_by_batch(images, c, block_size), expected_means(expected, c, pixels),
                         pixels, bound, far, result);
        result.expected += channel.expected / 3;
        result.measured += channel.measured / 3;
        error += channel.standard_error / 3;
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

}  // namespace rtrays
