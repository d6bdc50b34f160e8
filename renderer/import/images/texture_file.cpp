// SPDX-License-Identifier: MIT
#include "renderer/import/images/texture_file.h"

#include <dlfcn.h>
#include <fmt/format.h>

#include <cmath>
#include <string>

#include "renderer/base/error.h"
#include "renderer/base/files.h"
#include "renderer/base/image.h"
#include "renderer/base/lower_case.h"
#include "renderer/import/images/image_module.h"
#include "renderer/scene/cores/texture.h"

namespace rtrays {

namespace {

Error file_error(const std::filesystem::path &path, const std::string &what) {
    return input_error(fmt::format("{}: {}", path.string(), what));
}

/// Returns a function of the image module, which is loaded by the first call.
template <typename Function>
Function *image_function(const char *name, const std::filesystem::path &path) {
    static void *const module = [] {
        const std::filesystem::path program = std::filesystem::read_symlink("/proc/self/exe");
        return dlopen((program.parent_path() / image_module_name).c_str(), RTLD_NOW | RTLD_LOCAL);
    }();
    if (module == nullptr) {
        throw file_error(
            path, fmt::format("image files are unsupported by this build, {} is missing beside the "
                              "program; configure with -DRTRAYS_TEXTURES=ON (requires OpenImageIO)",
                              image_module_name));
    }
    return reinterpret_cast<Function *>(dlsym(module, name));
}

void check_texels(const TextureImage &image, const std::filesystem::path &path) {
    constexpr const char *channels[] = {"red", "green", "blue"};
    for (size_t i = 0; i < image.floats.size(); ++i) {
        const float value = image.floats[i];
        if (!(value >= 0) || std::isinf(value)) {
            const auto width = static_cast<size_t>(image.width);
            throw file_error(
                path,
                fmt::format(
                    "texel ({}, {}) has the {} value {}; texels must be finite and not negative",
                    i / 3 % width, i / 3 / width, channels[i % 3], value));
        }
    }
}

}  // namespace

std::shared_ptr<const TextureImage> load_texture_file(const std::filesystem::path &path,
                                                      TextureEncoding encoding) {
    if (!is_file(path)) {
        throw file_error(path, "no such file");
    }
    RawImage raw;
    const ImageChannels channels =
        encoding == TextureEncoding::alpha ? ImageChannels::alpha : ImageChannels::colours;
    image_function<ReadImageFile>(read_image_file_name, path)(path, channels, raw);
    const bool is_srgb = encoding == TextureEncoding::srgb;
    if (is_srgb && raw.is_floating) {
        throw file_error(path, "floating-point images are linear; set \"encoding\" to \"linear\"");
    }
    auto image = std::make_shared<TextureImage>();
    image->width = raw.width;
    image->height = raw.height;
    image->srgb = is_srgb && !raw.bytes.empty();
    image->bytes = std::move(raw.bytes);
    image->floats = std::move(raw.floats);
    check_texels(*image, path);
    if (is_srgb) {  // `TextureImage` supports sRGB texels of 8 bits only
        for (float &value : image->floats) {
            value = static_cast<float>(srgb_decoded(value));
        }
    }
    return image;
}

bool holds_floats(const std::filesystem::path &path) {
    const std::string extension = lower_extension(path);
    return extension == ".exr" || extension == ".hdr" || extension == ".rgbe" ||
           extension == ".pfm";
}

bool has_alpha_channel(const std::filesystem::path &path) {
    if (!is_file(path)) {
        throw file_error(path, "no such file");
    }
    return image_function<HasAlphaChannel>(has_alpha_channel_name, path)(path);
}

void require_image_module(const std::filesystem::path &path) {
    image_function<WriteImageFile>(write_image_file_name, path);
}

void write_image_bytes(const std::filesystem::path &path, const char *format, int width, int height,
                       const std::vector<uint8_t> &rgb) {
    const auto write = image_function<WriteImageFile>(write_image_file_name, path);
    write_atomically(path, [&](const std::filesystem::path &temporary) {
        write(temporary, format, width, height, rgb.data());
    });
}

void write_texture_file(const TextureImage &image, const std::filesystem::path &path) {
    if (image.floats.empty()) {
        write_image_bytes(path, "png", image.width, image.height, image.bytes);
        return;
    }
    Image floats = Image::rgb(image.width, image.height);
    for (size_t c = 0; c < 3; ++c) {
        std::vector<float> &channel = floats.channel(rgb_names()[c]);
        for (size_t i = 0; i < channel.size(); ++i) {
            channel[i] = image.floats[3 * i + c];
        }
    }
    write_exr(floats, path);
}

std::shared_ptr<const TextureImage> TextureFiles::load(const std::filesystem::path &path,
                                                       TextureEncoding encoding) {
    std::error_code unresolved;  // such a path is not a file, which loading reports
    std::shared_ptr<const TextureImage> &image =
        images_[{std::filesystem::weakly_canonical(path, unresolved), encoding}];
    if (image == nullptr) {
        image = load_texture_file(path, encoding);
    }
    return image;
}

}  // namespace rtrays
