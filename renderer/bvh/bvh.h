// SPDX-License-Identifier: MIT
// A bounding volume hierarchy in device memory, its layouts and the report of its build.
#pragma once

#include <cstdint>

#include "renderer/base/named.h"
#include "renderer/device/buffer.h"
#include "renderer/shared/bvh_layout.h"

namespace rtrays {

/// Methods of building a hierarchy.
enum class BvhMethod : uint32_t {
    /// Top down, by the surface area heuristic over bins.
    binned_sah,
    /// Bottom up, by clustering along a space-filling curve: faster to build, slower to trace.
    hploc,
};

inline constexpr Named<BvhMethod> bvh_methods[] = {{BvhMethod::binned_sah, "binned_sah"},
                                                   {BvhMethod::hploc, "hploc"}};

constexpr const char *to_string(BvhMethod method) {
    return name_in(bvh_methods, method);
}

/// Facts about one build. All of them except the seconds are deterministic.
struct BvhReport {
    /// Method that built the tree: binned_sah where clustering became too deep, or for one leaf.
    BvhMethod method = BvhMethod::binned_sah;
    double seconds_device = 0;  ///< device time of all stages of the build
    uint32_t triangles = 0;     ///< triangles in the tree
    uint32_t left_out = 0;      ///< triangles of the input that the build rejected
    uint32_t not_finite = 0;    ///< rejected: a coordinate is NaN, infinite or beyond 1e12
    /// Rejected: the vertices are on a line (the cross product of the edges is 0).
    uint32_t degenerate = 0;
    uint32_t nodes = 0;
    uint32_t leaves = 0;
    uint32_t depth = 0;  ///< edges from the root to the deepest leaf
    /// Thesis (3.3) with K_T = K_I = 1: expected number of nodes entered plus triangles tested.
    double sah_cost = 0;
    /// Nodes of the eight-wide layout, else 0. `nodes`, `leaves`, `depth` and `sah_cost` describe
    /// the two-wide tree that it was made from.
    uint32_t wide_nodes = 0;
    uint32_t wide_leaves = 0;
    uint64_t bytes = 0;       ///< size of the tree and its triangles
    uint64_t bytes_peak = 0;  ///< device memory held during the build, including the tree

    uint32_t rejected() const { return not_finite + degenerate; }
};

/// Memory layouts of a hierarchy. A program that traverses a hierarchy is compiled with
/// `BVH_LAYOUT` defined as the number of its layout.
enum class BvhLayout : uint32_t {
    bvh2 = BVH_LAYOUT_BVH2,  ///< nodes of two children, traversed with a stack
    /// Nodes of two children in depth-first order, traversed without a stack.
    bvh2_stackless = BVH_LAYOUT_STACKLESS,
    /// Nodes of eight children, for devices whose work-items compute on vectors.
    wide8 = BVH_LAYOUT_WIDE8,
};

inline constexpr Named<BvhLayout> bvh_layouts[] = {{BvhLayout::bvh2, "bvh2"},
                                                   {BvhLayout::bvh2_stackless, "bvh2_stackless"},
                                                   {BvhLayout::wide8, "wide8"}};

constexpr const char *to_string(BvhLayout layout) {
    return name_in(bvh_layouts, layout);
}

/// A hierarchy over the triangles of a scene in device memory, the input of
/// kernels/traversal/intersect_bvh.h. Only the buffers of its layout are filled.
class Bvh {
  public:
    Bvh() = default;
    Bvh(Buffer<BvhNode> nodes, Buffer<LeafTriangle> triangles, const BvhReport &report)
        : layout_(BvhLayout::bvh2),
          nodes_(std::move(nodes)),
          triangles_(std::move(triangles)),
          report_(report) {}
    Bvh(Buffer<StacklessNode> nodes, Buffer<LeafTriangle> triangles, const BvhReport &report)
        : layout_(BvhLayout::bvh2_stackless),
          stackless_nodes_(std::move(nodes)),
          triangles_(std::move(triangles)),
          report_(report) {}
    Bvh(Buffer<WideNode> nodes, Buffer<TriangleBlock> blocks, const BvhReport &report)
        : layout_(BvhLayout::wide8),
          wide_nodes_(std::move(nodes)),
          blocks_(std::move(blocks)),
          report_(report) {}

    BvhLayout layout() const { return layout_; }
    const BvhReport &report() const { return report_; }
    void set_report(const BvhReport &report) { report_ = report; }

    const Buffer<BvhNode> &nodes() const { return nodes_; }
    const Buffer<LeafTriangle> &triangles() const { return triangles_; }  ///< in leaf order
    const Buffer<StacklessNode> &stackless_nodes() const { return stackless_nodes_; }
    const Buffer<WideNode> &wide_nodes() const { return wide_nodes_; }
    const Buffer<TriangleBlock> &blocks() const { return blocks_; }

    Buffer<LeafTriangle> take_triangles() { return std::move(triangles_); }

    /// Calls visit(nodes, triangles) with the buffers of the layout.
    template <typename Visit>
    auto visit(const Visit &visit_buffers) const {
        switch (layout_) {
            case BvhLayout::bvh2_stackless:
                return visit_buffers(stackless_nodes_, triangles_);
            case BvhLayout::wide8:
                return visit_buffers(wide_nodes_, blocks_);
            default:
                return visit_buffers(nodes_, triangles_);
        }
    }

  private:
    BvhLayout layout_ = BvhLayout::bvh2;
    Buffer<BvhNode> nodes_;
    Buffer<StacklessNode> stackless_nodes_;
    Buffer<LeafTriangle> triangles_;
    Buffer<WideNode> wide_nodes_;
    Buffer<TriangleBlock> blocks_;
    BvhReport report_;
};

}  // namespace rtrays
