// SPDX-License-Identifier: MIT
// The image module: reads texture images and writes PNG files through OpenImageIO.
#include "renderer/import/images/image_module.h"

#include <OpenImageIO/imageio.h>
#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <exception>
#include <memory>
#include <string>

#include "renderer/base/error.h"

namespace rtrays {

namespace {

/// Maximum number of texels of an RGB image (1.6 GB of floats). A larger size in a header means a
/// damaged file.
constexpr int64_t most_texels = int64_t(1) << 27;

Error file_error(const std::filesystem::path &path, const std::string &what) {
    return input_error(fmt::format("{}: {}", path.string(), what));
}

/// Returns an error message of OpenImageIO on one line.
std::string in_one_line(std::string message) {
    while (!message.empty() && std::isspace(static_cast<unsigned char>(message.back()))) {
        message.pop_back();
    }
    for (size_t at = message.find('\n'); at != std::string::npos; at = message.find('\n', at)) {
        message.replace(at, 1, "; ");
    }
    return message.empty() ? "unexpected end of file" : message;
}

/// Returns the indices of the channels to use as red, green and blue.
std::vector<int> used_channels(const OIIO::ImageSpec &spec, ImageChannels channels,
                               const std::filesystem::path &path) {
    if (channels == ImageChannels::alpha) {
        if (spec.alpha_channel < 0) {
            throw file_error(path, "the image has no alpha channel");
        }
        return std::vector<int>(3, spec.alpha_channel);
    }
    const auto find = [&](const char *name) {
        const auto found = std::find(spec.channelnames.begin(), spec.channelnames.end(), name);
        return static_cast<int>(found - spec.channelnames.begin());
    };
    const std::vector<int> rgb = {find("R"), find("G"), find("B")};
    if (*std::max_element(rgb.begin(), rgb.end()) < spec.nchannels) {
        return rgb;
    }
    if (spec.nchannels == 1 || (spec.nchannels == 2 && spec.alpha_channel >= 0)) {
        const int grey = spec.nchannels == 2 && spec.alpha_channel == 0 ? 1 : 0;
        return {grey, grey, grey};
    }
    std::string names;
    for (const std::string &name : spec.channelnames) {
        names += (names.empty() ? "" : ", ") + name;
    }
    throw file_error(
        path,
        fmt::format("unsupported channels {}; expected R, G and B, or one grey channel", names));
}

void check_header(const OIIO::ImageSpec &spec, const std::filesystem::path &path) {
    if (spec.width < 1 || spec.height < 1 || spec.depth > 1 || spec.deep || spec.nchannels < 1 ||
        static_cast<int64_t>(spec.width) * spec.height > most_texels / spec.nchannels * 3) {
        throw file_error(
            path,
            fmt::format("unsupported image of {} x {} x {}{} with {} channels; expected a flat "
                        "image of at most 2^27 RGB texels",
                        spec.width, spec.height, spec.depth, spec.deep ? " deep samples" : "",
                        spec.nchannels));
    }
    if (spec.x != spec.full_x || spec.y != spec.full_y || spec.width != spec.full_width ||
        spec.height != spec.full_height) {
        throw file_error(path, "data window and display window differ; crop or pad the image");
    }
}

/// Reads the given channels of all texels as `T`.
template <typename T>
std::vector<T> read_texels(OIIO::ImageInput &input, const OIIO::ImageSpec &spec,
                           const std::vector<int> &used, OIIO::TypeDesc format,
                           const std::filesystem::path &path) {
    const auto texels = static_cast<size_t>(spec.width) * static_cast<size_t>(spec.height);
    const auto channels = static_cast<size_t>(spec.nchannels);
    std::vector<T> all(texels * channels);
    // Some readers report a damaged file only after they have reached its end.
    if (!input.read_image(0, 0, 0, spec.nchannels, format, all.data()) || input.has_error()) {
        throw file_error(path, "damaged image: " + in_one_line(input.geterror()));
    }
    std::vector<T> rgb(texels * 3);
    for (size_t i = 0; i < texels; ++i) {
        for (size_t c = 0; c < 3; ++c) {
            rgb[3 * i + c] = all[channels * i + static_cast<size_t>(used[c])];
        }
    }
    return rgb;
}

std::unique_ptr<OIIO::ImageInput> open_image(const std::filesystem::path &path) {
    OIIO::ImageSpec config;
    // Colours are used without alpha, so they must not be multiplied by it.
    config["oiio:UnassociatedAlpha"] = 1;
    std::unique_ptr<OIIO::ImageInput> input = OIIO::ImageInput::open(path.string(), &config);
    if (input == nullptr) {
        throw file_error(path, "cannot read as an image: " + in_one_line(OIIO::geterror()));
    }
    return input;
}

void read_image(const std::filesystem::path &path, ImageChannels channels, RawImage &image) {
    const std::unique_ptr<OIIO::ImageInput> input = open_image(path);
    const OIIO::ImageSpec spec = input->spec();
    check_header(spec, path);
    const std::vector<int> used = used_channels(spec, channels, path);
    image.width = spec.width;
    image.height = spec.height;
    image.is_floating = spec.format.is_floating_point();
    if (spec.format == OIIO::TypeDesc::UINT8) {
        image.bytes = read_texels<uint8_t>(*input, spec, used, OIIO::TypeDesc::UINT8, path);
    } else {
        image.floats = read_texels<float>(*input, spec, used, OIIO::TypeDesc::FLOAT, path);
    }
}

void write_image(const std::filesystem::path &path, const char *format, int width, int height,
                 const uint8_t *rgb) {
    const std::unique_ptr<OIIO::ImageOutput> output = OIIO::ImageOutput::create(format);
    OIIO::ImageSpec spec(width, height, 3, OIIO::TypeDesc::UINT8);
    spec["CompressionQuality"] = 95;  // used by JPEG only
    if (output == nullptr || !output->open(path.string(), spec) ||
        !output->write_image(OIIO::TypeDesc::UINT8, rgb) || !output->close()) {
        throw run_error(fmt::format("{}: cannot write image: {}", path.string(),
                                    output == nullptr ? OIIO::geterror() : output->geterror()));
    }
}

/// Calls a function of OpenImageIO. A damaged header may request more memory than is available.
template <typename Function>
auto guarded(const std::filesystem::path &path, const Function &function) {
    try {
        return function();
    } catch (const Error &) {
        throw;
    } catch (const std::exception &error) {
        throw file_error(path, std::string("cannot read image: ") + error.what());
    }
}

}  // namespace

}  // namespace rtrays

// Exported symbols of the module, of the types in image_module.h.
extern "C" bool rtrays_has_alpha_channel(const std::filesystem::path &path) {
    return rtrays::guarded(path,
                           [&] { return rtrays::open_image(path)->spec().alpha_channel >= 0; });
}

extern "C" void rtrays_read_image_file(const std::filesystem::path &path,
                                       rtrays::ImageChannels channels, rtrays::RawImage &image) {
    rtrays::guarded(path, [&] { rtrays::read_image(path, channels, image); });
}

extern "C" void rtrays_write_image_file(const std::filesystem::path &path, const char *format,
                                        int width, int height, const uint8_t *rgb) {
    rtrays::write_image(path, format, width, height, rgb);
}
