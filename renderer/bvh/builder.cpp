// SPDX-License-Identifier: MIT
#include "renderer/bvh/builder.h"

#include <fmt/format.h>

#include <algorithm>
#include <optional>

#include "renderer/base/error.h"
#include "renderer/kernels/bvh/build_records.h"

namespace rtrays {

namespace {

/// Device memory of a build per triangle, stated in the message when the build does not fit: two
/// buffers of primitives, scratch nodes, the finished nodes (at most as many as scratch nodes) and
/// the leaf triangles.
constexpr uint64_t bytes_per_triangle =
    2 * sizeof(PrimitiveRef) + 2 * sizeof(BvhNode) + sizeof(LeafTriangle);

uint32_t divide_up(uint32_t a, uint32_t b) {
    return a / b + (a % b != 0 ? 1 : 0);
}

/// Sizes of the buffers of the large phase. A node to be split is above the subtree size, which
/// bounds the nodes of a level. The greatest depth of leaves bounds the number of levels, and thus
/// the nodes and subtrees of the phase.
struct Capacities {
    uint32_t tasks, chunks, top_nodes, subtrees;
    size_t chunk_bins, task_bins;  ///< in units of a BinSet of the default bins and axes

    Capacities(uint32_t triangles, const BvhBuildParameters &parameters) {
        tasks = triangles / parameters.subtree_size + 1;
        chunks = triangles / parameters.chunk_size + tasks + 1;
        top_nodes = static_cast<uint32_t>(
            std::min<uint64_t>(uint64_t{BVH_BINNED_DEPTH} * tasks, triangles + 1u));
        subtrees = top_nodes + 1;
        const auto bin_sets = [&](size_t count) {
            const size_t usual = size_t{BVH_BINS} * BVH_BINNED_AXES;
            return (count * parameters.bins * parameters.axes + usual - 1) / usual;
        };
        chunk_bins = bin_sets(chunks);
        task_bins = bin_sets(tasks);
    }
};

Defines parameter_defines(const BvhBuildParameters &parameters) {
    return {{"ONE_GROUP", fmt::format("{}u", parameters.one_group)},
            {"BVH_BINS", fmt::format("{}u", parameters.bins)},
            {"BVH_BINNED_AXES", fmt::format("{}u", parameters.axes)}};
}

}  // namespace

BvhBuildParameters BvhBuildParameters::for_device(const DeviceInfo &device) {
    // A CPU core takes long pieces one at a time and keeps a subtree in its cache; a GPU takes many
    // short ones. The layouts were chosen by measurement: `make bench`.
    if (device.is_cpu) {
        return {1, 1024, 1024, BvhLayout::wide8};
    }
    BvhBuildParameters parameters{64, 256, 64, BvhLayout::bvh2};
    parameters.one_group = static_cast<uint32_t>(std::min<size_t>(256, device.max_group_size));
    parameters.parts = BVH_BINS * BVH_BINNED_AXES;
    return parameters;
}

/// The primitives of the input, and the first task or subtree, whose range covers all of them.
struct BvhBuilder::Gathered {
    Gathered(DeviceContext &device, uint32_t triangles, uint32_t chunk_size,
             const Capacities &capacities)
        : triangle_count(triangles),
          input_chunk_count(divide_up(triangles, chunk_size)),
          input_chunks(device, "bvh input chunks", input_chunk_count),
          state(device, "bvh build state", 1),
          primitives(device, "bvh primitives 0", triangles),
          tasks(device, "bvh tasks 0", capacities.tasks),
          chunks(device, "bvh chunks 0", capacities.chunks),
          subtrees(device, "bvh subtrees", capacities.subtrees) {}

    uint32_t triangle_count, input_chunk_count;
    Buffer<InputChunk> input_chunks;
    Buffer<BuildState> state;
    Buffer<PrimitiveRef> primitives;
    Buffer<BuildTask> tasks;
    Buffer<BuildChunk> chunks;
    Buffer<BuildSubtree> subtrees;
};

/// Buffers of binning, besides those of `Gathered`. Levels alternate between two buffers.
struct BvhBuilder::Workspace {
    Workspace(DeviceContext &device, Gathered &gathered, const Capacities &capacities)
        : state(gathered.state),
          primitives{std::move(gathered.primitives),
                     Buffer<PrimitiveRef>(device, "bvh primitives 1", gathered.triangle_count)},
          tasks{std::move(gathered.tasks),
                Buffer<BuildTask>(device, "bvh tasks 1", capacities.tasks)},
          chunks{std::move(gathered.chunks),
                 Buffer<BuildChunk>(device, "bvh chunks 1", capacities.chunks)},
          chunk_bins(device, "bvh chunk bins", capacities.chunk_bins),
          task_bins(device, "bvh task bins", capacities.task_bins),
          top_nodes(device, "bvh top nodes", capacities.top_nodes),
          subtrees(gathered.subtrees),
          scratch_nodes(device, "bvh scratch nodes", gathered.triangle_count) {}

    uint64_t bytes() const {
        return state.bytes() + 2 * (primitives[0].bytes() + tasks[0].bytes() + chunks[0].bytes()) +
               chunk_bins.bytes() + task_bins.bytes() + top_nodes.bytes() + subtrees.bytes() +
               scratch_nodes.bytes();
    }

    BuildState read_state() const { return state.read().front(); }

    const Buffer<BuildState> &state;
    Buffer<PrimitiveRef> primitives[2];
    Buffer<BuildTask> tasks[2];
    Buffer<BuildChunk> chunks[2];
    Buffer<BinSet> chunk_bins, task_bins;
    Buffer<BvhNode> top_nodes;
    const Buffer<BuildSubtree> &subtrees;
    Buffer<BvhNode> scratch_nodes;
};

BvhBuilder::LevelKernels::LevelKernels(DeviceContext &device,
                                       const BvhBuildParameters &parameters) {
    const Program program(device, {"kernels/bvh/split_level.cl"}, parameter_defines(parameters));
    const uint32_t group = parameters.group_size;
    bin_primitives = Kernel(program, "bin_primitives", group);
    merge_bins = Kernel(program, "merge_bins", group);
    choose_splits = Kernel(program, "choose_splits", group);
    partition_primitives = Kernel(program, "partition_primitives", group);
    merge_children = Kernel(program, "merge_children", group);
    emit_children = Kernel(program, "emit_children", parameters.one_group);
}

BvhBuilder::BvhBuilder(DeviceContext &device)
    : BvhBuilder(device, BvhBuildParameters::for_device(device.info())) {}

BvhBuilder::BvhBuilder(DeviceContext &device, const BvhBuildParameters &parameters)
    : device_(&device), parameters_(parameters) {
    const uint32_t group = parameters.group_size;
    if (group == 0 || parameters.chunk_size == 0 || parameters.subtree_size < BVH_LEAF_SIZE) {
        throw input_error(
            fmt::format("BVH build parameters: group size {} and chunk size {} must be positive, "
                        "subtree size {} must be at least {}",
                        group, parameters.chunk_size, parameters.subtree_size, BVH_LEAF_SIZE));
    }
    if (parameters.one_group == 0 || (parameters.one_group & (parameters.one_group - 1)) != 0 ||
        parameters.parts == 0) {
        throw input_error(fmt::format(
            "BVH build parameters: one_group {} must be a power of two, parts {} must be positive",
            parameters.one_group, parameters.parts));
    }
    if (parameters.bins < 2 || parameters.bins > 64 ||
        (parameters.axes != 1 && parameters.axes != 3)) {
        throw input_error(
            fmt::format("BVH build parameters: bins {} must be 2 to 64, axes {} must be 1 or 3",
                        parameters.bins, parameters.axes));
    }
    const Program program(device,
                          {"kernels/bvh/gather_primitives.cl", "kernels/bvh/build_subtrees.cl",
                           "kernels/bvh/place_subtrees.cl"},
                          parameter_defines(parameters));
    check_triangles_ = Kernel(program, "check_triangles", group);
    begin_build_ = Kernel(program, "begin_build", parameters.one_group);
    gather_primitives_ = Kernel(program, "gather_primitives", group);
    build_subtrees_ = Kernel(program, "build_subtrees", group);
    place_subtrees_ = Kernel(program, "place_subtrees", parameters.one_group);
    copy_top_nodes_ = Kernel(program, "copy_top_nodes", group);
    copy_subtrees_ = Kernel(program, "copy_subtrees", group);
    if (parameters.method == BvhMethod::hploc) {
        hploc_.emplace(device, group, parameters.subtree_size);
    }
    if (parameters.layout == BvhLayout::wide8) {
        collapser_.emplace(device, group);
    } else if (parameters.layout == BvhLayout::bvh2_stackless) {
        linearizer_.emplace(device, parameters.subtree_size);
    }
}

void require_build_memory(const DeviceInfo &device, uint64_t triangle_count, uint64_t input_bytes) {
    constexpr double gib = 1024.0 * 1024.0 * 1024.0;
    if (triangle_count > BVH_MAX_TRIANGLES) {
        throw input_error(fmt::format(
            "BVH: {} triangles exceed the limit of {}; use a smaller scene (this one would take "
            "{:.1f} GiB of device memory, {} bytes per triangle)",
            triangle_count, BVH_MAX_TRIANGLES,
            static_cast<double>(triangle_count * bytes_per_triangle) / gib, bytes_per_triangle));
    }
    const uint64_t largest = triangle_count * sizeof(BvhNode);
    const uint64_t total = triangle_count * bytes_per_triangle + input_bytes;
    if (largest > device.max_allocation || total > device.global_memory) {
        throw input_error(fmt::format(
            "BVH: {} triangles take {:.2f} GiB of device memory, {:.2f} GiB of it in one "
            "allocation, but device '{}' has {:.2f} GiB and allows {:.2f} GiB per allocation; use "
            "another device or a smaller scene",
            triangle_count, static_cast<double>(total) / gib, static_cast<double>(largest) / gib,
            device.name, static_cast<double>(device.global_memory) / gib,
            static_cast<double>(device.max_allocation) / gib));
    }
}

BuildState BvhBuilder::gather(Gathered &gathered, uint32_t subtree_size,
                              const Buffer<float> &positions, const Buffer<uint32_t> &indices) {
    const auto vertex_count = static_cast<uint32_t>(positions.size() / 3);
    const uint32_t chunk_size = parameters_.chunk_size;
    const uint32_t count = gathered.triangle_count, chunks = gathered.input_chunk_count;
    check_triangles_.bind(
        {positions, vertex_count, indices, count, chunk_size, gathered.input_chunks});
    check_triangles_.enqueue(chunks);
    begin_build_.bind({gathered.input_chunks, chunks, chunk_size, subtree_size, gathered.state,
                       gathered.tasks, gathered.chunks, gathered.subtrees});
    begin_build_.enqueue(parameters_.one_group);
    gather_primitives_.bind({positions, vertex_count, indices, count, chunk_size,
                             gathered.input_chunks, gathered.primitives});
    gather_primitives_.enqueue(chunks);
    const BuildState state = gathered.state.read().front();
    if (state.bad_index > 0) {
        throw input_error(
            fmt::format("BVH: {} triangles refer to a vertex that does not exist; there are {} "
                        "vertices",
                        state.bad_index, vertex_count));
    }
    return state;
}

void BvhBuilder::split_levels(Workspace &work) {
    BuildState state = work.read_state();
    if (state.task_count > 0 && !levels_) {
        levels_.emplace(*device_, parameters_);
    }
    for (uint32_t level = 0; state.task_count > 0; ++level) {
        const uint32_t now = level % 2;
        const uint32_t next = 1 - now;
        levels_->bin_primitives.bind({work.tasks[now], work.chunks[now], state.chunk_count,
                                      work.primitives[now], work.chunk_bins});
        levels_->bin_primitives.enqueue(state.chunk_count);
        levels_->merge_bins.bind({work.tasks[now], state.task_count, parameters_.parts,
                                  work.chunk_bins, work.task_bins});
        levels_->merge_bins.enqueue(uint64_t{state.task_count} * parameters_.parts);
        levels_->choose_splits.bind({work.tasks[now], state.task_count, work.task_bins});
        levels_->choose_splits.enqueue(state.task_count);
        levels_->partition_primitives.bind({work.tasks[now], work.chunks[now], state.chunk_count,
                                            work.chunk_bins, work.primitives[now],
                                            work.primitives[next]});
        levels_->partition_primitives.enqueue(state.chunk_count);
        levels_->merge_children.bind({work.tasks[now], state.task_count, work.chunks[now]});
        levels_->merge_children.enqueue(2 * uint64_t{state.task_count});
        levels_->emit_children.bind({work.state, work.tasks[now], state.task_count,
                                     parameters_.chunk_size, parameters_.subtree_size, next,
                                     work.top_nodes, work.tasks[next], work.chunks[next],
                                     work.subtrees});
        levels_->emit_children.enqueue(parameters_.one_group);
        state = work.read_state();
    }
}

Bvh BvhBuilder::build(const Buffer<float> &positions, const Buffer<uint32_t> &indices) {
    Bvh bvh = build_bvh2(positions, indices);
    if (collapser_) {
        return collapser_->collapse(bvh);
    }
    return linearizer_ ? linearizer_->linearize(std::move(bvh)) : std::move(bvh);
}

Bvh BvhBuilder::build_bvh2(const Buffer<float> &positions, const Buffer<uint32_t> &indices) {
    if (positions.size() % 3 != 0 || indices.size() % 3 != 0) {
        throw input_error(
            fmt::format("BVH: expected multiples of 3, got {} coordinates and {} vertex indices",
                        positions.size(), indices.size()));
    }
    require_build_memory(device_->info(), indices.size() / 3, positions.bytes() + indices.bytes());
    device_->finish();
    const double seconds_before = total_seconds(device_->profiler().stages());
    std::optional<Bvh> clustered = hploc_ ? build_by_clustering(positions, indices) : std::nullopt;
    Bvh bvh = clustered ? std::move(*clustered) : build_by_binning(positions, indices);
    device_->finish();
    BvhReport report = bvh.report();
    report.seconds_device = total_seconds(device_->profiler().stages()) - seconds_before;
    report.left_out = report.rejected();
    report.bytes_peak += positions.bytes() + indices.bytes();
    bvh.set_report(report);
    return bvh;
}

std::optional<Bvh> BvhBuilder::build_by_clustering(const Buffer<float> &positions,
                                                   const Buffer<uint32_t> &indices) {
    BvhBuildParameters undivided = parameters_;
    undivided.subtree_size = BVH_MAX_TRIANGLES;
    const auto triangle_count = static_cast<uint32_t>(indices.size() / 3);
    Gathered gathered(*device_, triangle_count, parameters_.chunk_size,
                      Capacities(triangle_count, undivided));
    const BuildState state = gather(gathered, undivided.subtree_size, positions, indices);
    if (state.primitive_count <= BVH_LEAF_SIZE) {
        return std::nullopt;
    }
    std::optional<Bvh> bvh =
        hploc_->build({std::move(gathered.state), std::move(gathered.primitives),
                       std::move(gathered.subtrees), state.primitive_count},
                      positions, indices);
    if (bvh) {
        BvhReport report = bvh->report();
        report.method = BvhMethod::hploc;
        report.triangles = state.primitive_count;
        report.not_finite = state.not_finite;
        report.degenerate = state.degenerate;
        report.bytes_peak +=
            gathered.input_chunks.bytes() + gathered.tasks.bytes() + gathered.chunks.bytes();
        bvh->set_report(report);
    }
    return bvh;
}

Bvh BvhBuilder::build_by_binning(const Buffer<float> &positions, const Buffer<uint32_t> &indices) {
    const auto triangle_count = static_cast<uint32_t>(indices.size() / 3);
    const Capacities capacities(triangle_count, parameters_);
    Gathered gathered(*device_, triangle_count, parameters_.chunk_size, capacities);
    gather(gathered, parameters_.subtree_size, positions, indices);
    Workspace work(*device_, gathered, capacities);
    split_levels(work);
    BuildState state = work.read_state();
    build_subtrees_.bind({work.subtrees, state.subtree_count, work.primitives[0],
                          work.primitives[1], work.state, work.scratch_nodes});
    build_subtrees_.enqueue(state.subtree_count);
    place_subtrees_.bind({work.state, work.subtrees, state.subtree_count, work.top_nodes});
    place_subtrees_.enqueue(parameters_.one_group);
    state = work.read_state();

    Buffer<BvhNode> nodes(*device_, "bvh nodes", state.node_count);
    Buffer<LeafTriangle> triangles(*device_, "bvh triangles", state.primitive_count);
    copy_top_nodes_.bind({work.top_nodes, state.top_node_count, nodes});
    copy_top_nodes_.enqueue(state.top_node_count);
    copy_subtrees_.bind({work.subtrees, state.subtree_count, work.scratch_nodes, work.primitives[0],
                         work.primitives[1], positions, indices, nodes, triangles});
    copy_subtrees_.enqueue(state.subtree_count);

    BvhReport report;
    report.triangles = state.primitive_count;
    report.not_finite = state.not_finite;
    report.degenerate = state.degenerate;
    report.nodes = state.node_count;
    report.leaves = state.leaf_count;
    report.depth = state.depth;
    report.sah_cost = static_cast<double>(state.cost);
    report.bytes = nodes.bytes() + triangles.bytes();
    report.bytes_peak = report.bytes + gathered.input_chunks.bytes() + work.bytes();
    device_->finish();  // before the workspace is released
    return {std::move(nodes), std::move(triangles), report};
}

BvhInput::BvhInput(DeviceContext &device, const std::vector<Eigen::Vector3f> &vertices,
                   const std::vector<std::array<uint32_t, 3>> &triangles) {
    std::vector<float> coordinates(vertices.size() * 3);
    std::vector<uint32_t> corners(triangles.size() * 3);
    for (size_t i = 0; i < vertices.size(); ++i) {
        std::copy_n(vertices[i].data(), 3, coordinates.data() + 3 * i);
    }
    for (size_t i = 0; i < triangles.size(); ++i) {
        std::copy_n(triangles[i].data(), 3, corners.data() + 3 * i);
    }
    positions = Buffer<float>(device, "bvh positions", coordinates);
    indices = Buffer<uint32_t>(device, "bvh indices", corners);
}

Bvh BvhBuilder::build(const std::vector<Eigen::Vector3f> &positions,
                      const std::vector<std::array<uint32_t, 3>> &triangles) {
    require_build_memory(device_->info(), triangles.size(),
                         positions.size() * 12 + triangles.size() * 12);
    const BvhInput input(*device_, positions, triangles);
    return build(input.positions, input.indices);
}

}  // namespace rtrays
