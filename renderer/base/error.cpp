// SPDX-License-Identifier: MIT
#include "renderer/base/error.h"

#include <cerrno>
#include <cstdio>
#include <cstring>
#include <exception>
#include <new>

namespace rtrays {

namespace {

/// Writes what is left of standard output. Throws `Error` (run failed) if any of it was lost, for
/// instance because the disk is full.
void flush_output() {
    errno = 0;
    if (std::fflush(stdout) != 0 || std::ferror(stdout) != 0) {
        throw run_error(std::string("standard output: cannot be written: ") +
                        (errno != 0 ? std::strerror(errno) : "write error"));
    }
}

}  // namespace

int run_main(const char *program, const std::function<ExitCode()> &body) {
    try {
        const ExitCode code = body();
        flush_output();
        return static_cast<int>(code);
    } catch (const Error &error) {
        std::fprintf(stderr, "%s: %s\n", program, error.what());
        return static_cast<int>(error.exit_code());
    } catch (const std::bad_alloc &) {
        std::fprintf(stderr, "%s: out of host memory\n", program);
    } catch (const std::exception &error) {
        std::fprintf(stderr, "%s: %s\n", program, error.what());
    }
    return static_cast<int>(ExitCode::run_failed);
}

}  // namespace rtrays
