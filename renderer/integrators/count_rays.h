// SPDX-License-Identifier: MIT
// Ray counts by depth for the rounds of any algorithm.
#pragma once

#include "renderer/integrators/pass.h"

namespace rtrays {

/// Returns the passes with stages added that count rays by depth, at the points where the totals
/// are counted (thesis table 4.2 lists rays after one bounce). The stages for the last few paths
/// are removed, because they do not count by depth.
std::vector<Pass> counting_passes(std::vector<Pass> passes);

}  // namespace rtrays
