// SPDX-License-Identifier: MIT
#include "renderer/scene/cores/texture.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include "renderer/scene/cores/material.h"

namespace rtrays {

namespace {

/// Returns the largest value of each channel, decoded.
Rgb find_largest_texel(const TextureImage &image) {
    const auto largest = [](const auto &values) {
        std::array<typename std::decay_t<decltype(values)>::value_type, 3> most{};
        for (size_t i = 0; i < values.size(); ++i) {
            most[i % 3] = std::max(most[i % 3], values[i]);
        }
        return most;
    };
    if (!image.floats.empty()) {
        const std::array<float, 3> most = largest(image.floats);
        return {most[0], most[1], most[2]};
    }
    const std::array<uint8_t, 3> most = largest(image.bytes);
    Rgb decoded;
    for (int i = 0; i < 3; ++i) {
        const double value = most[static_cast<size_t>(i)] / 255.0;
        decoded[i] = static_cast<float>(image.srgb ? srgb_decoded(value) : value);
    }
    return decoded;
}

}  // namespace

const ParameterTable &Texture::parameter_table() {
    // Texture coordinates have the same limit, so that the products are far within the range of
    // float.
    constexpr Range modest{-1e6, 1e6, true, true};
    using Need = Parameter::Need;
    static const ParameterTable table = {
        {"filter",
         "interpolation between texels",
         std::string("bilinear"),
         Need::defaulted,
         ranges::any,
         {"nearest", "bilinear"}},
        {"wrap", "continuation beyond the edges of the image", std::string("repeat"),
         Need::defaulted, ranges::any, wrap_names()},
        {"uv_scale", "scale of the texture coordinates", Eigen::Vector2d(1, 1), Need::defaulted,
         modest},
        {"uv_offset", "offset added to the scaled texture coordinates", Eigen::Vector2d(0, 0),
         Need::defaulted, modest},
        {"vertex_colours", "the colours of vertices multiply the image", false},
    };
    return table;
}

const std::vector<std::string> &wrap_names() {
    static const std::vector<std::string> names = {"repeat", "clamp", "mirror"};
    return names;
}

const std::shared_ptr<const TextureImage> &white_image() {
    static const std::shared_ptr<const TextureImage> image = [] {
        TextureImage white;
        white.width = white.height = 1;
        white.bytes.assign(3, 255);
        return std::make_shared<const TextureImage>(white);
    }();
    return image;
}

Texture::Texture(std::string name, std::shared_ptr<const TextureImage> image,
                 const ParameterValues &values)
    : PropertyHolder(std::move(name)),
      image_(std::move(image)),
      largest_texel_(find_largest_texel(*image_)),
      parameters_("texture", parameter_table(), values) {}

void Texture::set(const std::string &name, const PropertyValue &value) {
    parameters_.set(name, value);
    ++version_;
    for (MaterialCore *material : users_) {
        material->texture_changed();
    }
}

std::vector<Property> Texture::properties() {
    std::vector<Property> all = parameters_.properties(
        [this](const std::string &name, const PropertyValue &value) { set(name, value); });
    all.push_back(make_property<double>("width", "width of the image, texels",
                                        [this] { return image_->width; }));
    all.push_back(make_property<double>("height", "height of the image, texels",
                                        [this] { return image_->height; }));
    return all;
}

double srgb_decoded(double value) {
    return value <= 0.04045 ? value / 12.92 : std::pow((value + 0.055) / 1.055, 2.4);
}

double decoded_channel(const TextureImage &image, size_t i) {
    if (!image.floats.empty()) {
        return static_cast<double>(image.floats[i]);
    }
    const double value = image.bytes[i] / 255.0;
    return image.srgb ? srgb_decoded(value) : value;
}

double luminance(const Eigen::Vector3d &rgb) {
    return rgb[1] + 0.2126 * (rgb[0] - rgb[1]) + 0.0722 * (rgb[2] - rgb[1]);
}

double brightest_luminance(const Texture &texture) {
    return luminance(texture.largest_texel().cast<double>());
}

double srgb_encoded(double value) {
    return value <= 0.0031308 ? 12.92 * value : 1.055 * std::pow(value, 1 / 2.4) - 0.055;
}

}  // namespace rtrays
