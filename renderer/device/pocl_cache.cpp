// SPDX-License-Identifier: MIT
#include "renderer/device/pocl_cache.h"

#include <fmt/format.h>
#include <unistd.h>

#include <array>
#include <csignal>
#include <cstdlib>
#include <filesystem>
#include <system_error>

#include "renderer/base/error.h"
#include "renderer/base/files.h"

namespace rtrays {

namespace {

namespace fs = std::filesystem;

constexpr std::array<int, 4> crash_signals = {SIGABRT, SIGBUS, SIGILL, SIGSEGV};

/// What the signal handler needs. A handler must not allocate memory.
struct CrashReport {
    std::string message;
    std::array<struct sigaction, crash_signals.size()> former{};
};

CrashReport &crash_report() {
    static CrashReport report;
    return report;
}

/// Prints the message, and leaves the signal to the handler that was there before.
extern "C" void report_crash(int signal) {
    const CrashReport &report = crash_report();
    const ssize_t ignored = write(STDERR_FILENO, report.message.data(), report.message.size());
    static_cast<void>(ignored);
    for (size_t i = 0; i < crash_signals.size(); ++i) {
        if (crash_signals[i] == signal) {
            sigaction(signal, &report.former[i], nullptr);
        }
    }
    raise(signal);
}

}  // namespace

std::string pocl_cache_directory() {
    const auto variable = [](const char *name) {
        const char *value = std::getenv(name);
        return std::string(value == nullptr ? "" : value);
    };
    if (const std::string own = variable("POCL_CACHE_DIR"); !own.empty()) {
        return own;
    }
    if (const std::string xdg = variable("XDG_CACHE_HOME"); !xdg.empty()) {
        return xdg + "/pocl/kcache";
    }
    const std::string home = variable("HOME");
    return (home.empty() ? fs::temp_directory_path().string() : home + "/.cache") + "/pocl/kcache";
}

std::string pocl_cache_fault() {
    const fs::path folder = pocl_cache_directory();
    std::error_code error;
    fs::create_directories(folder, error);
    if (error) {
        return fmt::format("{}: cannot be created: {}", folder.string(), error.message());
    }
    try {
        require_writable(folder / "rtrays");
    } catch (const Error &fault) {
        return fault.what();
    }
    return {};
}

void explain_pocl_crashes() {
    CrashReport &report = crash_report();
    if (!report.message.empty()) {
        return;
    }
    report.message = fmt::format(
        "rtrays: the OpenCL driver has crashed; if this happens again, a file of PoCL's cache may "
        "be damaged: delete the folder {}\n",
        pocl_cache_directory());
    struct sigaction action {};
    action.sa_handler = report_crash;
    for (size_t i = 0; i < crash_signals.size(); ++i) {
        sigaction(crash_signals[i], &action, &report.former[i]);
    }
}

}  // namespace rtrays
