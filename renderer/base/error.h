// SPDX-License-Identifier: MIT
// Errors and exit codes of all programs.
#pragma once

#include <functional>
#include <stdexcept>
#include <string>

namespace rtrays {

/// Exit codes of all programs, which scripts rely on.
enum class ExitCode {
    ok = 0,
    run_failed = 1,
    bad_input = 2,
    regression = 3,
    reference_missing = 4,
    skipped = 77,       ///< a peer is not installed
    interrupted = 130,  ///< what a shell reports for SIGINT
};

/// The only error type of all libraries. The message is complete: it names the file, key or device
/// and the remedy. Only `main` converts an error to an exit code.
class Error : public std::runtime_error {
  public:
    Error(ExitCode exit_code, const std::string &message)
        : std::runtime_error(message), exit_code_(exit_code) {}

    ExitCode exit_code() const { return exit_code_; }

  private:
    ExitCode exit_code_;
};

/// Makes the error of bad usage or bad input: exit code 2.
inline Error input_error(const std::string &message) {
    return {ExitCode::bad_input, message};
}

/// Makes the error of a run that could not be completed: exit code 1.
inline Error run_error(const std::string &message) {
    return {ExitCode::run_failed, message};
}

/// Runs `body` and returns the exit code for `main`. Prints the message of an `Error`, or of any
/// other exception, as `PROGRAM: message` on stderr.
int run_main(const char *program, const std::function<ExitCode()> &body);

}  // namespace rtrays
