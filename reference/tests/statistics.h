// SPDX-License-Identifier: MIT
// Decisions of the statistical tests. Each suite of comparisons is decided together: Holm's step-down
// correction at a family-wise alpha of 0.01 (architecture, "Statistics policy").
#pragma once

#include <string>
#include <vector>

#include "renderer/base/image.h"

namespace rtrays::reference {

/// Two-sided p-value of a standard normal deviate.
double normal_p_value(double z);

/// p-value of Pearson's chi-square of observed against expected counts; cells of fewer than 5 expected are
/// pooled. `expected` must sum to the sum of `observed`.
double chi_square_p_value(const std::vector<double> &observed, const std::vector<double> &expected);

/// One comparison of a suite.
struct Comparison {
    std::string name;
    double p_value;
};

constexpr double family_alpha = 0.01;

/// Names of the comparisons that Holm's procedure rejects at `family_alpha`.
std::vector<std::string> holm_rejected(std::vector<Comparison> comparisons);

/// Mean and variance of the mean of a block of pixels of one channel.
struct BlockMean {
    double mean = 0.0;
    double variance = 0.0;
};

/// Over the pixels [x0, x1) x [y0, y1), from the layers R and variance.R (and so on); pixels are independent.
BlockMean block_mean(const Image &image, const std::string &channel, int x0, int y0, int x1, int y1);

BlockMean image_mean(const Image &image, const std::string &channel);

/// Compares two independent images block by block (16x16) and on the whole mean, per channel.
void compare_images(const std::string &name, const Image &a, const Image &b,
                    std::vector<Comparison> &comparisons);

}  // namespace rtrays::reference
