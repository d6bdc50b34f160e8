// SPDX-License-Identifier: MIT
// Decisions of the statistical tests. Each suite of comparisons is decided together: Holm's
// step-down correction at a family-wise alpha of 0.01 (architecture, "Statistics policy").
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

/// Names and adjusted p-values of the comparisons that Holm's procedure rejects at `family_alpha`.
std::vector<std::string> holm_rejected(const std::vector<Comparison> &comparisons);

/// Mean and variance of the mean of a block of pixels of one channel.
struct BlockMean {
    double mean = 0.0;
    double variance = 0.0;
};

/// Over all pixels, from the layers R and variance.R (and so on); pixels are independent.
BlockMean image_mean(const Image &image, const std::string &channel);

/// Compares two independent images block by block (16x16) and on the whole mean, per channel.
void compare_images(const std::string &name, const Image &a, const Image &b,
                    std::vector<Comparison> &comparisons);

}  // namespace rtrays::reference
