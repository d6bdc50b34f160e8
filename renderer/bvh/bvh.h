// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>

#include "renderer/device/buffer.h"
#include "renderer/shared/bvh_layout.h"

namespace rtrays {

/// How a hierarchy is built.
enum class BvhMethod : uint32_t {
    binned_sah,  ///< top down, by the surface area heuristic over bins
    hploc,  ///< bottom up, by clustering along a space-filling curve: faster to build, slower to
            ///< trace
};

/// All methods by the names that settings give them.
struct NamedBvhMethod {
    BvhMethod method;
    const char *name;
};
inline constexpr NamedBvhMethod bvh_methods[] = {{BvhMethod::binned_sah, "binned_sah"},
                                                 {BvhMethod::hploc, "hploc"}};

const char *to_string(BvhMethod method);

/// Facts of one build, all but the seconds deterministic.
struct BvhReport {
    BvhMethod method = BvhMethod::binned_sah;  ///< that made it: binned_sah where clustering became
                                               ///< too deep, or for one leaf
    double seconds_device = 0;                 ///< device time of all stages of the build
    uint32_t triangles = 0;                    ///< in the tree
    uint32_t left_out = 0;    ///< of the input, not in the tree: rejected when it was built
    uint32_t not_finite = 0;  ///< rejected: a coordinate is NaN, infinite or beyond 1e12
    uint32_t degenerate =
        0;  ///< rejected: the vertices lie on a line (cross product of the edges is 0)
    uint32_t nodes = 0;
    uint32_t leaves = 0;
    uint32_t depth = 0;  ///< edges from the root to the deepest leaf
    double sah_cost =
        0;  ///< thesis (3.3) with K_T = K_I = 1: expected nodes entered + triangles tested
    uint32_t wide_nodes =
        0;  ///< of the eight-wide layout, else 0: the rest is of the two-wide tree below it
    uint32_t wide_leaves = 0;
    uint64_t bytes = 0;       ///< of the tree and its triangles
    uint64_t bytes_peak = 0;  ///< of device memory held during the build, the tree included

    uint32_t rejected() const { return not_finite + degenerate; }
};

/// How a hierarchy lies in memory; a program that traverses it is compiled with `BVH_LAYOUT`
/// defined as its number.
enum class BvhLayout : uint32_t {
    bvh2 = BVH_LAYOUT_BVH2,  ///< nodes of two children, traversed with a stack
    bvh2_stackless =
        BVH_LAYOUT_STACKLESS,  ///< the same in depth-first order, traversed without one
    wide8 = BVH_LAYOUT_WIDE8,  ///< nodes of eight, for devices whose work-items compute on vectors
};

/// All layouts by the names that settings give them.
struct NamedBvhLayout {
    BvhLayout layout;
    const char *name;
};
inline constexpr NamedBvhLayout bvh_layouts[] = {{BvhLayout::bvh2, "bvh2"},
                                                 {BvhLayout::bvh2_stackless, "bvh2_stackless"},
                                                 {BvhLayout::wide8, "wide8"}};

const char *to_string(BvhLayout layout);

/// A hierarchy over the triangles of a scene, in device memory: what
/// kernels/traversal/intersect_bvh.h reads. It has the buffers of its layout.
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
