// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <filesystem>
#include <functional>
#include <string>

namespace rtrays {

/// Reads a whole file; throws `Error` (bad input) naming the path and the reason.
std::string read_file(const std::filesystem::path &path);

/// Calls `write(temporary)` with a path beside `path`, flushes that file to disk and renames it
/// over `path`. On any error the temporary file is removed and `path` is left as it was; throws
/// what `write` throws, or `Error` (run failed) naming the path.
void write_atomically(const std::filesystem::path &path,
                      const std::function<void(const std::filesystem::path &)> &write);

/// The same for text or bytes held in memory. Throws `Error` (run failed) naming the path, also
/// when the disk is full.
void write_file(const std::filesystem::path &path, const std::string &content);

/// Throws `Error` (bad usage) unless a file could be created at `path`: called before a long run.
void require_writable(const std::filesystem::path &path);

constexpr size_t hash_digits = 32;

/// XXH3 (128 bits) of bytes, as `hash_digits` hexadecimal digits: identifies scenes, programs and
/// configurations, and is the checksum of the files we read back.
std::string content_hash(const std::string &bytes);

}  // namespace rtrays
