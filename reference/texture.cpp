// SPDX-License-Identifier: MIT
#include "reference/texture.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>

#include "renderer/base/error.h"

namespace rtrays::reference {

namespace {

/// Decodes an sRGB value (IEC 61966-2-1).
double decode_srgb(double encoded) {
    return encoded <= 0.04045 ? encoded / 12.92 : std::pow((encoded + 0.055) / 1.055, 2.4);
}

using ByteTable = std::array<double, 256>;

ByteTable make_table(bool srgb) {
    ByteTable table;
    for (size_t i = 0; i < table.size(); ++i) {
        const double value = static_cast<double>(i) / 255.0;
        table[i] = srgb ? decode_srgb(value) : value;
    }
    return table;
}

const std::array<ByteTable, 2> byte_tables{make_table(false), make_table(true)};

}  // namespace

Spectrum texel(const TextureImage &image, int column, int row) {
    const size_t first = 3 * (static_cast<size_t>(row) * static_cast<size_t>(image.width) +
                              static_cast<size_t>(column));
    if (image.bytes.empty()) {
        const float *values = image.floats.data() + first;
        return {static_cast<double>(values[0]), static_cast<double>(values[1]),
                static_cast<double>(values[2])};
    }
    const ByteTable &table = byte_tables[image.srgb ? 1 : 0];
    const uint8_t *values = image.bytes.data() + first;
    return {table[values[0]], table[values[1]], table[values[2]]};
}

void require_valid(const TextureImage *image, const std::string &what) {
    if (image == nullptr || image->width < 1 || image->height < 1) {
        throw input_error(fmt::format("{}: the image is missing or empty", what));
    }
    const size_t values =
        3 * static_cast<size_t>(image->width) * static_cast<size_t>(image->height);
    if (image->bytes.size() + image->floats.size() != values ||
        (!image->bytes.empty() && !image->floats.empty())) {
        throw input_error(fmt::format("{}: the number of texels differs from the image size {}x{}",
                                      what, image->width, image->height));
    }
    const auto usable = [](float value) { return value >= 0.0f && std::isfinite(value); };
    if (!std::all_of(image->floats.begin(), image->floats.end(), usable)) {
        throw input_error(fmt::format("{}: a texel is negative or not finite", what));
    }
}

Texture::Texture(const TextureArrays &textures, size_t index)
    : image_(textures.image.at(index)),
      filter_(textures.filter.at(index)),
      wrap_(textures.wrap.at(index)),
      scale_(textures.uv_scale.at(index)),
      offset_(textures.uv_offset.at(index)),
      has_vertex_colours_(textures.has_vertex_colours(static_cast<uint32_t>(index))) {
    require_valid(image_.get(), fmt::format("texture '{}'", textures.name.at(index)));
}

int Texture::wrap(int64_t i, int size) const {
    if (wrap_ == TextureArrays::Wrap::clamp) {
        return static_cast<int>(std::clamp<int64_t>(i, 0, size - 1));
    }
    // A mirrored image and the image itself repeat together.
    const int64_t period = wrap_ == TextureArrays::Wrap::mirror ? int64_t{2} * size : size;
    const int64_t remainder = i % period;
    const int64_t texel = remainder < 0 ? remainder + period : remainder;
    return static_cast<int>(texel < size ? texel : period - 1 - texel);
}

Spectrum Texture::mean() const {
    Spectrum sum = Spectrum::Zero();
    for (int row = 0; row < image_->height; ++row) {
        for (int column = 0; column < image_->width; ++column) {
            sum += texel(*image_, column, row);
        }
    }
    return sum / (static_cast<double>(image_->width) * image_->height);
}

Spectrum Texture::look_up(double column, double row_from_below) const {
    return texel(*image_, wrap(static_cast<int64_t>(column), image_->width),
                 image_->height - 1 - wrap(static_cast<int64_t>(row_from_below), image_->height));
}

Eigen::Vector2d Texture::texel_coordinates(const Eigen::Vector2d &uv) const {
    // From the lower left corner. Coordinates beyond 2^52 texels have no fraction and would
    // overflow integers. They are clamped to that value, where every texel is equally valid.
    const auto coordinate = [](double x) { return std::clamp(x, -0x1p52, 0x1p52); };
    return {coordinate((scale_.x() * uv.x() + offset_.x()) * image_->width),
            coordinate((scale_.y() * uv.y() + offset_.y()) * image_->height)};
}

Texture::Cell Texture::cell(const Eigen::Vector2d &uv) const {
    const Eigen::Vector2d at = texel_coordinates(uv).array() - 0.5;
    const double column = std::floor(at.x()), row = std::floor(at.y());
    return {look_up(column, row),
            look_up(column + 1.0, row),
            look_up(column, row + 1.0),
            look_up(column + 1.0, row + 1.0),
            at.x() - column,
            at.y() - row};
}

Spectrum Texture::evaluate(const TexturePoint &at) const {
    const Spectrum colour = image_colour(at.uv);
    return has_vertex_colours_ ? Spectrum(colour * at.vertex_colour) : colour;
}

Spectrum Texture::image_colour(const Eigen::Vector2d &uv) const {
    if (filter_ == TextureArrays::Filter::nearest) {
        const Eigen::Vector2d at = texel_coordinates(uv);
        return look_up(std::floor(at.x()), std::floor(at.y()));
    }
    const Cell c = cell(uv);
    const Spectrum below = (1.0 - c.right) * c.lower_left + c.right * c.lower_right;
    const Spectrum above = (1.0 - c.right) * c.upper_left + c.right * c.upper_right;
    return (1.0 - c.up) * below + c.up * above;
}

double luminance(const Spectrum &colour) {
    const bool is_grey = colour[0] == colour[1] && colour[1] == colour[2];
    return is_grey ? colour[0] : 0.2126 * colour[0] + 0.7152 * colour[1] + 0.0722 * colour[2];
}

Eigen::Vector2d Texture::luminance_gradient(const Eigen::Vector2d &uv) const {
    if (filter_ == TextureArrays::Filter::nearest) {
        return Eigen::Vector2d::Zero();
    }
    const Cell c = cell(uv);
    const double by_column = (1.0 - c.up) * luminance(c.lower_right - c.lower_left) +
                             c.up * luminance(c.upper_right - c.upper_left);
    const double by_row = (1.0 - c.right) * luminance(c.upper_left - c.lower_left) +
                          c.right * luminance(c.upper_right - c.lower_right);
    return {by_column * image_->width * scale_.x(), by_row * image_->height * scale_.y()};
}

}  // namespace rtrays::reference
