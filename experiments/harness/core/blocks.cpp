// SPDX-License-Identifier: MIT
#include "experiments/harness/core/blocks.h"

#include <fmt/format.h>

#include <algorithm>
#include <boost/math/statistics/univariate_statistics.hpp>
#include <cmath>

#include "renderer/base/error.h"

namespace rtrays {

using boost::math::statistics::mean;
using boost::math::statistics::sample_variance;
using boost::math::statistics::skewness;

namespace {

/// Sums term(value) over the pixels of every block and, last, of the full image.
template <class Term>
std::vector<double> sums_of_terms(const Image &image, const std::string &channel, int size,
                                  const Term &term) {
    const int columns = (image.width() + size - 1) / size,
              rows = (image.height() + size - 1) / size;
    std::vector<double> sums(static_cast<size_t>(columns * rows) + 1);
    const std::vector<float> &values = image.channel(channel);
    for (size_t i = 0; i < values.size(); ++i) {
        const int x = static_cast<int>(i) % image.width(), y = static_cast<int>(i) / image.width();
        const auto value = static_cast<double>(values[i]);
        if (!std::isfinite(value) || (value < 0 && channel.rfind("variance", 0) == 0)) {
            throw input_error(fmt::format(
                "pixel ({}, {}), channel {}: value {}; values must be finite, and variances must "
                "not be negative",
                x, y, channel, value));
        }
        sums[static_cast<size_t>(y / size * columns + x / size)] += term(value);
        sums.back() += term(value);
    }
    return sums;
}

}  // namespace

std::vector<double> block_sums(const Image &image, const std::string &channel, int size) {
    return sums_of_terms(image, channel, size, [](double value) { return value; });
}

std::vector<double> block_pixels(const Image &image, int size) {
    Image ones(image.width(), image.height());
    std::fill_n(ones.add_channel("R").begin(), image.pixel_count(), 1.0f);
    return block_sums(ones, "R", size);
}

std::string block_name(size_t block, const Image &image, int size) {
    const int columns = (image.width() + size - 1) / size,
              rows = (image.height() + size - 1) / size;
    const int i = static_cast<int>(block);
    return i == columns * rows ? "whole image"
                               : fmt::format("({}, {})", i % columns * size, i / columns * size);
}

std::vector<NoisySum> sums_by_layer(const Image &image, size_t channel, int size) {
    const std::vector<double> values = block_sums(image, rgb_names()[channel], size);
    const std::vector<double> variances = block_sums(image, rgb_names("variance")[channel], size);
    std::vector<NoisySum> sums(values.size());
    for (size_t i = 0; i < values.size(); ++i) {
        sums[i].value = values[i];
        sums[i].variance = variances[i];
    }
    const auto stated = image.attributes().find("rtrays:varianceFreedom");
    if (stated != image.attributes().end()) {
        const double freedom = std::get<int>(stated->second);
        const std::vector<double> squares =
            sums_of_terms(image, rgb_names("variance")[channel], size,
                          [](double variance) { return variance * variance; });
        for (size_t i = 0; i < sums.size(); ++i) {
            // For n pixels of equal expected variance, this has the expectation n `freedom`.
            const double equal = squares[i] > 0 ? variances[i] * variances[i] / squares[i] : 1;
            sums[i].freedom = (freedom + 2) * equal - 2;
        }
    }
    return sums;
}

std::vector<NoisySum> sums_by_batch(const std::vector<Image> &batches, size_t channel, int size) {
    std::vector<std::vector<double>> values;
    for (const Image &batch : batches) {
        values.push_back(block_sums(batch, rgb_names()[channel], size));
    }
    std::vector<NoisySum> sums(values.front().size());
    for (size_t i = 0; i < sums.size(); ++i) {
        std::vector<double> own;
        for (const auto &batch : values) {
            own.push_back(batch[i]);
        }
        const auto n = static_cast<double>(own.size());
        sums[i] = {mean(own), sample_variance(own) / n, n - 1, skewness(own)};
    }
    return sums;
}

}  // namespace rtrays
