// SPDX-License-Identifier: MIT
#include "experiments/harness/kinds/stability_comparison.h"

#include <algorithm>
#include <cmath>

#include "experiments/harness/core/agreement.h"
#include "experiments/harness/core/metrics.h"
#include "renderer/base/error.h"

namespace rtrays {

namespace {

constexpr int block_size = stability_block_size;

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

}  // namespace rtrays
