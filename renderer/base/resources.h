// SPDX-License-Identifier: MIT
// Location of the files that the programs read at run time.
#pragma once

#include <filesystem>

namespace rtrays {

/// Returns the folder that contains experiments/, scenes/, scripts/ and results/references/:
/// share/rtrays of the installation that the running program belongs to, wherever that was moved,
/// or else the source folder of the build.
const std::filesystem::path &resource_folder();

}  // namespace rtrays
