// SPDX-License-Identifier: MIT
// Error of an image against a reference that is itself noisy, and averages of images.
#pragma once

#include <array>
#include <cstdint>
#include <limits>
#include <utility>
#include <vector>

#include "renderer/base/image.h"

namespace rtrays {

/// Error of an image over all pixels and colour channels. d = image - reference, r = reference. The
/// unit is that of the pixels (radiance), or its square.
struct ErrorMetrics {
    double l2 = 0;      ///< sqrt(sum d^2), the norm of the thesis (4.2)
    double rmse = 0;    ///< l2 / sqrt(3 W H)
    double mae = 0;     ///< mean |d|
    double relmse = 0;  ///< mean(d^2 / (r^2 + 0.01))
    double mse = 0;     ///< rmse^2
    /// mean (min(image, 1) - min(r, 1))^2: the MSE of the images that a display shows
    double mse_clipped = 0;
};

/// The metrics with their keys. The table serves to read and write run.json and print comparisons.
constexpr std::array<std::pair<const char *, double ErrorMetrics::*>, 6> metric_keys{{
    {"l2", &ErrorMetrics::l2},
    {"rmse", &ErrorMetrics::rmse},
    {"mae", &ErrorMetrics::mae},
    {"relmse", &ErrorMetrics::relmse},
    {"mse", &ErrorMetrics::mse},
    {"mse_clipped", &ErrorMetrics::mse_clipped},
}};

/// Throws `Error` (bad input) if sizes or data windows differ or an image has no pixels.
void require_same_size(const Image &a, const Image &b);

/// Returns whether an image has the layers variance.R, .G and .B.
bool has_variance(const Image &image);

/// Computes the metrics with sums in double precision. Throws `Error` (bad input) if sizes or data
/// windows differ, a colour channel is missing or a value is not finite.
ErrorMetrics compute_metrics(const Image &image, const Image &reference);

/// Reference image averaged from two halves with different seeds.
struct Reference {
    Image image;           ///< (a + b) / 2, with variance layers if both halves have them
    double noise_mse = 0;  ///< expected MSE of `image` itself: mean(((a - b) / 2)^2)
};

/// Averages two halves and estimates the noise of the average from their difference. For
/// independent a and b of equal variance v, Var((a + b) / 2) = v / 2 = E[((a - b) / 2)^2].
Reference combine_halves(const Image &a, const Image &b);

/// Subtracts the reference's noise from the MSE of an image that shares no samples with it. The
/// result is negative if the image is better than the reference can resolve.
inline double unbiased_mse(double mse, double noise_mse) {
    return mse - noise_mse;
}

/// Returns whether the reference is too noisy to judge an error: its noise exceeds 10 % of the MSE.
inline bool noise_dominates(double mse, double noise_mse) {
    return !(noise_mse <= 0.1 * mse);
}

/// Returns how many times the samples the reference needs at least, so that its noise no longer
/// dominates: its noise falls as one over its samples. Infinite if the MSE is that of the noise.
inline double missing_samples(double mse, double noise_mse) {
    const double own = unbiased_mse(mse, noise_mse);
    return own > 0 ? 9 * noise_mse / own : std::numeric_limits<double>::infinity();
}

/// Averages independent images with equal sample counts. "variance.*" becomes the variance of the
/// mean, and "samples" the total. Other layers are dropped. The first image gives the attributes.
Image average_images(const std::vector<Image> &images);

/// Averages independent renders that differ only in their seeds. "variance.*" is the variance of
/// the mean, estimated from the scatter of the renders (image count - 1 degrees of freedom per
/// pixel). Use it for renderers that write no variance. Throws `Error` (bad input) for fewer than
/// two images and if sizes or data windows differ.
Image average_runs(const std::vector<Image> &images);

/// Returns R, G, B of the last of `count` batches of equal size. `all` is the mean of all batches,
/// and `before` the mean of the others (any image if `count` is 1). The difference of the sums is
/// taken in double precision. The rounding of float32 pixels is 1e-7 of the sums.
Image last_batch(const Image &before, const Image &all, uint64_t count);

/// Returns base + (image - other) for R, G, B. If image and other share samples, their difference
/// has little noise.
Image shifted(const Image &base, const Image &image, const Image &other);

/// Averages squares of `factor` x `factor` pixels. With a box filter of one pixel, the result is
/// exactly the image that the camera gives on the smaller film. Variances are computed as those of
/// independent pixels. Throws `Error` (bad input) if size and position are not divisible by
/// `factor`.
Image downsample(const Image &image, int factor);

}  // namespace rtrays
