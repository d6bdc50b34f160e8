// SPDX-License-Identifier: MIT
// Checks of options that are numbers. Those of CLI11 print a bound with all 309 digits of a double.
#pragma once

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <string>

namespace rtrays {

/// Returns the check that an option is a number for which `holds` is true, with `expected` in the
/// message of the error: "0: expected a positive number".
template <typename Predicate>
CLI::Validator number_check(const std::string &expected, Predicate holds) {
    return {[=](std::string &text) {
                double number = 0;
                return CLI::detail::lexical_cast(text, number) && holds(number)
                           ? std::string()
                           : fmt::format("{}: expected {}", text, expected);
            },
            "", "number"};
}

inline CLI::Validator positive_number() {
    return number_check("a positive number", [](double x) { return x > 0; });
}

inline CLI::Validator number_from_0() {
    return number_check("a number, 0 or more", [](double x) { return x >= 0; });
}

inline CLI::Validator number_between(double least, double greatest) {
    return number_check(fmt::format("a number from {:g} to {:g}", least, greatest),
                        [=](double x) { return x >= least && x <= greatest; });
}

}  // namespace rtrays
