// SPDX-License-Identifier: MIT
#include "reference/tests/statistics.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "renderer/base/statistics.h"

namespace rtrays::reference {

namespace {

/// Returns the mean over the pixels [x0, x1) x [y0, y1).
BlockMean block_mean(const Image &image, const std::string &channel, int x0, int y0, int x1,
                     int y1) {
    const auto &values = image.channel(channel);
    const auto &variances = image.channel("variance." + channel);
    BlockMean result;
    for (int y = y0; y < y1; ++y) {
        for (int x = x0; x < x1; ++x) {
            const auto pixel = static_cast<size_t>(y * image.width() + x);
            result.mean += static_cast<double>(values[pixel]);
            result.variance += static_cast<double>(variances[pixel]);
        }
    }
    const double count = static_cast<double>(x1 - x0) * static_cast<double>(y1 - y0);
    result.mean /= count;
    result.variance /= count * count;
    return result;
}

}  // namespace

std::vector<std::string> holm_rejected(const std::vector<Comparison> &comparisons) {
    std::vector<double> p_values;
    for (const Comparison &comparison : comparisons) {
        p_values.push_back(comparison.p_value);
    }
    const std::vector<double> adjusted = holm_adjusted(p_values);
    std::vector<std::string> rejected;
    for (size_t i = 0; i < comparisons.size(); ++i) {
        if (adjusted[i] <= family_alpha) {
            rejected.push_back(
                fmt::format("{} (adjusted p = {:.2g})", comparisons[i].name, adjusted[i]));
        }
    }
    return rejected;
}

BlockMean image_mean(const Image &image, const std::string &channel) {
    return block_mean(image, channel, 0, 0, image.width(), image.height());
}

void compare_images(const std::string &name, const Image &a, const Image &b,
                    std::vector<Comparison> &comparisons) {
    constexpr int block = 16;
    const auto compare = [&](const std::string &place, const BlockMean &mean_a,
                             const BlockMean &mean_b) {
        const double deviation = std::sqrt(mean_a.variance + mean_b.variance);
        const double difference = mean_a.mean - mean_b.mean;
        const double z = difference == 0.0 ? 0.0 : difference / deviation;
        comparisons.push_back({name + " " + place, normal_p_value(z)});
    };
    for (const auto &channel : rgb_names()) {
        compare(channel + " mean", image_mean(a, channel), image_mean(b, channel));
        for (int y = 0; y < a.height(); y += block) {
            for (int x = 0; x < a.width(); x += block) {
                const int x1 = std::min(x + block, a.width()), y1 = std::min(y + block, a.height());
                compare(fmt::format("{} block {},{}", channel, x, y),
                        block_mean(a, channel, x, y, x1, y1), block_mean(b, channel, x, y, x1, y1));
            }
        }
    }
}

}  // namespace rtrays::reference
