// SPDX-License-Identifier: MIT
// Means of the texels of textured area lights, by which lights and triangles are selected.
#include <algorithm>
#include <cmath>

#include "renderer/compile/compile_scene.h"
#include "renderer/scene/cores/texture.h"

namespace rtrays {

namespace {

using Wrap = TextureArrays::Wrap;

/// A range of texels along one axis, from `first` up to but without `end`.
struct TexelRange {
    size_t first, end;
};

/// Returns the index of the texel that a lookup at texel `i` reads.
int64_t wrapped(int64_t i, int64_t size, Wrap wrap) {
    if (wrap == Wrap::clamp) {
        return std::clamp<int64_t>(i, 0, size - 1);
    }
    const int64_t period = wrap == Wrap::mirror ? 2 * size : size;
    const int64_t rest = (i % period + period) % period;
    return rest < size ? rest : period - 1 - rest;
}

/// Returns ranges that contain the texels which lookups between the coordinates `low` and `high`
/// read. They do not overlap.
std::vector<TexelRange> texels_between(double low, double high, size_t texels, Wrap wrap) {
    const auto size = static_cast<int64_t>(texels);
    const auto make = [](int64_t first, int64_t last) {
        return TexelRange{static_cast<size_t>(first), static_cast<size_t>(last) + 1};
    };
    // Bilinear lookups reach half a texel further. The rest covers the rounding of coordinates.
    const double margin =
        1.5 + 0x1p-20 * static_cast<double>(size) * std::max(std::abs(low), std::abs(high));
    const double from = std::floor(low * static_cast<double>(size) - margin);
    const double to = std::floor(high * static_cast<double>(size) + margin);
    if (!(to - from + 1 < static_cast<double>(size)) || !(std::abs(from) < 0x1p52)) {
        return {make(0, size - 1)};
    }
    const auto begin = static_cast<int64_t>(from), end = static_cast<int64_t>(to);
    const int64_t first = wrapped(begin, size, wrap), last = wrapped(end, size, wrap);
    if (wrap == Wrap::repeat && first > last) {
        return {make(first, size - 1), make(0, last)};
    }
    const auto tile = [&](int64_t i) { return i >= 0 ? i / size : -((size - 1 - i) / size); };
    if (wrap == Wrap::mirror && tile(begin) != tile(end)) {
        // The range turns back at the edge between two tiles.
        return {tile(begin) % 2 == 0 ? make(std::min(first, last), size - 1)
                                     : make(0, std::max(first, last))};
    }
    return {make(std::min(first, last), std::max(first, last))};
}

/// Returns the sum of a table's entries over the texels of a rectangle.
template <typename T>
T sum_over(const std::vector<T> &table, size_t width, TexelRange columns, TexelRange rows) {
    const auto at = [&](size_t x, size_t y) { return table[y * (width + 1) + x]; };
    return (at(columns.end, rows.end) - at(columns.first, rows.end)) -
           (at(columns.end, rows.first) - at(columns.first, rows.first));
}

}  // namespace

uint32_t emission_texture(const SceneArrays &scene, size_t light) {
    const LightArrays &lights = scene.lights;
    if (lights.kind[light] != LightArrays::Kind::diffuse_area) {
        return no_index;
    }
    const uint32_t material = lights.mesh[light] != no_index
                                  ? scene.meshes.material[lights.mesh[light]]
                                  : scene.shapes.material[lights.shape[light]];
    const std::vector<uint32_t> &textures = scene.materials.emission_texture;
    return material < textures.size() ? textures[material] : no_index;
}

EmissionMeans::EmissionMeans(const TextureArrays &textures, uint32_t texture, const Rgb &radiance)
    : textures_(textures), texture_(texture) {
    const TextureImage &image = *textures.image[texture];
    width_ = static_cast<size_t>(image.width);
    height_ = static_cast<size_t>(image.height);
    sums_.assign((width_ + 1) * (height_ + 1), 0.0);
    positive_.assign(sums_.size(), 0u);
    for (size_t y = 0; y < height_; ++y) {
        double row = 0;
        uint32_t row_positive = 0;
        for (size_t x = 0; x < width_; ++x) {
            double value = 0;
            for (size_t c = 0; c < 3; ++c) {
                const size_t at = 3 * ((height_ - 1 - y) * width_ + x) + c;
                value += static_cast<double>(radiance[static_cast<Eigen::Index>(c)]) *
                         decoded_channel(image, at) / 3;
            }
            row += value;
            row_positive += value > 0 ? 1 : 0;
            const size_t to = (y + 1) * (width_ + 1) + x + 1;
            sums_[to] = sums_[to - width_ - 1] + row;
            positive_[to] = positive_[to - width_ - 1] + row_positive;
        }
    }
}

double EmissionMeans::of_image() const {
    return sums_.back() / static_cast<double>(width_ * height_);
}

double EmissionMeans::of_triangle(const std::array<Eigen::Vector2f, 3> &uv) const {
    std::vector<TexelRange> ranges[2];
    for (Eigen::Index axis = 0; axis < 2; ++axis) {
        const double scale = textures_.uv_scale[texture_][axis];
        const double offset = textures_.uv_offset[texture_][axis];
        double low = HUGE_VAL, high = -HUGE_VAL;
        for (const Eigen::Vector2f &corner : uv) {
            const double at = scale * static_cast<double>(corner[axis]) + offset;
            low = std::min(low, at);
            high = std::max(high, at);
        }
        ranges[axis] =
            texels_between(low, high, axis == 0 ? width_ : height_, textures_.wrap[texture_]);
    }
    double sum = 0;
    size_t count = 0, positive = 0;
    for (const TexelRange &columns : ranges[0]) {
        for (const TexelRange &rows : ranges[1]) {
            sum += sum_over(sums_, width_, columns, rows);
            positive += sum_over(positive_, width_, columns, rows);
            count += (columns.end - columns.first) * (rows.end - rows.first);
        }
    }
    // Rounding of the sums may lose dark texels beside bright ones.
    return positive == 0 ? 0.0 : std::max(sum / static_cast<double>(count), 1e-3 * of_image());
}

}  // namespace rtrays
