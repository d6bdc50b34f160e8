// SPDX-License-Identifier: MIT
#include "reference/film.h"

#include <fmt/format.h>

#include <cmath>
#include <cstring>
#include <utility>

#include "renderer/base/error.h"

namespace rtrays::reference {

namespace {

/// Binary digits after the point of the sums.
constexpr int sum_digits = 88, square_digits = 2 * sum_digits;

/// A whole number mantissa * 2^shift.
struct Scaled {
    int64_t mantissa;  ///< at most 2^53 in magnitude
    unsigned shift;
};

/// Returns a finite number in units of 2^-`digits`, rounded to a whole number. Only numbers below
/// 2^(53 - digits) are rounded, by `nearbyint`; scaling by a power of two is exact.
Scaled scaled(double number, int digits) {
    constexpr int precision = 53, lowest_exponent = -1075;
    constexpr uint64_t leading_one = uint64_t{1} << (precision - 1);
    uint64_t bits;
    std::memcpy(&bits, &number, sizeof bits);
    // IEEE 754: sign, 11 bits of the exponent, 52 of the fraction. A zero or a denormal number has
    // the exponent 0, hence a negative shift.
    const int shift = static_cast<int>(bits >> (precision - 1) & 0x7ff) + lowest_exponent + digits;
    if (shift < 0) {
        return {static_cast<int64_t>(std::nearbyint(std::ldexp(number, digits))), 0};
    }
    const auto magnitude = static_cast<int64_t>((bits & (leading_one - 1)) | leading_one);
    return {number < 0 ? -magnitude : magnitude, static_cast<unsigned>(shift)};
}

template <class Names>
void copy_to_channels(const std::vector<Spectrum> &values, Image &image, const Names &names) {
    for (size_t c = 0; c < names.size(); ++c) {
        std::vector<float> &channel = image.channel(names[c]);
        for (size_t i = 0; i < values.size(); ++i) {
            channel[i] = static_cast<float>(values[i][static_cast<Eigen::Index>(c)]);
        }
    }
}

}  // namespace

bool PixelSums::add_without_carry(const Spectrum &sample) {
    if (!(sample.abs() < limit).all()) {  // NaN fails the comparison as well
        return false;
    }
    if ((sample == 0.0).all()) {  // frequent, and slow below
        return true;
    }
    for (size_t c = 0; c < channels_.size(); ++c) {
        const auto [mantissa, shift] = scaled(sample[static_cast<Eigen::Index>(c)], sum_digits);
        // The limit keeps `shift` at 171 or less.
        channels_[c].sum.add_without_carry(mantissa, shift);
        channels_[c].squares.add_without_carry(static_cast<Int128>(mantissa) * mantissa, 2 * shift);
    }
    return true;
}

void PixelSums::operator+=(const PixelSums &other) {
    for (size_t c = 0; c < channels_.size(); ++c) {
        channels_[c].sum += other.channels_[c].sum;
        channels_[c].squares += other.channels_[c].squares;
    }
}

void PixelSums::carry() {
    for (Channel &channel : channels_) {
        channel.sum.carry();
        channel.squares.carry();
    }
}

Spectrum PixelSums::mean(uint64_t count) const {
    Spectrum mean;
    for (size_t c = 0; c < channels_.size(); ++c) {
        mean[static_cast<Eigen::Index>(c)] =
            channels_[c].sum.value(-sum_digits) / static_cast<double>(count);
    }
    return mean;
}

Spectrum PixelSums::variance_of_mean(uint64_t count) const {
    Spectrum variance = Spectrum::Zero();
    if (count < 2) {
        return variance;
    }
    const auto n = static_cast<double>(count);
    for (size_t c = 0; c < channels_.size(); ++c) {
        // The difference of n times the sum of squares and the square of the sum cancels, hence it
        // is computed with all digits. It is below 2^334, and the top word has the weight
        // 2^(10 * 48 - 176). It is not negative, by the inequality of Cauchy and Schwarz.
        FixedSum<11> difference;
        difference.add_multiple(channels_[c].squares, static_cast<int64_t>(count));
        const auto &words = channels_[c].sum.words();
        for (size_t k = 0; k < words.size(); ++k) {
            difference.add_multiple(channels_[c].sum, -words[k],
                                    static_cast<unsigned>(k) * FixedSum<11>::digit_bits);
        }
        variance[static_cast<Eigen::Index>(c)] =
            difference.value(-square_digits) / (n * n * (n - 1.0));
    }
    return variance;
}

PixelSums PixelSums::of(const Spectrum &mean, const Spectrum &variance_of_mean, uint64_t count) {
    if (!mean.allFinite() || !variance_of_mean.allFinite()) {
        throw input_error("an image that is not finite cannot be continued; render it again");
    }
    const auto n = static_cast<double>(count);
    PixelSums sums;
    for (size_t c = 0; c < sums.channels_.size(); ++c) {
        // All samples are the mean; the scatter around it is added to the squares.
        const auto [mantissa, shift] = scaled(mean[static_cast<Eigen::Index>(c)], sum_digits);
        FixedSum<6> sample;
        sample.add(mantissa, shift);
        FixedSum<10> square;
        square.add(static_cast<Int128>(mantissa) * mantissa, 2 * shift);
        const auto scatter =
            scaled(variance_of_mean[static_cast<Eigen::Index>(c)] * (n * (n - 1.0)), square_digits);
        sums.channels_[c].sum.add_multiple(sample, static_cast<int64_t>(count));
        sums.channels_[c].squares.add_multiple(square, static_cast<int64_t>(count));
        sums.channels_[c].squares.add(scatter.mantissa, scatter.shift);
    }
    return sums;
}

void Film::add(SampleRange range) {
    if (range.count() > PixelSums::max_count - count()) {
        throw input_error(fmt::format("samples {}:{}: a film holds at most {} samples per pixel",
                                      range.begin, range.end, PixelSums::max_count));
    }
    add_range(ranges, range);
}

void Film::merge(const Film &other) {
    if (width != other.width || height != other.height) {
        throw input_error("films of different sizes cannot be merged");
    }
    Film merged = *this;
    for (const SampleRange &range : other.ranges) {
        merged.add(range);
    }
    for (size_t i = 0; i < pixels.size(); ++i) {
        merged.pixels[i] += other.pixels[i];
    }
    *this = std::move(merged);
}

Image Film::develop(double seconds) const {
    Image image = Image::rgb(width, height);
    for (const auto &name : rgb_names("variance")) {
        image.add_channel(name);
    }
    image.add_channel("samples").assign(pixels.size(), static_cast<float>(count()));
    image.attributes()["samplesPerPixel"] = static_cast<int>(count());
    image.attributes()["renderTimeSeconds"] = static_cast<float>(seconds);
    if (count() == 0) {
        return image;
    }
    std::vector<Spectrum> means(pixels.size()), variances(pixels.size());
    for (size_t i = 0; i < pixels.size(); ++i) {
        means[i] = pixels[i].mean(count());
        variances[i] = pixels[i].variance_of_mean(count());
    }
    copy_to_channels(means, image, rgb_names());
    copy_to_channels(variances, image, rgb_names("variance"));
    return image;
}

Film Film::of(const Image &developed, SampleRange range) {
    Film film(developed.width(), developed.height());
    film.add(range);
    const auto names = rgb_names(), variance_names = rgb_names("variance");
    for (size_t i = 0; i < film.pixels.size(); ++i) {
        Spectrum mean, variance;
        for (size_t channel = 0; channel < 3; ++channel) {
            mean[static_cast<Eigen::Index>(channel)] =
                static_cast<double>(developed.channel(names[channel])[i]);
            variance[static_cast<Eigen::Index>(channel)] =
                static_cast<double>(developed.channel(variance_names[channel])[i]);
        }
        film.pixels[i] = PixelSums::of(mean, variance, film.count());
    }
    return film;
}

}  // namespace rtrays::reference
