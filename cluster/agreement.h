// SPDX-License-Identifier: MIT
// What ranks find out about each other before they render.
#pragma once

#include <functional>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "cluster/world.h"
#include "renderer/base/error.h"

namespace rtrays::cluster {

/// Result of the preparation of a rank.
struct Preparation {
    std::optional<ExitCode> ended;  ///< the program ends, after --help for instance
    std::string error;              ///< the reason, if an error ends it
    /// Names and values that must be equal on all ranks, the most important first.
    std::vector<std::pair<std::string, std::string>> identity;
};

/// Calls `prepare` on the first rank of each node, then on the others, which find its kernels in
/// the cache. Turns an `Error` into a preparation.
Preparation prepare_in_turn(const World &world, const std::function<Preparation()> &prepare);

/// Compares the preparations of all ranks. Returns the exit code if the program ends: because all
/// ranks end, because of errors, or because ranks differ. Rank 0 prints the reason, which names the
/// ranks and what differs. All ranks call it.
std::optional<ExitCode> agree(const World &world, const Preparation &preparation);

}  // namespace rtrays::cluster
