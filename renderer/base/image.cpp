// SPDX-License-Identifier: MIT
#include "renderer/base/image.h"

#include <ImfChannelList.h>
#include <ImfChromaticitiesAttribute.h>
#include <ImfDoubleAttribute.h>
#include <ImfFloatAttribute.h>
#include <ImfFrameBuffer.h>
#include <ImfHeader.h>
#include <ImfInputFile.h>
#include <ImfIntAttribute.h>
#include <ImfOutputFile.h>
#include <ImfStandardAttributes.h>
#include <ImfStringAttribute.h>
#include <ImfThreading.h>
#include <fmt/format.h>

#include <algorithm>
#include <system_error>
#include <thread>
#include <type_traits>

#include "renderer/base/error.h"
#include "renderer/base/files.h"

namespace rtrays {

namespace {

/// Largest side of an image in pixels. A header that states a larger one is considered damaged.
constexpr int max_side = 1 << 16;

/// The stored type of each alternative of `Attribute`.
template <typename T>
using ImfAttribute = Imf::TypedAttribute<T>;

Imf::Slice float_slice(float *values, const Image &image) {
    const auto width = static_cast<ptrdiff_t>(image.width());
    return {Imf::FLOAT, reinterpret_cast<char *>(values - image.left() - image.top() * width),
            sizeof(float), sizeof(float) * static_cast<size_t>(width)};
}

}  // namespace

std::vector<std::string> rgb_names(const std::string &layer) {
    const std::string prefix = layer.empty() ? "" : layer + ".";
    return {prefix + "R", prefix + "G", prefix + "B"};
}

Image Image::rgb(int width, int height) {
    Image image(width, height);
    for (const std::string &name : rgb_names()) {
        image.add_channel(name);
    }
    return image;
}

const Image::Channel *Image::find(const std::string &name) const {
    const auto it = std::find_if(channels_.begin(), channels_.end(),
                                 [&](const Channel &c) { return c.name == name; });
    return it == channels_.end() ? nullptr : &*it;
}

const std::vector<float> &Image::channel(const std::string &name) const {
    const Channel *found = find(name);
    if (found == nullptr) {
        std::string names;
        for (const Channel &c : channels_) {
            names += (names.empty() ? "" : ", ") + c.name;
        }
        throw input_error(
            fmt::format("image: unknown channel '{}'; channels are: {}", name, names));
    }
    return found->values;
}

std::vector<float> &Image::channel(const std::string &name) {
    return const_cast<std::vector<float> &>(static_cast<const Image &>(*this).channel(name));
}

std::vector<float> &Image::add_channel(const std::string &name) {
    if (has(name)) {
        throw run_error(fmt::format("image: channel '{}' already exists", name));
    }
    channels_.push_back({name, std::vector<float>(pixel_count(), 0.0f)});
    return channels_.back().values;
}

Image read_exr(const std::filesystem::path &path) {
    std::error_code unknown;  // if set, opening the file reports the reason
    if (!std::filesystem::exists(path, unknown) && !unknown) {
        throw input_error(fmt::format("{}: no such file", path.string()));
    }
    try {
        Imf::InputFile file(path.c_str());
        const Imf::Header &header = file.header();
        const Imath::Box2i window = header.dataWindow();
        const int width = window.max.x - window.min.x + 1;
        const int height = window.max.y - window.min.y + 1;
        if (width > max_side || height > max_side) {
            throw input_error(
                fmt::format("{}: {} x {} pixels are too many; the limit is {} per side",
                            path.string(), width, height, max_side));
        }
        Image image(width, height);
        image.move_to(window.min.x, window.min.y);
        // R, G, B first, then the file's (alphabetical) order.
        for (const std::string &name : rgb_names()) {
            if (header.channels().findChannel(name) != nullptr) {
                image.add_channel(name);
            }
        }
        for (auto it = header.channels().begin(); it != header.channels().end(); ++it) {
            if (!image.has(it.name())) {
                image.add_channel(it.name());
            }
        }
        Imf::FrameBuffer frame;
        for (const Image::Channel &channel : image.channels()) {
            frame.insert(channel.name, float_slice(image.channel(channel.name).data(), image));
        }
        file.setFrameBuffer(frame);
        file.readPixels(window.min.y, window.max.y);

        for (auto it = header.begin(); it != header.end(); ++it) {
            const Imf::Attribute &attribute = it.attribute();
            if (const auto *i = dynamic_cast<const ImfAttribute<int> *>(&attribute)) {
                image.attributes()[it.name()] = i->value();
            } else if (const auto *f = dynamic_cast<const ImfAttribute<float> *>(&attribute)) {
                image.attributes()[it.name()] = f->value();
            } else if (const auto *d = dynamic_cast<const ImfAttribute<double> *>(&attribute)) {
                image.attributes()[it.name()] = d->value();
            } else if (const auto *s =
                           dynamic_cast<const ImfAttribute<std::string> *>(&attribute)) {
                image.attributes()[it.name()] = s->value();
            }
        }
        return image;
    } catch (const Error &) {
        throw;
    } catch (const std::exception &error) {
        throw input_error(
            fmt::format("{}: cannot be read as an EXR image: {}", path.string(), error.what()));
    }
}

void require_exr_output(const std::filesystem::path &path) {
    require_writable(path);
    if (path.extension() != ".exr") {
        throw input_error(
            fmt::format("{}: images are written as OpenEXR; use the name {}", path.string(),
                        std::filesystem::path(path).replace_extension(".exr").string()));
    }
}

namespace {

/// Lets OpenEXR compress by all processors; by default it uses one. The bytes are the same.
void compress_in_parallel() {
    static const bool done = [] {
        Imf::setGlobalThreadCount(static_cast<int>(std::thread::hardware_concurrency()));
        return true;
    }();
    static_cast<void>(done);
}

}  // namespace

void write_exr(const Image &image, const std::filesystem::path &path) {
    try {
        write_atomically(path, [&](const std::filesystem::path &temporary) {
            const Imath::V2i corner(image.left(), image.top());
            const Imath::Box2i window(corner,
                                      corner + Imath::V2i(image.width() - 1, image.height() - 1));
            Imf::Header header(window, window);
            header.compression() = Imf::ZIP_COMPRESSION;
            Imf::addChromaticities(header, Imf::Chromaticities());  // its default is Rec. 709
            for (const auto &[name, attribute] : image.attributes()) {
                std::visit(
                    [&, key = name](const auto &value) {
                        header.insert(key, ImfAttribute<std::decay_t<decltype(value)>>(value));
                    },
                    attribute);
            }
            Imf::FrameBuffer frame;
            for (const Image::Channel &channel : image.channels()) {
                header.channels().insert(channel.name, Imf::Channel(Imf::FLOAT));
                // OpenEXR's frame buffers are not const-correct; writing only reads.
                frame.insert(channel.name,
                             float_slice(const_cast<float *>(channel.values.data()), image));
            }
            compress_in_parallel();
            Imf::OutputFile file(temporary.c_str(), header);
            file.setFrameBuffer(frame);
            file.writePixels(image.height());
        });
    } catch (const Error &) {
        throw;
    } catch (const std::exception &error) {
        throw run_error(fmt::format("{}: cannot be written: {}", path.string(), error.what()));
    }
}

}  // namespace rtrays
