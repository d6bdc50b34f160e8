// SPDX-License-Identifier: MIT
#include "experiments/agreement.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include "experiments/metrics.h"
#include "renderer/base/error.h"
#include "renderer/base/statistics.h"

namespace rtrays {

namespace {

/// Sums over the pixels of one block.
struct BlockSums {
    double pixels = 0;
    double image = 0, reference = 0;
    double variance = 0;  ///< of both images together
};

void add_pixel(BlockSums &block, double image, double reference, double variance) {
    block.pixels += 1;
    block.image += image;
    block.reference += reference;
    block.variance += variance;
}

/// The difference of one channel's means.
struct BlockTest {
    double difference = 0;      ///< mean of image less mean of reference
    double standard_error = 0;  ///< of `difference`
    double z = 0;
    std::string where;
};

BlockTest test_block(const BlockSums &block) {
    BlockTest test;
    test.difference = (block.image - block.reference) / block.pixels;
    // Pixels are rounded to float32: half an ulp each, in the worst case all the same way.
    const double rounding = std::numeric_limits<float>::epsilon() *
                            std::max(std::abs(block.image), std::abs(block.reference)) / block.pixels;
    test.standard_error = std::sqrt(block.variance) / block.pixels + rounding;
    // Black in both images: no difference and nothing to divide by.
    test.z = test.standard_error > 0 ? test.difference / test.standard_error : 0;
    return test;
}

void require_comparable(const Image &image, const Image &reference) {
    require_same_size(image, reference);
    if (!has_variance(image) || !has_variance(reference)) {
        throw input_error("both images need the layers variance.* (variance of the mean) to be tested");
    }
}

}  // namespace

const char *to_string(Equivalence equivalence) {
    switch (equivalence) {
        case Equivalence::equivalent:
            return "equivalent";
        case Equivalence::different:
            return "different";
        case Equivalence::undecided:
            return "undecided";
    }
    throw run_error("unknown equivalence");
}

Agreement test_agreement(const Image &image, const Image &reference, const AgreementPolicy &policy) {
    require_comparable(image, reference);
    const int width = image.width(), size = policy.block_size;
    const int columns = (width + size - 1) / size, rows = (image.height() + size - 1) / size;
    const auto colours = rgb_names(), variances = rgb_names("variance");

    std::vector<BlockTest> tests;
    double mean_difference = 0, mean_error = 0, mean_reference = 0;
    for (size_t c = 0; c < colours.size(); ++c) {
        std::vector<BlockSums> blocks(static_cast<size_t>(columns) * static_cast<size_t>(rows));
        BlockSums whole;
        const auto &a = image.channel(colours[c]), &b = reference.channel(colours[c]);
        const auto &variance_a = image.channel(variances[c]), &variance_b = reference.channel(variances[c]);
        for (size_t i = 0; i < a.size(); ++i) {
            const int x = static_cast<int>(i) % width, y = static_cast<int>(i) / width;
            const double variance = static_cast<double>(variance_a[i]) + variance_b[i];
            if (!std::isfinite(variance) || variance < 0 || !std::isfinite(a[i]) || !std::isfinite(b[i])) {
                throw input_error(
                    fmt::format("pixel ({}, {}), channel {}: values {} and {} with variance {}; "
                                "all must be finite, the variance not negative",
                                x, y, colours[c], a[i], b[i], variance));
            }
            add_pixel(blocks[static_cast<size_t>(y / size * columns + x / size)], a[i], b[i], variance);
            add_pixel(whole, a[i], b[i], variance);
        }
        for (size_t i = 0; i < blocks.size(); ++i) {
            tests.push_back(test_block(blocks[i]));
            const int block = static_cast<int>(i);
            tests.back().where = fmt::format("{} ({}, {})", colours[c], block % columns * size, block / columns * size);
        }
        tests.push_back(test_block(whole));
        tests.back().where = colours[c] + " whole image";
        mean_difference += tests.back().difference / 3;
        mean_error += tests.back().standard_error / 3;
        mean_reference += whole.reference / whole.pixels / 3;
    }

    Agreement result;
    result.tests = tests.size();
    std::vector<double> p_values;
    for (const auto &test : tests) {
        p_values.push_back(normal_p_value(test.z));
        if (std::abs(test.z) >= result.largest_z) {
            result.largest_z = std::abs(test.z);
            result.largest_z_at = test.where;
        }
    }
    for (const double adjusted : holm_adjusted(p_values)) {
        result.smallest_adjusted_p = std::min(result.smallest_adjusted_p, adjusted);
        result.rejected += adjusted <= policy.alpha ? 1 : 0;
    }

    if (!(mean_reference > 0)) {
        throw input_error("the reference is black: a relative difference of the mean is not defined");
    }
    const double reach = normal_quantile_two_sided(policy.confidence) * mean_error;
    result.relative_difference = {mean_difference / mean_reference,
                                  (mean_difference - reach) / mean_reference,
                                  (mean_difference + reach) / mean_reference};
    const auto &[value, low, high] = result.relative_difference;
    if (low >= -policy.equivalence_limit && high <= policy.equivalence_limit) {
        result.equivalence = Equivalence::equivalent;
    } else if (high < -policy.equivalence_limit || low > policy.equivalence_limit) {
        result.equivalence = Equivalence::different;
    }
    return result;
}

}  // namespace rtrays
