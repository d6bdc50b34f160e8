// SPDX-License-Identifier: MIT
#include "renderer/base/files.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <unistd.h>

#include <cerrno>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <fstream>
#include <iterator>
#include <system_error>

#include "renderer/base/error.h"

#define XXH_INLINE_ALL
#include <xxhash.h>

namespace rtrays {

namespace fs = std::filesystem;

namespace {

/// Closes a descriptor on scope exit.
struct Descriptor {
    int fd;
    ~Descriptor() {
        if (fd >= 0) {
            close(fd);
        }
    }
};

fs::path temporary_beside(const fs::path &path) {
    return fs::path(path).concat(fmt::format(".{}.tmp", getpid()));
}

std::string reason() {
    return std::strerror(errno);
}

/// Returns false for paths that cannot be inspected; opening them then reports the reason.
bool names_directory(const fs::path &path) {
    std::error_code ignored;
    return fs::is_directory(path, ignored);
}

}  // namespace

bool is_file(const fs::path &path) {
    std::error_code ignored;
    return fs::is_regular_file(path, ignored);
}

std::string read_file(const fs::path &path) {
    if (names_directory(path)) {
        throw input_error(fmt::format("{}: is a directory, not a file", path.string()));
    }
    std::ifstream stream(path, std::ios::binary);
    if (!stream) {
        throw input_error(fmt::format("{}: cannot be read: {}", path.string(), reason()));
    }
    std::string content{std::istreambuf_iterator<char>(stream), {}};
    if (stream.bad()) {
        throw input_error(fmt::format("{}: read error: {}", path.string(), reason()));
    }
    return content;
}

void write_atomically(const fs::path &path, const std::function<void(const fs::path &)> &write) {
    const fs::path temporary = temporary_beside(path);
    try {
        write(temporary);
        const Descriptor file{open(temporary.c_str(), O_RDONLY | O_CLOEXEC)};
        if (file.fd < 0 || fsync(file.fd) != 0) {
            throw run_error(fmt::format("{}: cannot be written: {}", path.string(), reason()));
        }
        std::error_code error;
        fs::rename(temporary, path, error);
        if (error) {
            throw run_error(
                fmt::format("{}: cannot be written: {}", path.string(), error.message()));
        }
    } catch (...) {
        std::error_code ignored;
        fs::remove(temporary, ignored);
        throw;
    }
}

void write_file(const fs::path &path, const std::string &content) {
    write_atomically(path, [&](const fs::path &temporary) {
        const Descriptor file{
            open(temporary.c_str(), O_WRONLY | O_CREAT | O_TRUNC | O_CLOEXEC, 0666)};
        size_t written = 0;
        while (file.fd >= 0 && written < content.size()) {
            const ssize_t n = ::write(file.fd, content.data() + written, content.size() - written);
            if (n < 0 && errno != EINTR) {
                break;
            }
            written += n > 0 ? static_cast<size_t>(n) : 0;
        }
        if (file.fd < 0 || written < content.size()) {
            throw run_error(fmt::format("{}: cannot be written: {}", path.string(), reason()));
        }
    });
}

void create_folder(const std::filesystem::path &path) {
    std::error_code error;
    std::filesystem::create_directories(path, error);
    if (error) {
        throw input_error(fmt::format("{}: cannot be created: {}", path.string(), error.message()));
    }
}

void require_writable(const fs::path &path) {
    if (names_directory(path)) {
        throw input_error(fmt::format("{}: is a directory; name an output file", path.string()));
    }
    const fs::path temporary = temporary_beside(path);
    const Descriptor file{open(temporary.c_str(), O_WRONLY | O_CREAT | O_CLOEXEC, 0666)};
    if (file.fd < 0) {
        throw input_error(fmt::format("{}: cannot be written: {}", path.string(), reason()));
    }
    std::error_code ignored;
    fs::remove(temporary, ignored);
}

std::string cache_directory(const char *own, const std::string &name) {
    const auto variable = [](const char *of) {
        const char *value = std::getenv(of);
        return std::string(value == nullptr ? "" : value);
    };
    if (const std::string value = variable(own); !value.empty()) {
        return value;
    }
    if (const std::string xdg = variable("XDG_CACHE_HOME"); !xdg.empty()) {
        return xdg + "/" + name;
    }
    if (const std::string home = variable("HOME"); !home.empty()) {
        return home + "/.cache/" + name;
    }
    std::error_code error;
    const std::filesystem::path temporary = std::filesystem::temp_directory_path(error);
    return (error ? "/tmp" : temporary.string()) + "/" + name;
}

std::string content_hash(const std::string &bytes) {
    const XXH128_hash_t hash = XXH3_128bits(bytes.data(), bytes.size());
    return fmt::format("{:016x}{:016x}", hash.high64, hash.low64);
}

}  // namespace rtrays
