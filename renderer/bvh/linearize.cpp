// SPDX-License-Identifier: MIT
#include "renderer/bvh/linearize.h"

namespace rtrays {

BvhLinearizer::BvhLinearizer(DeviceContext &device, uint32_t group_size) : device_(&device) {
    const Program program(device, "kernels/bvh/linearize.cl");
    count_subtrees_ = Kernel(program, "count_subtrees", 1);
    write_stackless_nodes_ = Kernel(program, "write_stackless_nodes", group_size);
    link_stackless_nodes_ = Kernel(program, "link_stackless_nodes", 1);
}

Bvh BvhLinearizer::linearize(Bvh bvh) {
    device_->finish();
    const double seconds_before = total_seconds(device_->profiler().stages());
    BvhReport report = bvh.report();
    const uint32_t node_count = report.nodes;
    const Buffer<uint32_t> sizes(*device_, "bvh subtree sizes", node_count);
    const Buffer<uint32_t> places(*device_, "bvh node places", node_count);
    Buffer<StacklessNode> nodes(*device_, "bvh nodes", node_count + report.leaves);
    count_subtrees_.bind({bvh.nodes(), node_count, sizes, places});
    count_subtrees_.enqueue(1);
    write_stackless_nodes_.bind({bvh.nodes(), node_count, sizes, places, nodes});
    write_stackless_nodes_.enqueue(node_count);
    link_stackless_nodes_.bind({sizes, nodes});
    link_stackless_nodes_.enqueue(1);
    device_->finish();

    report.seconds_device += total_seconds(device_->profiler().stages()) - seconds_before;
    report.bytes = nodes.bytes() + bvh.triangles().bytes();
    report.bytes_peak =
        std::max(report.bytes_peak, bvh.report().bytes + nodes.bytes() + sizes.bytes() + places.bytes());
    return {std::move(nodes), bvh.take_triangles(), report};
}

}  // namespace rtrays
