// SPDX-License-Identifier: MIT
// Text files that are compiled into a program, such as kernels and schemas.
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

    /// Returns the content of a file, or an empty view (`data() == nullptr`) if it does not exist.
    std::string_view find(std::string_view path) const {
        for (const EmbeddedFile &file : *this) {
            if (file.path == path) {
                return file.text;
            }
        }
        return {};
    }

    /// Returns the content of a file. Throws `Error` (run failed) listing the files if it does not
    /// exist.
    std::string_view text(std::string_view path) const {
        const std::string_view found = find(path);
        if (found.data() == nullptr) {
            std::string message = "unknown embedded file '" + std::string(path) + "'; files are:";
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
