// SPDX-License-Identifier: MIT
#include "renderer/bvh/collapse.h"

#include "renderer/kernels/bvh/collapse.h"

namespace rtrays {

namespace {

/// Returns an upper bound of the number of wide nodes over n triangles, including node 0. A node of
/// fewer than eight children has only leaves, with more than eight triangles in them: there are at
/// most n / 9 such nodes. For the i nodes of eight children, 8 i < i + n / 9 + (leaves, at most n),
/// so there are at most n / 6 of them.
uint32_t node_capacity(uint32_t triangles) {
    return triangles / 3 + 2;
}

}  // namespace

BvhCollapser::BvhCollapser(DeviceContext &device, uint32_t group_size)
    : device_(&device), sums_(PrefixSums::for_device(device, group_size)) {
    const Program program(device, {"kernels/bvh/collapse.cl"});
    begin_collapse_ = Kernel(program, "begin_collapse", 1);
    open_wide_nodes_ = Kernel(program, "open_wide_nodes", group_size);
    link_wide_nodes_ = Kernel(program, "link_wide_nodes", group_size);
    fill_blocks_ = Kernel(program, "fill_blocks", group_size);
    copy_wide_nodes_ = Kernel(program, "copy_wide_nodes", group_size);
}

Bvh BvhCollapser::collapse(const Bvh &bvh) {
    device_->finish();
    const double seconds_before = total_seconds(device_->profiler().stages());
    const uint32_t capacity = node_capacity(bvh.report().triangles);
    const Buffer<WideNode> scratch(*device_, "bvh scratch nodes", capacity);
    const Buffer<WideTask> tasks(*device_, "bvh wide tasks", capacity);
    const Buffer<WideLeaf> leaves(*device_, "bvh wide leaves", bvh.report().triangles);
    const Buffer<uint32_t> child_counts(*device_, "bvh wide child counts", 2 * capacity + 1);
    const Buffer<CollapseState> state(*device_, "bvh collapse state", 1);

    begin_collapse_.bind({bvh.nodes(), state, scratch, tasks, leaves});
    begin_collapse_.enqueue(1);
    CollapseState counts = state.read().front();
    for (uint32_t begin = 1; begin < counts.node_count;) {
        const uint32_t end = counts.node_count;
        open_wide_nodes_.bind({bvh.nodes(), begin, end, scratch, tasks, child_counts});
        open_wide_nodes_.enqueue(end - begin);
        sums_.scan(child_counts, 2 * (end - begin) + 1);
        link_wide_nodes_.bind(
            {begin, end, counts.leaf_count, child_counts, state, scratch, tasks, leaves});
        link_wide_nodes_.enqueue(end - begin);
        counts = state.read().front();
        begin = end;
    }

    Buffer<WideNode> nodes(*device_, "bvh nodes", counts.node_count);
    Buffer<TriangleBlock> blocks(*device_, "bvh triangles", counts.leaf_count);
    copy_wide_nodes_.bind({scratch, counts.node_count, nodes});
    copy_wide_nodes_.enqueue(counts.node_count);
    fill_blocks_.bind({leaves, counts.leaf_count, bvh.triangles(), blocks});
    fill_blocks_.enqueue(counts.leaf_count);
    device_->finish();

    BvhReport report = bvh.report();
    report.seconds_device += total_seconds(device_->profiler().stages()) - seconds_before;
    report.wide_nodes = counts.node_count;
    report.wide_leaves = counts.leaf_count;
    report.bytes = nodes.bytes() + blocks.bytes();
    report.bytes_peak =
        std::max(report.bytes_peak, bvh.report().bytes + report.bytes + scratch.bytes() +
                                        tasks.bytes() + leaves.bytes() + child_counts.bytes() +
                                        sums_.bytes() + state.bytes());
    return {std::move(nodes), std::move(blocks), report};
}

}  // namespace rtrays
