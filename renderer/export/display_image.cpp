// SPDX-License-Identifier: MIT
#include "renderer/export/display_image.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <string>

#include "renderer/base/error.h"
#include "renderer/base/files.h"
#include "renderer/import/images/texture_file.h"
#include "renderer/scene/cores/texture.h"

namespace rtrays {

namespace {

/// Name that OpenImageIO gives the format of a display image; null for any other name.
const char *display_format(const std::filesystem::path &path) {
    const std::string ending = path.extension().string();
    return ending == ".png" ? "png" : ending == ".jpg" || ending == ".jpeg" ? "jpeg" : nullptr;
}

}  // namespace

std::vector<uint8_t> display_bytes(const Image &image, double exposure) {
    const double scale = std::exp2(exposure);
    std::vector<uint8_t> bytes(3 * image.pixel_count());
    for (size_t c = 0; c < 3; ++c) {
        const std::vector<float> &radiance = image.channel(rgb_names()[c]);
        for (size_t i = 0; i < radiance.size(); ++i) {
            const double linear = scale * static_cast<double>(radiance[i]);
            // The comparison is false for NaN, of 0 times infinity too.
            const double shown = linear > 0 ? srgb_encoded(std::min(linear, 1.0)) : 0.0;
            bytes[3 * i + c] = static_cast<uint8_t>(std::lround(255 * shown));
        }
    }
    return bytes;
}

void require_image_output(const std::filesystem::path &path) {
    require_writable(path);
    if (display_format(path) != nullptr) {
        require_image_module(path);
    } else if (path.extension() != ".exr") {
        throw input_error(fmt::format(
            "{}: unknown image format; use .exr (linear, with layers), .png or .jpg (for display)",
            path.string()));
    }
}

void write_image(const Image &image, const std::filesystem::path &path, double exposure) {
    if (const char *format = display_format(path)) {
        write_image_bytes(path, format, image.width(), image.height(),
                          display_bytes(image, exposure));
    } else {
        write_exr(image, path);
    }
}

}  // namespace rtrays
