// SPDX-License-Identifier: MIT
// Tests on many small scenes whether the renderer agrees with the reference.
#pragma once

#include <filesystem>
#include <string>

#include "renderer/base/error.h"

namespace rtrays {

struct AgreeOptions {
    std::filesystem::path description;  ///< schema/agreement.schema.json
    std::string profile = "quick";
    std::filesystem::path out;  ///< NAME.PROFILE by default
    std::string device;
    bool quiet = false;
};

/// Renders every scene of the profile with the reference and with each algorithm. Tests the
/// agreement (agreement.h) of each algorithm with the reference, and of any two algorithms that see
/// all light; the level is divided among all rows. Prints one line for each test, and writes
/// OUT/agreement.json, OUT/agreement.md and the images as arrays in OUT/images. Scenes that an
/// interrupted call finished with equal scene, settings and commit are not rendered again. Returns
/// `ExitCode::regression` if a test fails. Throws the errors of the renderers and the files.
ExitCode run_agreement(const AgreeOptions &options);

}  // namespace rtrays
