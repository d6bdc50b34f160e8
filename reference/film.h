// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <vector>

#include "reference/math.h"
#include "renderer/base/image.h"

namespace rtrays::reference {

/// Sum and squared deviations of the samples of one pixel, per channel. The result depends on the
/// order of the samples alone, so a run that was cut anywhere and resumed has the same bits.
class PixelMoments {
  public:
    /// Adds sample number `count` (from 0).
    ///
    /// The sum carries its rounding errors along (Knuth's TwoSum; Ogita, Rump & Oishi 2005,
    /// algorithm 4.1: error about 2^-53 |sum| whatever the count). Squared deviations are added
    /// from the running mean (Welford 1962), since sum of squares minus square of the sum cancels
    /// where the variance is small.
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

    /// Unbiased estimate of the variance of `mean`; zero for fewer than two samples.
    Spectrum variance_of_mean(uint64_t count) const {
        const auto n = static_cast<double>(count);
        return count < 2 ? Spectrum(Spectrum::Zero()) : Spectrum(deviations_ / (n * (n - 1.0)));
    }

    /// Of `count` samples of which only this is known.
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

/// The accumulated samples of an image; every pixel holds the samples [begin, end).
struct Film {
    Film(int film_width, int film_height, uint64_t first_sample)
        : width(film_width),
          height(film_height),
          begin(first_sample),
          end(first_sample),
          pixels(static_cast<size_t>(film_width) * static_cast<size_t>(film_height)) {}

    uint64_t count() const { return end - begin; }

    /// R, G, B, variance.R, .G, .B (of the mean), samples.
    Image develop() const;

    /// The film of which that was developed, means and variances as float32 has them (relative
    /// error 6e-8).
    static Film of(const Image &developed, uint64_t first_sample, uint64_t end_sample);

    int width;
    int height;
    uint64_t begin;
    uint64_t end;
    std::vector<PixelMoments> pixels;  ///< rows from the top
};

}  // namespace rtrays::reference
