// SPDX-License-Identifier: MIT
// Decisions of the statistical tests. Each suite of comparisons is decided together by Holm's
// step-down correction at a family-wise alpha of 0.01.
#pragma once

#include <string>
#include <vector>

#include "renderer/base/image.h"

namespace rtrays::reference {

/// One comparison of a suite.
struct Comparison {
    std::string name;
    double p_value;
};

constexpr double family_alpha = 0.01;

/// Returns names and adjusted p-values of the comparisons that Holm's procedure rejects at
/// `family_alpha`.
std::vector<std::string> holm_rejected(const std::vector<Comparison> &comparisons);

/// Mean and variance of the mean of a block of pixels of one channel.
struct BlockMean {
    double mean = 0.0;
    double variance = 0.0;
};

/// Returns the mean over all pixels of a channel. Its variance comes from the layer
/// "variance.CHANNEL"; pixels are independent.
BlockMean image_mean(const Image &image, const std::string &channel);

/// Compares two independent images per channel, block by block (16x16) and on the image mean.
void compare_images(const std::string &name, const Image &a, const Image &b,
                    std::vector<Comparison> &comparisons);

}  // namespace rtrays::reference
