// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <string>
#include <string_view>

#include "renderer/base/error.h"

namespace rtrays {

/// A file compiled into the program: its path relative to the embedded folder, and its content.
struct EmbeddedFile {
    std::string_view path;
    std::string_view text;
};

/// The files of one `rtrays_embed_text` call (cmake/embed.cmake), sorted by path.
class EmbeddedFiles {
  public:
    EmbeddedFiles(const EmbeddedFile *files, size_t count) : files_(files), count_(count) {}

    const EmbeddedFile *begin() const { return files_; }
    const EmbeddedFile *end() const { return files_ + count_; }

    /// The content, or nothing (`data() == nullptr`) when there is no such file.
    std::string_view find(std::string_view path) const {
        for (const EmbeddedFile &file : *this) {
            if (file.path == path) {
                return file.text;
            }
        }
        return {};
    }

    /// The content; throws `Error` (run failed) listing the files when there is no such file.
    std::string_view text(std::string_view path) const {
        const std::string_view found = find(path);
        if (found.data() == nullptr) {
            std::string message = "no embedded file '" + std::string(path) + "'; there are:";
            for (const EmbeddedFile &file : *this) {
                message += ' ' + std::string(file.path);
            }
            throw run_error(message);
        }
        return found;
    }

  private:
    const EmbeddedFile *files_;
    size_t count_;
};

}  // namespace rtrays
