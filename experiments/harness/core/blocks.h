// SPDX-License-Identifier: MIT
// Sums of images over blocks of pixels, with their variances: the basis of all tests of images.
#pragma once

#include <limits>
#include <string>
#include <vector>

#include "renderer/base/image.h"

namespace rtrays {

/// Estimate of a sum, its variance with the degrees of freedom of that variance, and the skewness
/// of the batches it was computed from.
struct NoisySum {
    double value = 0;
    double variance = 0;
    double freedom = std::numeric_limits<double>::infinity();
    double skewness = 0;
};

/// Sums a channel over the pixels of every block of `size` x `size` pixels. The last sum is that of
/// the full image. Throws `Error` (bad input) for values that are not finite and for negative
/// variances.
std::vector<double> block_sums(const Image &image, const std::string &channel, int size);

/// Counts the pixels of every block and, last, of the full image.
std::vector<double> block_pixels(const Image &image, int size);

/// Names a block by its corner, "(16, 0)", or the last one "whole image".
std::string block_name(size_t block, const Image &image, int size);

/// Sums every block and the full image for a channel, 0 to 2. The variances come from the layer
/// variance.*, which is treated as exactly known (infinite degrees of freedom) unless the image
/// states the degrees of freedom of each pixel (rtrays:varianceFreedom). Those of a block then
/// follow from the variances of its pixels (Satterthwaite 1946).
std::vector<NoisySum> sums_by_layer(const Image &image, size_t channel, int size);

/// Sums every block and the full image for a channel, 0 to 2. The sums are means over the batches,
/// and the variances come from the scatter of the batches.
std::vector<NoisySum> sums_by_batch(const std::vector<Image> &batches, size_t channel, int size);

}  // namespace rtrays
