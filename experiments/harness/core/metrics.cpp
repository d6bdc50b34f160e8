// SPDX-License-Identifier: MIT
#include "experiments/harness/core/metrics.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "renderer/base/error.h"

namespace rtrays {

namespace {

/// Sets a layer of a mean image from the sums of `count` independent values. Sample counts remain
/// sums. The variance of the mean is the sum of the variances divided by the square of `count`.
void set_mean(Image &image, const std::string &name, const std::vector<double> &sum, double count) {
    const bool is_variance = name.rfind("variance.", 0) == 0;
    const double divisor = name == "samples" ? 1 : is_variance ? count * count : count;
    auto &values = image.has(name) ? image.channel(name) : image.add_channel(name);
    for (size_t i = 0; i < sum.size(); ++i) {
        values[i] = static_cast<float>(sum[i] / divisor);
    }
}

/// Returns the data window of an image, as "(0, 0) to (7, 7)".
std::string window_of(const Image &image) {
    return fmt::format("({}, {}) to ({}, {})", image.left(), image.top(),
                       image.left() + image.width() - 1, image.top() + image.height() - 1);
}

/// Returns a black image of the size and at the position of another, with its attributes.
Image blank_like(const Image &other) {
    Image image = Image::rgb(other.width(), other.height());
    image.move_to(other.left(), other.top());
    image.attributes() = other.attributes();
    return image;
}

}  // namespace

void require_same_size(const Image &a, const Image &b) {
    if (a.width() != b.width() || a.height() != b.height()) {
        throw input_error(fmt::format("images differ in size: {}x{} and {}x{}", a.width(),
                                      a.height(), b.width(), b.height()));
    }
    if (a.left() != b.left() || a.top() != b.top()) {
        throw input_error(fmt::format(
            "images differ in their data windows: {} and {}; pixels of equal index are not the "
            "same place of the picture",
            window_of(a), window_of(b)));
    }
    if (a.pixel_count() == 0) {
        throw input_error("images have no pixels");
    }
}

bool has_variance(const Image &image) {
    const auto names = rgb_names("variance");
    return std::all_of(names.begin(), names.end(),
                       [&](const auto &name) { return image.has(name); });
}

ErrorMetrics compute_metrics(const Image &image, const Image &reference) {
    require_same_size(image, reference);
    double squares = 0, absolutes = 0, relatives = 0, clipped = 0;
    for (const auto &name : rgb_names()) {
        const auto &values = image.channel(name);
        const auto &expected = reference.channel(name);
        for (size_t i = 0; i < values.size(); ++i) {
            const double r = expected[i];
            const double d = values[i] - r;
            if (!std::isfinite(d)) {
                throw input_error(fmt::format(
                    "channel {}, pixel ({}, {}): values must be finite, got {} in the image and {} "
                    "in the reference",
                    name, i % static_cast<size_t>(image.width()),
                    i / static_cast<size_t>(image.width()), values[i], expected[i]));
            }
            squares += d * d;
            absolutes += std::abs(d);
            relatives += d * d / (r * r + 0.01);
            const double of_clipped = std::min<double>(values[i], 1) - std::min(r, 1.0);
            clipped += of_clipped * of_clipped;
        }
    }
    const double count = 3.0 * static_cast<double>(image.pixel_count());
    ErrorMetrics metrics;
    metrics.l2 = std::sqrt(squares);
    metrics.mse = squares / count;
    metrics.rmse = std::sqrt(metrics.mse);
    metrics.mae = absolutes / count;
    metrics.relmse = relatives / count;
    metrics.mse_clipped = clipped / count;
    return metrics;
}

Reference combine_halves(const Image &a, const Image &b) {
    // mean(((a - b) / 2)^2) is a quarter of the MSE between the halves.
    return {average_images({a, b}), compute_metrics(a, b).mse / 4};
}

Image average_images(const std::vector<Image> &images) {
    if (images.empty()) {
        throw input_error("no images to average");
    }
    const Image &first = images.front();
    Image result = blank_like(first);
    for (const auto &[name, unused] : first.channels()) {
        std::vector<double> sum(first.pixel_count(), 0.0);
        for (const auto &image : images) {
            require_same_size(first, image);
            const auto &values = image.channel(name);
            for (size_t i = 0; i < sum.size(); ++i) {
                sum[i] += values[i];
            }
        }
        set_mean(result, name, sum, static_cast<double>(images.size()));
    }
    return result;
}

Image average_runs(const std::vector<Image> &images) {
    if (images.size() < 2) {
        throw input_error("an average with variance needs at least two images");
    }
    const Image &first = images.front();
    const auto count = static_cast<double>(images.size());
    Image result = blank_like(first);
    for (const std::string &name : rgb_names()) {
        auto &variance = result.add_channel("variance." + name);
        auto &mean = result.channel(name);
        for (const Image &image : images) {
            require_same_size(first, image);
        }
        for (size_t i = 0; i < first.pixel_count(); ++i) {
            double sum = 0, squares = 0;
            for (const Image &image : images) {
                sum += static_cast<double>(image.channel(name)[i]);
            }
            for (const Image &image : images) {  // a second pass avoids cancellation
                const double d = static_cast<double>(image.channel(name)[i]) - sum / count;
                squares += d * d;
            }
            mean[i] = static_cast<float>(sum / count);
            variance[i] = static_cast<float>(squares / (count - 1) / count);
        }
    }
    return result;
}

Image last_batch(const Image &before, const Image &all, uint64_t count) {
    Image batch = Image::rgb(all.width(), all.height());
    const auto n = static_cast<double>(count);
    for (const std::string &name : rgb_names()) {
        const auto &mean = all.channel(name);
        for (size_t i = 0; i < mean.size(); ++i) {
            const double others =
                count > 1 ? (n - 1) * static_cast<double>(before.channel(name)[i]) : 0.0;
            batch.channel(name)[i] = static_cast<float>(n * static_cast<double>(mean[i]) - others);
        }
    }
    return batch;
}

Image shifted(const Image &base, const Image &image, const Image &other) {
    Image result = Image::rgb(base.width(), base.height());
    for (const std::string &name : rgb_names()) {
        std::vector<float> &values = result.channel(name);
        for (size_t i = 0; i < values.size(); ++i) {
            values[i] = base.channel(name)[i] + (image.channel(name)[i] - other.channel(name)[i]);
        }
    }
    return result;
}

Image downsample(const Image &image, int factor) {
    if (factor < 1 || image.width() % factor != 0 || image.height() % factor != 0) {
        throw input_error(fmt::format("image size {}x{} is not divisible by {}", image.width(),
                                      image.height(), factor));
    }
    if (image.left() % factor != 0 || image.top() % factor != 0) {
        throw input_error(fmt::format("the data window {} does not begin at a multiple of {}",
                                      window_of(image), factor));
    }
    Image result = Image::rgb(image.width() / factor, image.height() / factor);
    result.move_to(image.left() / factor, image.top() / factor);
    result.attributes() = image.attributes();
    const auto width = static_cast<size_t>(image.width());
    const auto step = static_cast<size_t>(factor);
    const size_t small_width = width / step;
    const double area = static_cast<double>(factor) * factor;
    for (const auto &[name, values] : image.channels()) {
        std::vector<double> sum(result.pixel_count(), 0.0);
        for (size_t i = 0; i < values.size(); ++i) {
            sum[(i / width / step) * small_width + (i % width) / step] += values[i];
        }
        set_mean(result, name, sum, area);
    }
    return result;
}

}  // namespace rtrays
