// SPDX-License-Identifier: MIT
#include "renderer/device/pocl_cache.h"

#include <fmt/format.h>
#include <unistd.h>

#include <array>
#include <csignal>
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
    // Never destroyed, because a driver may crash while the program exits.
    static CrashReport &report = *new CrashReport;
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
    return cache_directory("POCL_CACHE_DIR", "pocl/kcache");
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
