// SPDX-License-Identifier: MIT
#pragma once

#include <functional>
#include <stdexcept>
#include <string>

namespace rtrays {

/// Exit codes of every program (a contract with scripts).
enum class ExitCode {
    ok = 0,
    run_failed = 1,
    bad_input = 2,
    regression = 3,
    reference_missing = 4,
    skipped = 77,       ///< a peer is not installed
    interrupted = 130,  ///< as a shell reports SIGINT
};

/// The one error type of all libraries. Its message is complete: it names the file, key or device
/// concerned and the remedy. Only `main` turns it into an exit code.
class Error : public std::runtime_error {
  public:
    Error(ExitCode exit_code, const std::string &message)
        : std::runtime_error(message), exit_code_(exit_code) {}

    ExitCode exit_code() const { return exit_code_; }

  private:
    ExitCode exit_code_;
};

/// Bad usage or bad input: exit code 2.
inline Error input_error(const std::string &message) {
    return {ExitCode::bad_input, message};
}

/// A run that could not be carried through: exit code 1.
inline Error run_error(const std::string &message) {
    return {ExitCode::run_failed, message};
}

/// Runs `body`, prints the message of an `Error` (or of any other exception) as `PROGRAM: message`
/// on stderr and returns the exit code for `main`.
int run_main(const char *program, const std::function<ExitCode()> &body);

}  // namespace rtrays
