// SPDX-License-Identifier: MIT
// Film of the reference: exact sums of the samples of every pixel and of their squares.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "reference/fixed_sum.h"
#include "reference/math.h"
#include "renderer/base/image.h"
#include "renderer/base/sample_ranges.h"

namespace rtrays::reference {

/// Sums of the samples of one pixel and of their squares, per channel. A sample is first rounded to
/// a multiple of 2^-88; whatever is 2^-35 or larger keeps all digits of a double. Both sums of
/// these numbers are exact. They depend on the set of samples alone, not on their order and not on
/// how they were split into films.
///
/// Bounds, for samples below 2^136 and at most 2^31 of them:
///   * the sum is below 2^167, and the top word has the weight 2^(5 * 48 - 88);
///   * the sum of squares is below 2^303, and the top word has the weight 2^(9 * 48 - 176).
class PixelSums {
  public:
    static constexpr double limit = 0x1p136;           ///< of a sample, exclusive
    static constexpr uint64_t max_count = 1ull << 31;  ///< samples
    static constexpr size_t word_count = 48;

    /// Adds samples during its lifetime, faster than one by one.
    class Adder {
      public:
        explicit Adder(PixelSums &sums) : sums_(sums) {}
        ~Adder() { sums_.carry(); }
        Adder(const Adder &) = delete;
        Adder &operator=(const Adder &) = delete;

        /// As `PixelSums::add`.
        bool add(const Spectrum &sample) {
            constexpr int most = 31;  // by FixedSum::add_without_carry
            if (++added_ % most == 0) {
                sums_.carry();
            }
            return sums_.add_without_carry(sample);
        }

      private:
        PixelSums &sums_;
        int added_ = 0;
    };

    /// Adds a sample. Returns false, and adds nothing, unless all channels are finite and smaller
    /// than `limit`.
    bool add(const Spectrum &sample) { return Adder(*this).add(sample); }

    /// Adds the samples of another film.
    void operator+=(const PixelSums &other);

    /// Propagates the carries after words were added from outside.
    void carry();

    /// Returns the mean of the `count` samples, with a relative error below 2^-50.
    Spectrum mean(uint64_t count) const;

    /// Returns an unbiased estimate of the variance of `mean`, with a relative error below 2^-49;
    /// zero for fewer than two samples.
    Spectrum variance_of_mean(uint64_t count) const;

    /// Returns sums of `count` samples with the given mean and variance of the mean, two images of
    /// floats. Throws `Error` (bad input) if they are not finite.
    static PixelSums of(const Spectrum &mean, const Spectrum &variance_of_mean, uint64_t count);

  private:
    bool add_without_carry(const Spectrum &sample);

    struct Channel {
        FixedSum<6> sum;       ///< in units of 2^-88
        FixedSum<10> squares;  ///< in units of 2^-176
    };
    std::array<Channel, 3> channels_;
};

/// Accumulated samples of an image.
struct Film {
    Film(int film_width, int film_height)
        : width(film_width),
          height(film_height),
          pixels(static_cast<size_t>(film_width) * static_cast<size_t>(film_height)) {}

    uint64_t count() const { return count_samples(ranges); }

    /// Notes that all pixels hold the samples of a range. Throws `Error` (bad input) if the film
    /// has some of them already, or would have more than `PixelSums::max_count`.
    void add(SampleRange range);

    /// Adds other samples of the same image. Throws `Error` (bad input) if sizes differ or samples
    /// are in both films; this film then stays.
    void merge(const Film &other);

    /// Returns an image with the channels R, G, B, variance.R, variance.G, variance.B (variances of
    /// the mean) and samples, and the attributes samplesPerPixel and renderTimeSeconds.
    Image develop(double seconds = 0) const;

    /// Reconstructs a film from its developed image. Means and variances have the precision of
    /// float32 (relative error 6e-8). Throws `Error` (bad input) if the image is not finite.
    static Film of(const Image &developed, SampleRange range);

    int width;
    int height;
    SampleRanges ranges;
    std::vector<PixelSums> pixels;  ///< rows from the top
};

}  // namespace rtrays::reference
