// SPDX-License-Identifier: MIT
// Conversion of two-wide hierarchies to the layout that is traversed without a stack.
#pragma once

#include "renderer/bvh/bvh.h"
#include "renderer/device/kernel.h"

namespace rtrays {

/// Converts two-wide hierarchies to the stackless layout on a device (shared/stackless_node.h).
class BvhLinearizer {
  public:
    /// One work-item numbers a subtree of at most `subtree_size` triangles. The value does not
    /// change a single bit of the result.
    BvhLinearizer(DeviceContext &device, uint32_t subtree_size);

    /// Converts `bvh`, which must have the layout bvh2. The result takes over its triangles.
    Bvh linearize(Bvh bvh);

  private:
    DeviceContext *device_;
    uint32_t subtree_size_;
    Kernel link_parents_, count_subtrees_, place_subtree_nodes_, write_stackless_nodes_;
};

}  // namespace rtrays
