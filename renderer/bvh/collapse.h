// SPDX-License-Identifier: MIT
// Collapsing two-wide hierarchies to eight-wide ones.
#pragma once

#include "renderer/bvh/bvh.h"
#include "renderer/bvh/prefix_sums.h"
#include "renderer/device/kernel.h"

namespace rtrays {

/// Collapses two-wide hierarchies to eight-wide ones on a device (shared/wide_node.h). The result
/// is deterministic, like that of the builder.
class BvhCollapser {
  public:
    BvhCollapser(DeviceContext &device, uint32_t group_size);

    /// Returns the eight-wide hierarchy of `bvh`, which must have the layout bvh2. The buffers of
    /// `bvh` may be released afterwards. Throws `Error` (run failed) when the device runs out of
    /// memory: collapsing takes about 100 bytes per triangle, the result about 70.
    Bvh collapse(const Bvh &bvh);

  private:
    DeviceContext *device_;
    PrefixSums sums_;
    Kernel begin_collapse_, open_wide_nodes_, link_wide_nodes_, fill_blocks_, copy_wide_nodes_;
};

}  // namespace rtrays
