// SPDX-License-Identifier: MIT
#pragma once

#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <optional>
#include <vector>

#include "renderer/bvh/bvh.h"
#include "renderer/bvh/collapse.h"
#include "renderer/bvh/hploc.h"
#include "renderer/bvh/linearize.h"
#include "renderer/device/kernel.h"

namespace rtrays {

/// How the build is spread over a device, and what it builds. Group and chunk size change no bit of
/// the result; the subtree size moves nodes in memory, but boxes, links and the order of triangles
/// stay the same.
struct BvhBuildParameters {
    uint32_t group_size;    ///< work-items per work-group
    uint32_t chunk_size;    ///< primitives per work-item while a node is split by many
    uint32_t subtree_size;  ///< a node of at most this many primitives is finished by one work-item
    BvhLayout layout = BvhLayout::bvh2;  ///< of the result
    BvhMethod method = BvhMethod::binned_sah;
    uint32_t bins = 16;  ///< on an axis, from 2 to 64; of binned_sah
    uint32_t axes = 3;   ///< that are binned: 3, or 1, the one along which centroids lie widest
    uint32_t one_group =
        1;  ///< work-items of stages that number things in order, all in one work-group: 2^n
    uint32_t parts = 1;  ///< work-items that share the bins of a node

    static BvhBuildParameters for_device(const DeviceInfo &device);
};

/// Device memory of a build at its peak, whatever the method, the layout and the triangles: at most
/// so much for each of them and so much besides, the input apart. Reached only where leaves hold
/// one triangle each, in blocks of eight; ordinary meshes take less than half on a CPU, less than
/// three quarters on a GPU.
constexpr uint64_t bvh_peak_bytes_per_triangle = 640;
constexpr uint64_t bvh_peak_bytes = 1 << 20;

/// Throws `Error` (bad input), stating the bytes, when a build over `triangle_count` triangles,
/// whose input takes `input_bytes`, exceeds what the layout can number (2^26) or what the device
/// can hold.
void require_build_memory(const DeviceInfo &device, uint64_t triangle_count, uint64_t input_bytes);

/// Vertices and triangles in device memory, as builds and refits take them.
struct BvhInput {
    BvhInput(DeviceContext &device, const std::vector<Eigen::Vector3f> &vertices,
             const std::vector<std::array<uint32_t, 3>> &triangles);

    Buffer<float> positions;   ///< 3 per vertex
    Buffer<uint32_t> indices;  ///< 3 per triangle
};

/// Builds hierarchies on a device, by one of two methods. binned_sah: breadth-first binned SAH
/// (thesis 3.1) in a large phase, level by level with all work-items on each node, and a small
/// phase with a subtree per work-item. hploc: clustering (bvh/hploc.h); a tree deeper than
/// traversal allows is made anew by binned_sah, and so is one of a single leaf. Deterministic:
/// partitions are stable, numbering follows the order of the input, nothing depends on scheduling.
///
/// Keeps its compiled kernels: one builder serves any number of builds.
class BvhBuilder {
  public:
    /// With `BvhBuildParameters::for_device`.
    explicit BvhBuilder(DeviceContext &device);

    /// Throws `Error` (bad input) when a parameter is out of range.
    BvhBuilder(DeviceContext &device, const BvhBuildParameters &parameters);

    /// `positions`: 3 floats per vertex; `indices`: 3 vertex numbers per triangle; both on the
    /// device. Zero triangles give a valid tree that nothing hits. Triangles that cannot be hit are
    /// left out and counted in the report. Throws `Error` (bad input) when an index is out of range
    /// or the build does not fit the device, before anything is allocated.
    Bvh build(const Buffer<float> &positions, const Buffer<uint32_t> &indices);

    /// The same for arrays on the host.
    Bvh build(const std::vector<Eigen::Vector3f> &positions,
              const std::vector<std::array<uint32_t, 3>> &triangles);

  private:
    struct Gathered;
    struct Workspace;

    Bvh build_bvh2(const Buffer<float> &positions, const Buffer<uint32_t> &indices);
    std::optional<Bvh> build_by_clustering(const Buffer<float> &positions,
                                           const Buffer<uint32_t> &indices);
    Bvh build_by_binning(const Buffer<float> &positions, const Buffer<uint32_t> &indices);
    BuildState gather(Gathered &gathered, uint32_t subtree_size, const Buffer<float> &positions,
                      const Buffer<uint32_t> &indices);
    void split_levels(Workspace &work);

    DeviceContext *device_;
    BvhBuildParameters parameters_;
    Kernel check_triangles_, begin_build_, gather_primitives_;
    Kernel bin_primitives_, merge_bins_, choose_splits_, partition_primitives_, merge_children_,
        emit_children_;
    Kernel build_subtrees_;
    Kernel place_subtrees_, copy_top_nodes_, copy_subtrees_;
    std::optional<HplocBuilder> hploc_;
    std::optional<BvhCollapser> collapser_;
    std::optional<BvhLinearizer> linearizer_;
};

}  // namespace rtrays
