// SPDX-License-Identifier: MIT
#pragma once

#include <vector>

#include "renderer/bvh/bvh.h"
#include "renderer/device/kernel.h"

namespace rtrays {

/// Fits a hierarchy to triangles that have moved, on a device: new coordinates and exact bounds,
/// the tree stays as it is. Any layout. Rays find what they find in a tree built anew; how fast
/// depends on how far triangles have moved apart.
class BvhRefitter {
  public:
    /// Lists the nodes of `bvh` by level.
    BvhRefitter(DeviceContext &device, const Bvh &bvh, uint32_t group_size = 64);

    /// `positions`, `indices`: as `bvh` was built from, the positions changed. Triangles of the
    /// tree that cannot be hit any more stay in it, unhit. False when triangles that were left out
    /// of the tree can be hit now: build it anew. The report says what cannot be hit now; its cost
    /// is that of the build. Throws `Error` (bad input) when there are other numbers of triangles
    /// or vertices than the tree has.
    bool refit(Bvh &bvh, const Buffer<float> &positions, const Buffer<uint32_t> &indices);

    uint64_t bytes() const { return order_.bytes() + faults_.bytes(); }  ///< of device memory held

  private:
    DeviceContext *device_;
    Kernel count_faults_, refit_triangles_, refit_nodes_;
    Buffer<uint32_t> order_;        ///< nodes by level
    Buffer<uint32_t> faults_;       ///< triangles that cannot be hit, by TriangleFault
    std::vector<uint32_t> levels_;  ///< where each begins, and where the last ends
};

}  // namespace rtrays
