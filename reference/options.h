// SPDX-License-Identifier: MIT
// Command line of rtrays-reference.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "reference/settings.h"
#include "renderer/import/scene_options.h"
#include "renderer/scene/scene.h"

namespace rtrays::reference {

/// Parsed command line of `rtrays-reference`.
struct Options {
    std::string scene;
    std::string output;
    std::string state;              ///< default: OUTPUT.state
    std::string stats;              ///< empty: not written
    std::string manifest;           ///< empty: not updated
    std::string engine = "embree";  ///< "embree", "mitsuba" or "cycles"
    SceneOptions scene_options;
    std::vector<std::string> assignments;  ///< scene.ADDRESS=VALUE
    std::optional<FilmCrop> crop;          ///< window of the picture; nothing: the scene's
    bool uncropped = false;                ///< the full picture, even if the scene crops its film
    ReferenceSettings settings;            ///< width and height 0: the scene's film size
    uint64_t begin = 0;
    uint64_t end = 0;
    double checkpoint_interval = 60.0;  ///< seconds
    bool resume = false;
    bool skip_if_listed = false;
    bool quiet = false;
};

/// Parsed command line of `rtrays-reference merge`.
struct MergeOptions {
    std::vector<std::string> states;  ///< files to add
    std::string output;
    std::string state;     ///< merged state file to write; empty: not written
    std::string manifest;  ///< empty: not updated
    bool overwrite = false;
};

/// Parses the arguments that follow "merge". Returns and throws as `parse_options`.
std::optional<MergeOptions> parse_merge_options(int argc, char **argv);

/// Parses the command line; `options` are the defaults. Returns nothing after --help or --version,
/// which print to stdout. Throws `Error` (bad input) on a usage error.
std::optional<Options> parse_options(int argc, char **argv, Options options = {});

}  // namespace rtrays::reference
