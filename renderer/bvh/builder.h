// SPDX-License-Identifier: MIT
// The BVH builder: its parameters, its memory limits and the stages that it schedules.
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

/// Method and layout of a build, and how the build is divided among work-items. Group size and
/// chunk size do not change a single bit of the result. The subtree size changes the order of nodes
/// in memory, but not the boxes, the links or the order of triangles.
struct BvhBuildParameters {
    uint32_t group_size;    ///< work-items per work-group
    uint32_t chunk_size;    ///< primitives per work-item while many work-items split one node
    uint32_t subtree_size;  ///< one work-item finishes a node of at most this many primitives
    BvhLayout layout = BvhLayout::bvh2;  ///< layout of the result
    BvhMethod method = BvhMethod::binned_sah;
    uint32_t bins = 16;  ///< bins per axis for binned_sah, from 2 to 64
    uint32_t axes = 3;   ///< number of binned axes: 3, or 1 for the axis of largest centroid extent
    /// Work-items of the stages that number elements in order. All of them are in one work-group;
    /// a power of two.
    uint32_t one_group = 1;
    uint32_t parts = 1;  ///< work-items that share the bins of a node

    /// Returns the parameters that suit the type of device, CPU or GPU.
    static BvhBuildParameters for_device(const DeviceInfo &device);
};

/// Upper bounds of the device memory at the peak of a build, without the input: this many bytes per
/// triangle, plus `bvh_peak_bytes`. They are valid for every method, layout and set of triangles.
/// A build reaches them only if each leaf holds one triangle, in blocks of eight. Ordinary meshes
/// take less than half of that on a CPU and less than three quarters on a GPU.
constexpr uint64_t bvh_peak_bytes_per_triangle = 640;
constexpr uint64_t bvh_peak_bytes = 1 << 20;

/// Throws `Error` (bad input) when a build over `triangle_count` triangles, whose input takes
/// `input_bytes`, is too large. The limits are the 2^26 triangles that the layout can index and the
/// memory of the device. The message states the bytes.
void require_build_memory(const DeviceInfo &device, uint64_t triangle_count, uint64_t input_bytes);

/// Vertices and triangles in device memory, the input of builds and refits.
struct BvhInput {
    BvhInput(DeviceContext &device, const std::vector<Eigen::Vector3f> &vertices,
             const std::vector<std::array<uint32_t, 3>> &triangles);

    Buffer<float> positions;   ///< 3 per vertex
    Buffer<uint32_t> indices;  ///< 3 per triangle
};

/// Builds hierarchies on a device by one of two methods.
///
/// binned_sah: breadth-first binned SAH (thesis 3.1). The large phase splits nodes level by level,
/// with all work-items on each node. The small phase gives each work-item a subtree.
///
/// hploc: clustering (bvh/hploc.h). If the tree becomes deeper than traversal allows, or has a
/// single leaf, it is rebuilt by binned_sah.
///
/// Builds are deterministic: partitions are stable, numbering follows the order of the input, and
/// nothing depends on scheduling. A builder keeps its compiled kernels for any number of builds.
class BvhBuilder {
  public:
    /// Uses `BvhBuildParameters::for_device`.
    explicit BvhBuilder(DeviceContext &device);

    /// Throws `Error` (bad input) when a parameter is out of range.
    BvhBuilder(DeviceContext &device, const BvhBuildParameters &parameters);

    /// Builds from buffers on the device. `positions` holds 3 floats per vertex, `indices` 3 vertex
    /// indices per triangle. Zero triangles give a valid tree that no ray hits. Triangles that
    /// cannot be hit are omitted and counted in the report. Throws `Error` (bad input) when an
    /// index is out of range, or, before anything is allocated, when the build does not fit the
    /// device.
    Bvh build(const Buffer<float> &positions, const Buffer<uint32_t> &indices);

    /// Copies arrays from the host to the device and builds from them.
    Bvh build(const std::vector<Eigen::Vector3f> &positions,
              const std::vector<std::array<uint32_t, 3>> &triangles);

  private:
    struct Gathered;
    struct Workspace;
    /// Kernels of the large phase.
    struct LevelKernels {
        LevelKernels(DeviceContext &device, const BvhBuildParameters &parameters);

        Kernel bin_primitives, merge_bins, choose_splits, partition_primitives, merge_children,
            emit_children;
    };

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
    std::optional<LevelKernels> levels_;  ///< compiled by the first build that has a large phase
    Kernel build_subtrees_;
    Kernel place_subtrees_, copy_top_nodes_, copy_subtrees_;
    std::optional<HplocBuilder> hploc_;
    std::optional<BvhCollapser> collapser_;
    std::optional<BvhLinearizer> linearizer_;
};

}  // namespace rtrays
