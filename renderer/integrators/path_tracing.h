// SPDX-License-Identifier: MIT
#pragma once

#include <string>
#include <vector>

#include "renderer/shared/features.h"

namespace rtrays {

/// The stages of one round of path tracing (thesis 2.7, 3.3.1), in order: every active path advances by one vertex.
/// Stages that the features do not call for are absent.
std::vector<std::string> path_tracing_round(FeatureMask features);

}  // namespace rtrays
