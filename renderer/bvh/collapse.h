// SPDX-License-Identifier: MIT
#pragma once

#include "renderer/bvh/bvh.h"
#include "renderer/bvh/prefix_sums.h"
#include "renderer/device/kernel.h"

namespace rtrays {

/// Turns two-wide hierarchies into eight-wide ones on a device (shared/wide_node.h). Deterministic
/// as the builder is.
class BvhCollapser {
  public:
    BvhCollapser(DeviceContext &device, uint32_t group_size);

    /// `bvh` has the layout bvh2; what it holds may be released afterwards. Throws `Error` (run
    /// failed) when the device's memory does not suffice: per triangle about 100 bytes while it
    /// works, and about 70 for the result.
    Bvh collapse(const Bvh &bvh);

  private:
    DeviceContext *device_;
    PrefixSums sums_;
    Kernel begin_collapse_, open_wide_nodes_, link_wide_nodes_, fill_blocks_, copy_wide_nodes_;
};

}  // namespace rtrays
