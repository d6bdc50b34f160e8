// SPDX-License-Identifier: MIT
// Expectations on the exit code and the message of errors.
#pragma once

#include <gtest/gtest.h>

#include <string>

#include "renderer/base/error.h"

namespace rtrays {

/// Returns the message of the `Error` that `body` throws. Fails the test if it throws none or one
/// with another exit code.
template <typename Body>
std::string error_of(ExitCode code, const Body &body) {
    try {
        body();
    } catch (const Error &error) {
        EXPECT_EQ(error.exit_code(), code) << error.what();
        return error.what();
    }
    ADD_FAILURE() << "no error";
    return {};
}

/// Expects that `body` throws an `Error` with that exit code and with `fragment` in its message.
template <typename Body>
void expect_error(ExitCode code, const std::string &fragment, const Body &body) {
    const std::string message = error_of(code, body);
    EXPECT_NE(message.find(fragment), std::string::npos)
        << "message:  " << message << "\nexpected: " << fragment;
}

template <typename Body>
void expect_input_error(const std::string &fragment, const Body &body) {
    expect_error(ExitCode::bad_input, fragment, body);
}

template <typename Body>
void expect_run_error(const std::string &fragment, const Body &body) {
    expect_error(ExitCode::run_failed, fragment, body);
}

}  // namespace rtrays
