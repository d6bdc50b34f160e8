// SPDX-License-Identifier: MIT
#include "experiments/harness/core/array_file.h"

#include <fmt/format.h>

#include <array>
#include <string>

#include "renderer/base/files.h"

namespace rtrays {

void write_array(const Image &image, const std::filesystem::path &path, const std::string &layer) {
    std::string header =
        fmt::format("{{'descr': '<f4', 'fortran_order': False, 'shape': ({}, {}, 3), }}",
                    image.height(), image.width());
    // Magic (6), version (2), length (2) and header end at a multiple of 64 bytes. The last byte is
    // a newline.
    header.append(63 - (10 + header.size()) % 64, ' ');
    header += '\n';

    std::string bytes("\x93NUMPY\x01\x00", 8);
    bytes += static_cast<char>(header.size() & 0xff);
    bytes += static_cast<char>(header.size() >> 8);
    bytes += header;
    const auto names = rgb_names(layer);
    const std::array<const std::vector<float> *, 3> channels{
        &image.channel(names[0]), &image.channel(names[1]), &image.channel(names[2])};
    for (size_t i = 0; i < image.pixel_count(); ++i) {
        for (const auto *channel : channels) {
            bytes.append(reinterpret_cast<const char *>(&(*channel)[i]), sizeof(float));
        }
    }
    write_file(path, bytes);
}

}  // namespace rtrays
