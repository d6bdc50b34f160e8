// SPDX-License-Identifier: MIT
// The H-PLOC builder: bottom-up construction of hierarchies by clustering.
#pragma once

#include <optional>

#include "renderer/bvh/bvh.h"
#include "renderer/bvh/radix_sort.h"
#include "renderer/device/kernel.h"
#include "renderer/kernels/bvh/hploc.h"

namespace rtrays {

/// The primitives of a build on a device, checked and gathered in the order of the input.
struct GatheredPrimitives {
    Buffer<BuildState> state;
    Buffer<PrimitiveRef> primitives;  ///< only the first `count` are valid
    Buffer<BuildSubtree> all;         ///< one range that covers all primitives, with its bounds
    uint32_t count;
};

/// Builds two-wide hierarchies on a device by clustering (H-PLOC, kernels/bvh/hploc.h).
/// Deterministic: the tree depends on the primitives alone.
class HplocBuilder {
  public:
    /// One work-item finishes a range of at most `subtree_size` primitives. The value does not
    /// change a single bit of the result.
    HplocBuilder(DeviceContext &device, uint32_t group_size, uint32_t subtree_size);

    /// Returns `std::nullopt` if the tree would be deeper than traversal allows (bvh_node.h).
    /// `gathered` must have more than BVH_LEAF_SIZE primitives. The report of the result has only
    /// the properties of the tree and the peak of memory, without positions and indices.
    std::optional<Bvh> build(GatheredPrimitives gathered, const Buffer<float> &positions,
                             const Buffer<uint32_t> &indices);

  private:
    struct Workspace;

    void cluster(Workspace &work, uint32_t count);

    DeviceContext *device_;
    uint32_t subtree_size_;
    RadixSort sort_;
    Kernel encode_centroids_, gather_clusters_;
    Kernel begin_ranges_, divide_ranges_, cluster_subtrees_, cluster_ranges_, cluster_root_;
    Kernel place_clusters_, fill_triangles_, sum_costs_, sum_cost_;
};

}  // namespace rtrays
