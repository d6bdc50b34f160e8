// SPDX-License-Identifier: MIT
// Adds finished images of another renderer to the document of a run.
#pragma once

#include <filesystem>
#include <string>

namespace rtrays {

struct AddCurveOptions {
    std::filesystem::path run;   ///< folder of a finished run of the kind "curves", with its images
    std::filesystem::path list;  ///< CSV with the columns spp, seed, seconds, image
    std::string label;           ///< name of the curve
};

/// Measures the images of a list against the reference of a run, and writes them into its document
/// as a curve. A curve that was added with the same label is replaced. The images of a seed need
/// not share samples. Returns the path of the document. Throws `Error` (bad input) naming file,
/// line and remedy: at least 8 seeds, each at the same three or more sample counts.
std::filesystem::path add_curve(const AddCurveOptions &options);

}  // namespace rtrays
