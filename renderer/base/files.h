// SPDX-License-Identifier: MIT
// Reading, atomic writing and hashing of files.
#pragma once

#include <cstddef>
#include <filesystem>
#include <functional>
#include <string>

namespace rtrays {

/// Returns whether `path` is a file. A path that the system refuses, such as a too long one, is
/// not.
bool is_file(const std::filesystem::path &path);

/// Reads a file. Throws `Error` (bad input) naming the path and the reason.
std::string read_file(const std::filesystem::path &path);

/// Calls `write(temporary)` with a path beside `path`, flushes that file to disk and renames it to
/// `path`. On any error the temporary file is removed and `path` remains unchanged. Throws what
/// `write` throws, or `Error` (run failed) naming the path.
void write_atomically(const std::filesystem::path &path,
                      const std::function<void(const std::filesystem::path &)> &write);

/// Writes text or bytes to a file atomically. Throws `Error` (run failed) naming the path, also
/// when the disk is full.
void write_file(const std::filesystem::path &path, const std::string &content);

/// Creates a folder and those around it, unless they exist. Throws `Error` (bad usage) naming it.
void create_folder(const std::filesystem::path &path);

/// Throws `Error` (bad usage) if no file can be created at `path`. Called before a long run.
void require_writable(const std::filesystem::path &path);

/// Returns the folder of a cache: the value of the environment variable `own`, otherwise
/// $XDG_CACHE_HOME/NAME, otherwise ~/.cache/NAME. Without HOME, it is in the folder of temporary
/// files.
std::string cache_directory(const char *own, const std::string &name);

constexpr size_t hash_digits = 32;

/// Returns the XXH3 hash (128 bits) of bytes as `hash_digits` hexadecimal digits. It identifies
/// scenes, programs and configurations, and is the checksum of files that are read back.
std::string content_hash(const std::string &bytes);

}  // namespace rtrays
