// SPDX-License-Identifier: MIT
#pragma once

#include "renderer/bvh/bvh.h"
#include "renderer/device/kernel.h"

namespace rtrays {

/// Makes two-wide hierarchies ones that are traversed without a stack, on a device
/// (shared/stackless_node.h).
class BvhLinearizer {
  public:
    /// `subtree_size`: a subtree of at most so many triangles is numbered by one work-item; changes
    /// no bit of the result.
    BvhLinearizer(DeviceContext &device, uint32_t subtree_size);

    /// `bvh` has the layout bvh2; its triangles become those of the result.
    Bvh linearize(Bvh bvh);

  private:
    DeviceContext *device_;
    uint32_t subtree_size_;
    Kernel link_parents_, count_subtrees_, place_subtree_nodes_, write_stackless_nodes_;
};

}  // namespace rtrays
