// SPDX-License-Identifier: MIT
#include "experiments/metrics.h"

#include <fmt/format.h>

#include <cmath>

#include "renderer/base/error.h"

namespace rtrays {

namespace {

void require_same_size(const Image &a, const Image &b) {
    if (a.width() != b.width() || a.height() != b.height()) {
        throw input_error(fmt::format("images differ in size: {}x{} and {}x{}", a.width(), a.height(),
                                      b.width(), b.height()));
    }
    if (a.pixel_count() == 0) {
        throw input_error("images have no pixels");
    }
}

bool have_variance(const Image &image) {
    for (const auto &name : rgb_names("variance")) {
        if (!image.has(name)) {
            return false;
        }
    }
    return true;
}

/// The layers that survive averaging: colour, its variance, the sample count.
std::vector<std::string> mean_layers(const Image &image) {
    std::vector<std::string> names = rgb_names();
    if (have_variance(image)) {
        for (const auto &name : rgb_names("variance")) {
            names.push_back(name);
        }
    }
    if (image.has("samples")) {
        names.push_back("samples");
    }
    return names;
}

bool is_variance(const std::string &name) {
    return name.rfind("variance.", 0) == 0;
}

std::vector<float> &writable_channel(Image &image, const std::string &name) {
    return image.has(name) ? image.channel(name) : image.add_channel(name);
}

}  // namespace

ErrorMetrics compute_metrics(const Image &image, const Image &reference) {
    require_same_size(image, reference);
    double squares = 0, absolutes = 0, relatives = 0;
    for (const auto &name : rgb_names()) {
        const auto &values = image.channel(name);
        const auto &expected = reference.channel(name);
        for (size_t i = 0; i < values.size(); ++i) {
            const double r = expected[i];
            const double d = values[i] - r;
            if (!std::isfinite(d)) {
                throw input_error(
                    fmt::format("channel {}, pixel ({}, {}): value is not finite (image {}, reference {})",
                                name, i % static_cast<size_t>(image.width()),
                                i / static_cast<size_t>(image.width()), values[i], expected[i]));
            }
            squares += d * d;
            absolutes += std::abs(d);
            relatives += d * d / (r * r + 0.01);
        }
    }
    const double count = 3.0 * static_cast<double>(image.pixel_count());
    ErrorMetrics metrics;
    metrics.l2 = std::sqrt(squares);
    metrics.mse = squares / count;
    metrics.rmse = std::sqrt(metrics.mse);
    metrics.mae = absolutes / count;
    metrics.relmse = relatives / count;
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
    Image result = Image::rgb(first.width(), first.height());
    result.attributes() = first.attributes();
    const double count = static_cast<double>(images.size());
    for (const auto &name : mean_layers(first)) {
        std::vector<double> sum(first.pixel_count(), 0.0);
        for (const auto &image : images) {
            require_same_size(first, image);
            const auto &values = image.channel(name);
            for (size_t i = 0; i < sum.size(); ++i) {
                sum[i] += values[i];
            }
        }
        const double divisor = name == "samples" ? 1 : is_variance(name) ? count * count : count;
        auto &values = writable_channel(result, name);
        for (size_t i = 0; i < sum.size(); ++i) {
            values[i] = static_cast<float>(sum[i] / divisor);
        }
    }
    return result;
}

Image downsample(const Image &image, int factor) {
    if (factor < 1 || image.width() % factor != 0 || image.height() % factor != 0) {
        throw input_error(
            fmt::format("an image of {}x{} cannot be reduced by {}", image.width(), image.height(), factor));
    }
    Image result = Image::rgb(image.width() / factor, image.height() / factor);
    result.attributes() = image.attributes();
    const auto width = static_cast<size_t>(image.width());
    const auto step = static_cast<size_t>(factor);
    const size_t small_width = width / step;
    const double area = static_cast<double>(factor) * factor;
    for (const auto &name : mean_layers(image)) {
        std::vector<double> sum(result.pixel_count(), 0.0);
        const auto &values = image.channel(name);
        for (size_t i = 0; i < values.size(); ++i) {
            sum[(i / width / step) * small_width + (i % width) / step] += values[i];
        }
        const double divisor = name == "samples" ? 1 : is_variance(name) ? area * area : area;
        auto &small = writable_channel(result, name);
        for (size_t i = 0; i < sum.size(); ++i) {
            small[i] = static_cast<float>(sum[i] / divisor);
        }
    }
    return result;
}

}  // namespace rtrays
