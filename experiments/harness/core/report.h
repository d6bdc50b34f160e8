// SPDX-License-Identifier: MIT
// Makes the report of finished runs.
#pragma once

#include <filesystem>
#include <vector>

namespace rtrays {

/// Makes tables, plots and the report of finished runs of any kind. Writes the arrays that the
/// plots read beside the images, then runs `scripts/results report`, which prints the path of the
/// report. Returns the exit code of that command. Throws `Error` (bad input) for a folder without
/// run.json, and `Error` (run failed) naming the remedy if Python cannot be started.
int make_report(const std::vector<std::filesystem::path> &runs);

}  // namespace rtrays
