// SPDX-License-Identifier: MIT
#include "renderer/bvh/refit.h"

#include <fmt/format.h>

#include <algorithm>

#include "renderer/base/error.h"
#include "renderer/bvh/radix_sort.h"
#include "renderer/kernels/bvh/input_triangle.h"

namespace rtrays {

namespace {

/// An upper bound of the levels of any tree (bvh_node.h), including node 0 of the eight-wide layout
/// and the end of the last level.
constexpr uint32_t level_limit = BVH_STACK_SIZE + 2;

constexpr uint32_t fault_kinds = TRIANGLE_BAD_INDEX + 1;

}  // namespace

BvhRefitter::BvhRefitter(DeviceContext &device, const Bvh &bvh, uint32_t group_size)
    : device_(&device), faults_(device, "bvh faults", fault_kinds) {
    const Program program(device, {"kernels/bvh/refit.cl"},
                          {{"BVH_LAYOUT", std::to_string(static_cast<uint32_t>(bvh.layout()))}});
    count_faults_ = Kernel(program, "count_faults", group_size);
    refit_triangles_ = Kernel(program, "refit_triangles", group_size);
    refit_nodes_ = Kernel(program, "refit_nodes", group_size);
    Kernel link_parents(program, "link_parents", group_size),
        find_depths(program, "find_depths", group_size);
    Kernel find_levels(program, "find_levels", group_size);
    bvh.visit([&](const auto &nodes, const auto &) {
        const auto count = static_cast<uint32_t>(nodes.size());
        const Buffer<uint32_t> parents(device, "bvh node parents", count);
        link_parents.bind({nodes, count, parents});
        link_parents.enqueue(count);
        Buffer<uint64_t> depths(device, "bvh node depths", count);
        order_ = Buffer<uint32_t>(device, "bvh nodes by level", count);
        find_depths.bind({parents, count, depths, order_});
        find_depths.enqueue(count);
        RadixSort(device, RadixSortParameters::for_device(device.info(), group_size))
            .sort(depths, order_, 8);
        const Buffer<uint32_t> levels(device, "bvh levels", level_limit);
        find_levels.bind({depths, count, level_limit, levels});
        find_levels.enqueue(level_limit);
        levels_ = levels.read();
    });
    levels_.erase(std::unique(levels_.begin(), levels_.end()), levels_.end());
}

bool BvhRefitter::refit(Bvh &bvh, const Buffer<float> &positions, const Buffer<uint32_t> &indices) {
    const uint64_t triangles_built = uint64_t{bvh.report().left_out} + bvh.report().triangles;
    if (indices.size() != 3 * triangles_built) {
        throw input_error(
            fmt::format("BVH refit: the tree was built from {} triangles; expected 3 vertex "
                        "indices for each, got {}",
                        triangles_built, indices.size()));
    }
    device_->finish();
    const double seconds_before = total_seconds(device_->profiler().stages());
    BvhReport report = bvh.report();
    const auto vertex_count = static_cast<uint32_t>(positions.size() / 3);
    const auto triangle_count = static_cast<uint32_t>(indices.size() / 3);
    faults_.fill(0);
    count_faults_.bind({positions, vertex_count, indices, triangle_count, faults_});
    count_faults_.enqueue(triangle_count);
    const std::vector<uint32_t> input = faults_.read();
    if (input[TRIANGLE_BAD_INDEX] > 0) {
        throw input_error(fmt::format(
            "BVH refit: {} triangles refer to a vertex that does not exist; there are {} vertices",
            input[TRIANGLE_BAD_INDEX], vertex_count));
    }
    faults_.fill(0);
    bvh.visit([&](const auto &nodes, const auto &triangles) {
        const auto records = static_cast<uint32_t>(triangles.size());
        refit_triangles_.bind({positions, vertex_count, indices, records, triangles, faults_});
        refit_triangles_.enqueue(records);
        for (size_t level = levels_.size() - 1; level-- > 0;) {
            refit_nodes_.bind({order_, levels_[level], levels_[level + 1], nodes, triangles});
            refit_nodes_.enqueue(levels_[level + 1] - levels_[level]);
        }
    });
    const std::vector<uint32_t> tree = faults_.read();
    device_->finish();
    report.seconds_device = total_seconds(device_->profiler().stages()) - seconds_before;
    report.not_finite = input[TRIANGLE_NOT_FINITE];
    report.degenerate = input[TRIANGLE_DEGENERATE];
    bvh.set_report(report);
    return report.rejected() ==
           report.left_out + tree[TRIANGLE_NOT_FINITE] + tree[TRIANGLE_DEGENERATE];
}

}  // namespace rtrays
