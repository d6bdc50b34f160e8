// SPDX-License-Identifier: MIT
// Film of the reference: sums and squared deviations of the samples of every pixel.
#pragma once

#include <cstdint>
#include <vector>

#include "reference/math.h"
#include "renderer/base/image.h"

namespace rtrays::reference {

/// Sum and squared deviations of the samples of one pixel, per channel. The result depends only on
/// the order of the samples, so a run that was interrupted and resumed has the same bits.
class PixelMoments {
  public:
    /// Adds sample number `count` (from 0).
    ///
    /// The sum is compensated for rounding errors (Knuth's TwoSum; Ogita, Rump & Oishi 2005,
    /// algorithm 4.1). Its error is about 2^-53 |sum| for any count. Squared deviations are added
    /// from the running mean (Welford 1962). The sum of squares minus the square of the sum would
    /// cancel where the variance is small.
    void add(const Spectrum &value, uint64_t count) {
        const auto n = static_cast<double>(count);
        if (count > 0) {
            const Spectrum deviation = value - (sum_ + compensation_) / n;
            deviations_ += deviation * deviation * (n / (n + 1.0));
        }
        const Spectrum total = sum_ + value;
        const Spectrum added = total - sum_;
        compensation_ += (sum_ - (total - added)) + (value - added);
        sum_ = total;
    }

    Spectrum mean(uint64_t count) const {
        return (sum_ + compensation_) / static_cast<double>(count);
    }

    /// Returns an unbiased estimate of the variance of `mean`; zero for fewer than two samples.
    Spectrum variance_of_mean(uint64_t count) const {
        const auto n = static_cast<double>(count);
        return count < 2 ? Spectrum(Spectrum::Zero()) : Spectrum(deviations_ / (n * (n - 1.0)));
    }

    /// Returns moments of `count` samples with the given mean and variance of the mean.
    static PixelMoments of(const Spectrum &mean, const Spectrum &variance_of_mean, uint64_t count) {
        const auto n = static_cast<double>(count);
        PixelMoments moments;
        moments.sum_ = mean * n;
        moments.deviations_ = variance_of_mean * (n * (n - 1.0));
        return moments;
    }

  private:
    Spectrum sum_ = Spectrum::Zero();
    Spectrum compensation_ = Spectrum::Zero();
    Spectrum deviations_ = Spectrum::Zero();
};

/// Accumulated samples of an image. Every pixel holds the samples [begin, end).
struct Film {
    Film(int film_width, int film_height, uint64_t first_sample)
        : width(film_width),
          height(film_height),
          begin(first_sample),
          end(first_sample),
          pixels(static_cast<size_t>(film_width) * static_cast<size_t>(film_height)) {}

    uint64_t count() const { return end - begin; }

    /// Returns an image with the channels R, G, B, variance.R, variance.G, variance.B (variances of
    /// the mean) and samples.
    Image develop() const;

    /// Reconstructs a film from its developed image. Means and variances have the precision of
    /// float32 (relative error 6e-8).
    static Film of(const Image &developed, uint64_t first_sample, uint64_t end_sample);

    int width;
    int height;
    uint64_t begin;
    uint64_t end;
    std::vector<PixelMoments> pixels;  ///< rows from the top
};

}  // namespace rtrays::reference
