// SPDX-License-Identifier: MIT
#include "renderer/bvh/linearize.h"

namespace rtrays {

namespace {

/// Group size of all stages; each has a work-item per node.
constexpr uint32_t group_size = 64;

}  // namespace

BvhLinearizer::BvhLinearizer(DeviceContext &device, uint32_t subtree_size)
    : device_(&device), subtree_size_(subtree_size) {
    const Program program(device, {"kernels/bvh/linearize.cl"});
    link_parents_ = Kernel(program, "link_parents", group_size);
    count_subtrees_ = Kernel(program, "count_subtrees", group_size);
    place_subtree_nodes_ = Kernel(program, "place_subtree_nodes", group_size);
    write_stackless_nodes_ = Kernel(program, "write_stackless_nodes", group_size);
}

Bvh BvhLinearizer::linearize(Bvh bvh) {
    device_->finish();
    const double seconds_before = total_seconds(device_->profiler().stages());
    BvhReport report = bvh.report();
    const uint32_t node_count = report.nodes;
    const Buffer<uint32_t> parents(*device_, "bvh node parents", node_count);
    const Buffer<uint32_t> sizes(*device_, "bvh subtree sizes", node_count);
    const Buffer<uint32_t> places(*device_, "bvh node places", node_count);
    Buffer<StacklessNode> nodes(*device_, "bvh nodes", 2 * size_t{node_count} + 2);
    link_parents_.bind({bvh.nodes(), node_count, parents, sizes});
    link_parents_.enqueue(node_count);
    count_subtrees_.bind({bvh.nodes(), node_count, subtree_size_, parents, sizes});
    count_subtrees_.enqueue(node_count);
    place_subtree_nodes_.bind({bvh.nodes(), node_count, subtree_size_, parents, sizes, places});
    place_subtree_nodes_.enqueue(node_count);
    write_stackless_nodes_.bind({bvh.nodes(), node_count, parents, places, nodes});
    write_stackless_nodes_.enqueue(node_count);
    device_->finish();

    report.seconds_device += total_seconds(device_->profiler().stages()) - seconds_before;
    report.bytes = nodes.bytes() + bvh.triangles().bytes();
    report.bytes_peak =
        std::max(report.bytes_peak, bvh.report().bytes + nodes.bytes() + parents.bytes() +
                                        sizes.bytes() + places.bytes());
    return {std::move(nodes), bvh.take_triangles(), report};
}

}  // namespace rtrays
