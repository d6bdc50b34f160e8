// SPDX-License-Identifier: MIT
#pragma once

#include <filesystem>
#include <vector>

namespace rtrays {

/// Makes tables, plots and the report of finished runs: writes the arrays that the plots need
/// beside the runs' images, then runs scripts/report. Returns its exit code; the path of the report
/// is its standard output. Throws `Error` (bad input) for a folder without run.json, `Error` (run
/// failed) naming the packages when Python cannot be started.
int make_report(const std::vector<std::filesystem::path> &runs);

}  // namespace rtrays
