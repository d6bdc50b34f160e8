// SPDX-License-Identifier: MIT
#pragma once

#include "renderer/bvh/bvh.h"
#include "renderer/device/kernel.h"

namespace rtrays {

/// Brings the nodes of two-wide hierarchies into depth-first order on a device (shared/stackless_node.h).
class BvhLinearizer {
  public:
    BvhLinearizer(DeviceContext &device, uint32_t group_size);

    /// `bvh` has the layout bvh2; its triangles become those of the result.
    Bvh linearize(Bvh bvh);

  private:
    DeviceContext *device_;
    Kernel count_subtrees_, write_stackless_nodes_, link_stackless_nodes_;
};

}  // namespace rtrays
