// SPDX-License-Identifier: MIT
// Many small scenes, each rendered by the renderer and by the reference: do they agree?
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

/// Renders every scene of the profile by the reference and by each algorithm, tests the agreement
/// of all with the reference and of any two that see the same (agreement.h; the level is shared by
/// all rows), prints a line for each and writes OUT/agreement.json, OUT/agreement.md and the images
/// as arrays in OUT/images. Scenes that an earlier, stopped call finished with the same scene,
/// settings and commit are not rendered again. Returns `ExitCode::regression` when a scene does not
/// agree. Throws `Error` as the renderers and files do.
ExitCode run_agreement(const AgreeOptions &options);

}  // namespace rtrays
