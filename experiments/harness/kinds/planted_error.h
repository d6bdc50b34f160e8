// SPDX-License-Identifier: MIT
// Deliberate errors in kernels, which the checks of an experiment must find.
#pragma once

#include <string>
#include <vector>

#include "experiments/harness/core/description.h"

namespace rtrays {

/// A deliberate error in one line of a kernel. It is applied as an overlay of the include resolver
/// and never appears in shipped code.
struct PlantedError {
    std::string name;
    RenderSettings settings;
    std::string file, search, replacement;
    bool by_slope = false;  ///< found by the convergence slope, not by the image
};

/// Reads a planted error. Throws as `parse_render_settings` does.
PlantedError read_planted_error(const Json &json);

/// Returns `text` with the only occurrence of `search` replaced. Throws `Error` (bad input) naming
/// the error if there is no occurrence or more than one, or if the replacement changes nothing: the
/// check would prove nothing.
std::string plant(const PlantedError &error, const std::string &text);

/// Plants every error in its kernel source. Throws as `plant` for the first one that cannot be
/// planted, and `Error` (run failed) if the source does not exist.
void require_plantable(const std::vector<PlantedError> &errors);

/// Returns the settings of an error, with the error planted in their sources. Throws as `plant`.
RenderSettings planted_settings(const PlantedError &error);

}  // namespace rtrays
