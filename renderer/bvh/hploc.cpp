// SPDX-License-Identifier: MIT
#include "renderer/bvh/hploc.h"

#include <algorithm>

namespace rtrays {

namespace {

/// Group size of kernels with a work-item per primitive or node: enough for a CPU to loop over, few
/// enough for any GPU.
constexpr uint32_t element_group = 64;

/// Bits of a code that are sorted by: all of them.
constexpr uint32_t code_bits = 63;

}  // namespace

/// Buffers of clustering. The ranges above the subtree size are disjoint in each level of the radix
/// tree, and each of them is divided at one position, which bounds their number.
struct HplocBuilder::Workspace {
    Workspace(DeviceContext &device, uint32_t count, uint32_t subtree_size)
        : range_capacity(static_cast<uint32_t>(std::min<uint64_t>(
                             uint64_t{HPLOC_LEVELS} * (count / subtree_size), count)) +
                         1),
          state(device, "bvh cluster state", 1),
          ranges(device, "bvh code ranges", range_capacity),
          subtrees(device, "bvh code subtrees", std::min(range_capacity, count / HPLOC_KEPT) + 1),
          kept(device, "bvh clusters kept", count),
          nodes(device, "bvh scratch nodes", count),
          cluster_nodes(device, "bvh cluster nodes", count) {}

    uint64_t bytes() const {
        return state.bytes() + ranges.bytes() + subtrees.bytes() + kept.bytes() + nodes.bytes() +
               cluster_nodes.bytes();
    }

    uint32_t range_capacity;
    Buffer<ClusterState> state;
    Buffer<CodeRange> ranges;
    Buffer<CodeSubtree> subtrees;
    Buffer<uint32_t> kept;
    Buffer<BvhNode> nodes;
    Buffer<ClusterNode> cluster_nodes;
    Buffer<uint64_t> codes;
    Buffer<PrimitiveRef> clusters;
};

HplocBuilder::HplocBuilder(DeviceContext &device, uint32_t group_size, uint32_t subtree_size)
    : device_(&device),
      subtree_size_(std::max(subtree_size, 2 * HPLOC_KEPT)),
      sort_(device, RadixSortParameters::for_device(device.info(), group_size)) {
    const Program program(device, {"kernels/bvh/sort_primitives.cl", "kernels/bvh/hploc.cl",
                                   "kernels/bvh/place_clusters.cl"});
    encode_centroids_ = Kernel(program, "encode_centroids", element_group);
    gather_clusters_ = Kernel(program, "gather_clusters", element_group);
    begin_ranges_ = Kernel(program, "begin_ranges", 1);
    divide_ranges_ = Kernel(program, "divide_ranges", group_size);
    cluster_subtrees_ = Kernel(program, "cluster_subtrees", group_size);
    cluster_ranges_ = Kernel(program, "cluster_ranges", group_size);
    cluster_root_ = Kernel(program, "cluster_root", 1);
    place_clusters_ = Kernel(program, "place_clusters", element_group);
    fill_triangles_ = Kernel(program, "fill_triangles", element_group);
    sum_costs_ = Kernel(program, "sum_costs", group_size);
    sum_cost_ = Kernel(program, "sum_cost", 1);
}

void HplocBuilder::cluster(Workspace &work, uint32_t count) {
    begin_ranges_.bind({work.state, work.ranges, work.subtrees, subtree_size_, count});
    begin_ranges_.enqueue(1);
    std::vector<uint32_t> levels = {0};
    ClusterState state = work.state.read().front();
    while (state.range_count > levels.back()) {
        const uint32_t begin = levels.back();
        levels.push_back(state.range_count);
        divide_ranges_.bind({work.codes, begin, levels.back(), subtree_size_, work.state,
                             work.ranges, work.subtrees});
        divide_ranges_.enqueue(levels.back() - begin);
        state = work.state.read().front();
    }
    cluster_subtrees_.bind({work.subtrees, state.subtree_count, work.codes, work.clusters,
                            work.kept, work.nodes, work.cluster_nodes});
    cluster_subtrees_.enqueue(state.subtree_count);
    for (size_t level = levels.size() - 1; level-- > 0;) {
        cluster_ranges_.bind({work.ranges, levels[level], levels[level + 1], work.clusters,
                              work.kept, work.nodes, work.cluster_nodes});
        cluster_ranges_.enqueue(levels[level + 1] - levels[level]);
    }
    cluster_root_.bind(
        {work.clusters, work.kept, count, work.nodes, work.cluster_nodes, work.state});
    cluster_root_.enqueue(1);
}

std::optional<Bvh> HplocBuilder::build(GatheredPrimitives gathered, const Buffer<float> &positions,
                                       const Buffer<uint32_t> &indices) {
    const uint32_t count = gathered.count;
    Buffer<uint64_t> codes(*device_, "bvh codes", count);
    Buffer<uint32_t> order(*device_, "bvh order", count);
    encode_centroids_.bind({gathered.primitives, count, gathered.all, codes, order});
    encode_centroids_.enqueue(count);
    sort_.sort(codes, order, code_bits);
    Buffer<PrimitiveRef> clusters(*device_, "bvh clusters", count);
    gather_clusters_.bind({gathered.primitives, order, count, clusters});
    gather_clusters_.enqueue(count);
    device_->finish();  // the buffers of sorting are released below
    uint64_t peak = gathered.primitives.bytes() + codes.bytes() + order.bytes() + clusters.bytes() +
                    sort_.bytes(count);
    gathered.primitives = {};

    Workspace work(*device_, count, subtree_size_);
    work.codes = std::move(codes);
    work.clusters = std::move(clusters);
    cluster(work, count);
    const ClusterState state = work.state.read().front();
    const uint64_t clustering =
        work.codes.bytes() + order.bytes() + work.clusters.bytes() + work.bytes();
    if (state.depth > BVH_MAX_DEPTH) {
        return std::nullopt;
    }
    Buffer<BvhNode> nodes(*device_, "bvh nodes", state.node_count);
    Buffer<LeafTriangle> triangles(*device_, "bvh triangles", count);
    Buffer<float> costs(*device_, "bvh costs", state.node_count / BVH_COST_BLOCK + 1);
    place_clusters_.bind({work.nodes, work.cluster_nodes, count, subtree_size_, nodes, order});
    place_clusters_.enqueue(count);
    fill_triangles_.bind({order, count, positions, indices, triangles});
    fill_triangles_.enqueue(count);
    sum_costs_.bind({nodes, state.node_count, gathered.state, costs});
    sum_costs_.enqueue(state.node_count / BVH_COST_BLOCK + 1);
    sum_cost_.bind({costs, state.node_count, gathered.state});
    sum_cost_.enqueue(1);

    BvhReport report;
    report.nodes = state.node_count;
    report.leaves = state.node_count + 1;
    report.depth = state.depth;
    report.sah_cost = static_cast<double>(gathered.state.read().front().cost);
    report.bytes = nodes.bytes() + triangles.bytes();
    report.bytes_peak = std::max(peak, clustering + report.bytes + costs.bytes()) +
                        gathered.state.bytes() + gathered.all.bytes();
    return Bvh(std::move(nodes), std::move(triangles), report);
}

}  // namespace rtrays
