// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>

#include "renderer/device/buffer.h"
#include "renderer/shared/bvh_node.h"
#include "renderer/shared/triangle.h"

namespace rtrays {

/// Facts of one build, all but the seconds deterministic.
struct BvhReport {
    double seconds_device = 0;  ///< device time of all stages of the build
    uint32_t triangles = 0;     ///< in the tree
    uint32_t not_finite = 0;    ///< rejected: a coordinate is NaN, infinite or beyond 1e12
    uint32_t degenerate = 0;    ///< rejected: the vertices lie on a line (cross product of the edges is 0)
    uint32_t nodes = 0;
    uint32_t leaves = 0;
    uint32_t depth = 0;       ///< edges from the root to the deepest leaf
    double sah_cost = 0;      ///< thesis (3.3) with K_T = K_I = 1: expected nodes entered + triangles tested
    uint64_t bytes = 0;       ///< of the tree and its triangles
    uint64_t bytes_peak = 0;  ///< of device memory held during the build, the tree included

    uint32_t rejected() const { return not_finite + degenerate; }
};

/// A hierarchy over the triangles of a scene, in device memory: what kernels/traversal/intersect_bvh.h reads.
class Bvh {
  public:
    Bvh() = default;
    Bvh(Buffer<BvhNode> nodes, Buffer<LeafTriangle> triangles, const BvhReport &report)
        : nodes_(std::move(nodes)), triangles_(std::move(triangles)), report_(report) {}

    const Buffer<BvhNode> &nodes() const { return nodes_; }
    const Buffer<LeafTriangle> &triangles() const { return triangles_; }  ///< in leaf order
    const BvhReport &report() const { return report_; }

  private:
    Buffer<BvhNode> nodes_;
    Buffer<LeafTriangle> triangles_;
    BvhReport report_;
};

}  // namespace rtrays
