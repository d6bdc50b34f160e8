// SPDX-License-Identifier: MIT
#pragma once

#include "renderer/integrators/algorithm.h"

namespace rtrays {

/// The same rounds with stages that count their rays by depth (thesis table 4.2 gives rays after
/// one bounce), where the totals are counted.
std::vector<Pass> counting_passes(std::vector<Pass> passes);

}  // namespace rtrays
