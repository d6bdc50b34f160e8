// SPDX-License-Identifier: MIT
#include "renderer/import/mitsuba/envmap.h"

#include <fmt/format.h>

#include <algorithm>

#include "renderer/base/error.h"
#include "renderer/scene/cores/texture.h"

namespace rtrays::mitsuba {

namespace {

size_t row_length(const TextureImage &image) {
    return 3 * static_cast<size_t>(image.width);
}

/// Sets row `to` of `result` to (1 - t) a + t b, where a and b are rows of `image`.
void mix_rows(const TextureImage &image, int a, int b, float t, TextureImage &result, int to) {
    const size_t length = row_length(image);
    const float *first = image.floats.data() + static_cast<size_t>(a) * length;
    const float *second = image.floats.data() + static_cast<size_t>(b) * length;
    float *out = result.floats.data() + static_cast<size_t>(to) * length;
    for (size_t i = 0; i < length; ++i) {
        out[i] = (1.0f - t) * first[i] + t * second[i];
    }
}

TextureImage with_rows(const TextureImage &image, int height) {
    TextureImage result;
    result.width = image.width;
    result.height = height;
    result.floats.resize(row_length(image) * static_cast<size_t>(height));
    return result;
}

TextureImage decoded(const TextureImage &image) {
    TextureImage result = image;
    if (result.floats.empty()) {
        result.srgb = false;
        result.bytes.clear();
        for (const uint8_t byte : image.bytes) {
            result.floats.push_back(static_cast<float>(srgb_decoded(byte / 255.0)));
        }
    }
    return result;
}

/// Returns the number of our rows between two of Mitsuba's rows: the more, the smaller the error,
/// but an image of moderate size should not become a large one.
int rows_between(const TextureImage &image) {
    constexpr int64_t most_texels = 1 << 20;
    const int64_t texels = int64_t{image.width} * (image.height - 1);
    return static_cast<int>(std::clamp<int64_t>(most_texels / texels, 2, 32));
}

}  // namespace

TextureImage to_mitsuba_envmap(const TextureImage &image) {
    TextureImage wide = image;
    if (image.width == 1) {
        wide.width = 2;
        wide.floats.clear();
        for (size_t i = 0; i < image.floats.size(); i += 3) {
            for (int copy = 0; copy < 2; ++copy) {
                wide.floats.insert(wide.floats.end(),
                                   image.floats.begin() + static_cast<std::ptrdiff_t>(i),
                                   image.floats.begin() + static_cast<std::ptrdiff_t>(i + 3));
            }
        }
    }
    TextureImage result = with_rows(wide, 2 * wide.height + 1);
    for (int row = 0; row < result.height; ++row) {
        const int above = std::max((row - 1) / 2, 0);
        const int below = std::min(row / 2, wide.height - 1);
        mix_rows(wide, above, below, 0.5f, result, row);  // exact where both rows are the same
    }
    return result;
}

TextureImage from_mitsuba_envmap(const TextureImage &image) {
    if (image.width < 2 || image.height < 3) {
        throw input_error(
            fmt::format("environment image has {}x{} texels; Mitsuba requires at least 2x3",
                        image.width, image.height));
    }
    const TextureImage rows = decoded(image);
    if (image.height % 2 == 1) {
        TextureImage odd = with_rows(rows, image.height / 2);
        for (int row = 0; row < odd.height; ++row) {
            mix_rows(rows, 2 * row + 1, 2 * row + 1, 0.0f, odd, row);
        }
        if (to_mitsuba_envmap(odd).floats == rows.floats) {
            return odd;
        }
    }
    const int between = rows_between(image);
    TextureImage result = with_rows(rows, between * (image.height - 1));
    for (int row = 0; row < result.height; ++row) {
        const float t = (static_cast<float>(row % between) + 0.5f) / static_cast<float>(between);
        mix_rows(rows, row / between, row / between + 1, t, result, row);
    }
    return result;
}

}  // namespace rtrays::mitsuba
