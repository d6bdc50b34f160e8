// SPDX-License-Identifier: MIT
#include "renderer/base/error.h"

#include <cstdio>
#include <exception>
#include <new>

namespace rtrays {

int run_main(const char *program, const std::function<ExitCode()> &body) {
    try {
        return static_cast<int>(body());
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
