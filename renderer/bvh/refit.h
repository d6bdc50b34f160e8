// SPDX-License-Identifier: MIT
// Refitting a hierarchy to triangles that have moved.
#pragma once

#include <vector>

#include "renderer/bvh/bvh.h"
#include "renderer/device/kernel.h"

namespace rtrays {

/// Refits a hierarchy of any layout on a device to triangles that have moved: coordinates and
/// bounds become exact, the tree keeps its topology. Rays find the same hits as in a rebuilt tree.
/// Their speed depends on how far triangles have moved away from each other.
class BvhRefitter {
  public:
    /// Prepares refits of `bvh` by listing its nodes by level.
    BvhRefitter(DeviceContext &device, const Bvh &bvh, uint32_t group_size = 64);

    /// Refits `bvh` to changed `positions`. The numbers of vertices and triangles, and `indices`,
    /// must be those that `bvh` was built from. Triangles that can no longer be hit stay in the
    /// tree, but no ray hits them.
    ///
    /// Returns false when triangles that the build rejected can be hit now; the tree must then be
    /// rebuilt. The report counts the triangles that cannot be hit now; its cost remains that of
    /// the build. Throws `Error` (bad input) when the number of triangles differs or an index is
    /// out of range.
    bool refit(Bvh &bvh, const Buffer<float> &positions, const Buffer<uint32_t> &indices);

    uint64_t bytes() const { return order_.bytes() + faults_.bytes(); }  ///< device memory held

  private:
    DeviceContext *device_;
    Kernel count_faults_, refit_triangles_, refit_nodes_;
    Buffer<uint32_t> order_;        ///< nodes by level
    Buffer<uint32_t> faults_;       ///< numbers of triangles that cannot be hit, by TriangleFault
    std::vector<uint32_t> levels_;  ///< beginning of each level in `order_`, and end of the last
};

}  // namespace rtrays
