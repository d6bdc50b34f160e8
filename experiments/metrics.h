// SPDX-License-Identifier: MIT
// The error of an image against a reference that is itself noisy.
#pragma once

#include <array>
#include <cstdint>
#include <utility>
#include <vector>

#include "renderer/base/image.h"

namespace rtrays {

/// Error of an image over all pixels and colour channels, d = image - reference, r = reference, in
/// the unit of the pixels (radiance) or its square.
struct ErrorMetrics {
    double l2 = 0;      ///< sqrt(sum d^2), the norm of the thesis (4.2)
    double rmse = 0;    ///< l2 / sqrt(3 W H)
    double mae = 0;     ///< mean |d|
    double relmse = 0;  ///< mean(d^2 / (r^2 + 0.01))
    double mse = 0;     ///< rmse^2
};

/// The metrics by their keys: run.json is written and read, and comparisons are printed, by this
/// table.
constexpr std::array<std::pair<const char *, double ErrorMetrics::*>, 5> metric_keys{{
    {"l2", &ErrorMetrics::l2},
    {"rmse", &ErrorMetrics::rmse},
    {"mae", &ErrorMetrics::mae},
    {"relmse", &ErrorMetrics::relmse},
    {"mse", &ErrorMetrics::mse},
}};

/// Throws `Error` (bad input) when sizes differ or there are no pixels.
void require_same_size(const Image &a, const Image &b);

/// Whether the layers variance.R, .G and .B are there.
bool has_variance(const Image &image);

/// Sums in double. Throws `Error` (bad input) when sizes differ, a colour channel is missing or a
/// value is not finite.
ErrorMetrics compute_metrics(const Image &image, const Image &reference);

/// A reference made of two halves with disjoint seeds.
struct Reference {
    Image image;           ///< (a + b) / 2, with its variance layers when both halves have them
    double noise_mse = 0;  ///< expected MSE of `image` itself: mean(((a - b) / 2)^2)
};

/// For independent a and b of equal variance v, Var((a + b) / 2) = v / 2 = E[((a - b) / 2)^2].
Reference combine_halves(const Image &a, const Image &b);

/// MSE of an image that shares no samples with the reference, less the reference's own noise;
/// negative when the image is better than the reference can tell.
inline double unbiased_mse(double mse, double noise_mse) {
    return mse - noise_mse;
}

/// Whether the reference is too noisy to judge an error: its noise passes 10 % of the MSE.
inline bool noise_dominates(double mse, double noise_mse) {
    return !(noise_mse <= 0.1 * mse);
}

/// The mean of independent images of equal sample count; "variance.*" becomes the variance of that
/// mean, "samples" the total, any other layer is left out. Attributes are those of the first.
Image average_images(const std::vector<Image> &images);

/// The mean of independent renders with equal settings but for the seed; "variance.*" is the
/// variance of that mean as estimated from their spread (image count - 1 degrees of freedom per
/// pixel). For renderers that state no variance. Throws `Error` (bad input) for less than two
/// images and when sizes differ.
Image average_runs(const std::vector<Image> &images);

/// R, G, B of the last of `count` batches of equal size: `all` is the mean of them, `before` that
/// of the others (of none: any image). In double, as the difference of sums: what float32 rounds
/// off is 1e-7 of those.
Image last_batch(const Image &before, const Image &all, uint64_t count);

/// Averages squares of `factor` x `factor` pixels. With a box filter of one pixel this is exactly
/// the image the same camera gives at the smaller film; variances follow as those of independent
/// pixels. Throws `Error` (bad input) when the size is not divisible.
Image downsample(const Image &image, int factor);

}  // namespace rtrays
