// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <optional>
#include <string>

#include "reference/settings.h"

namespace rtrays::reference {

/// The command line of `rtrays-reference`.
struct Options {
    std::string scene;
    std::string output;
    std::string state;              ///< OUTPUT.state unless given
    std::string stats;              ///< empty: none
    std::string manifest;           ///< empty: none
    std::string engine = "embree";  ///< or "mitsuba", "cycles"
    ReferenceSettings settings;     ///< width and height 0: the scene's film
    uint64_t begin = 0;
    uint64_t end = 0;
    double checkpoint_interval = 60.0;  ///< seconds
    bool resume = false;
    bool skip_if_listed = false;
    bool quiet = false;
};

/// Parses the command line. Returns nothing after --help or --version (printed on stdout). Throws
/// `Error` (bad input) on a usage error.
std::optional<Options> parse_options(int argc, char **argv);

}  // namespace rtrays::reference
