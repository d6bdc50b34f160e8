// SPDX-License-Identifier: MIT
// Hierarchies copied from the device to the host, to trace rays and to check invariants and cost.
#pragma once

#include <algorithm>
#include <map>
#include <string>
#include <vector>

#include "renderer/bvh/builder.h"
#include "renderer/kernels/traversal/intersect_bvh.h"
#include "renderer/testing/bvh_meshes.h"
#include "renderer/testing/full_sweep.h"

namespace rtrays::test {

inline float3 to_float3(const Eigen::Vector3f &v) {
    return {v.x(), v.y(), v.z()};
}

/// A tree of any layout, copied from the device. Rays are traced on the host with the device
/// functions.
struct HostBvh {
    std::vector<BvhNode> nodes;
    std::vector<LeafTriangle> triangles;
    std::vector<StacklessNode> stackless_nodes;
    std::vector<WideNode> wide_nodes;
    std::vector<TriangleBlock> blocks;
    BvhLayout layout;
    BvhReport report;

    explicit HostBvh(const Bvh &bvh)
        : nodes(bvh.nodes().read()),
          triangles(bvh.triangles().read()),
          stackless_nodes(bvh.stackless_nodes().read()),
          wide_nodes(bvh.wide_nodes().read()),
          blocks(bvh.blocks().read()),
          layout(bvh.layout()),
          report(bvh.report()) {}

    /// Calls trace(nodes, triangles) with the nodes and triangles of the layout.
    template <typename Visit>
    auto visit(const Visit &trace) const {
        switch (layout) {
            case BvhLayout::bvh2_stackless:
                return trace(stackless_nodes.data(), triangles.data());
            case BvhLayout::wide8:
                return trace(wide_nodes.data(), blocks.data());
            default:
                return trace(nodes.data(), triangles.data());
        }
    }

    Hit nearest(const Eigen::Vector3f &origin, const Eigen::Vector3f &direction,
                float t_max = INFINITY) const {
        return visit([&](const auto *n, const auto *t) {
            return trace_nearest(n, t, to_float3(origin), to_float3(direction), t_max,
                                 all_opaque());
        });
    }
    bool any(const Eigen::Vector3f &origin, const Eigen::Vector3f &direction, float t_max) const {
        return visit([&](const auto *n, const auto *t) {
            return trace_any(n, t, to_float3(origin), to_float3(direction), t_max, all_opaque());
        });
    }

    /// Returns the id of the triangle at a slot, as `Hit` stores it.
    uint32_t triangle_at(uint32_t slot) const {
        return layout == BvhLayout::wide8 ? blocks[slot / WIDE_LANES].id[slot % WIDE_LANES]
                                          : triangles[slot].id;
    }
};

/// Returns the device that all test cases of a program share.
inline DeviceContext &test_device() {
    static DeviceContext device;
    return device;
}

/// The build method and the layout of a tree.
struct TreeKind {
    BvhLayout layout;
    BvhMethod method;

    TreeKind(BvhLayout of_layout, BvhMethod by_method = BvhMethod::binned_sah)
        : layout(of_layout), method(by_method) {}

    std::string name() const { return std::string(to_string(method)) + "_" + to_string(layout); }
};

inline std::vector<TreeKind> all_tree_kinds() {
    std::vector<TreeKind> kinds;
    for (const Named<BvhMethod> &method : bvh_methods) {
        for (const Named<BvhLayout> &layout : bvh_layouts) {
            kinds.emplace_back(layout.value, method.value);
        }
    }
    return kinds;
}

inline BvhBuilder &builder_of(TreeKind kind) {
    static std::map<std::string, BvhBuilder> builders;
    BvhBuildParameters parameters = BvhBuildParameters::for_device(test_device().info());
    parameters.layout = kind.layout;
    parameters.method = kind.method;
    return builders.try_emplace(kind.name(), test_device(), parameters).first->second;
}

inline Bvh build_on_device(const Mesh &mesh, TreeKind kind) {
    return builder_of(kind).build(mesh.positions, mesh.triangles);
}

inline HostBvh build_bvh(const Mesh &mesh, TreeKind kind = BvhLayout::bvh2) {
    return HostBvh(build_on_device(mesh, kind));
}

/// Results of a walk over all nodes. `fault` is empty for a valid tree.
struct TreeFacts {
    std::string fault;
    uint32_t nodes = 0, leaves = 0, depth = 0;
    double sah_cost = 0;       ///< with K_T = K_I = 1
    std::vector<float> boxes;  ///< all child boxes in depth-first order
    /// Triangle ids in depth-first order. The complement of each leaf's size precedes its ids.
    std::vector<uint32_t> leaf_ids;
};

/// Walks a tree and checks that:
///   * boxes are the exact bounds of their children and triangles;
///   * leaves hold 1 to 4 triangles;
///   * each triangle is in exactly one leaf, with the vertices of the mesh;
///   * every node is reached once.
inline TreeFacts inspect_tree(const HostBvh &bvh, const Mesh &mesh) {
    TreeFacts facts;
    std::vector<uint32_t> seen(bvh.triangles.size(), 0);
    const auto fail = [&](const std::string &what) {
        if (facts.fault.empty()) {
            facts.fault = what;
        }
    };
    double cost = 0, root_area = 0;
    const auto visit = [&](auto &&self, uint32_t index, uint32_t depth) -> Eigen::AlignedBox3d {
        Eigen::AlignedBox3d all;
        if (index >= bvh.nodes.size() || facts.nodes > bvh.nodes.size()) {
            fail("link out of range or cycle");
            return all;
        }
        facts.nodes += 1;
        const BvhNode &node = bvh.nodes[index];
        Eigen::AlignedBox3d boxes[2];
        for (uint32_t side = 0; side < 2; ++side) {
            const float(&b)[2][3] = node.bounds[side];
            facts.boxes.insert(facts.boxes.end(), &b[0][0], &b[0][0] + 6);
            boxes[side] = Eigen::AlignedBox3d(Eigen::Vector3d(b[0][0], b[0][1], b[0][2]),
                                              Eigen::Vector3d(b[1][0], b[1][1], b[1][2]));
            Eigen::AlignedBox3d content;
            const uint32_t link = node.child[side];
            if ((link & BVH_LEAF_BIT) == 0) {
                content = self(self, link, depth + 1);
                cost += half_area(boxes[side]);
            } else {
                const uint32_t count = bvh_leaf_count(link);
                if (count > BVH_LEAF_SIZE || (count == 0 && bvh.nodes.size() > 1)) {
                    fail("leaf of invalid size " + std::to_string(count));
                }
                facts.leaves += count > 0 ? 1 : 0;
                facts.depth = std::max(facts.depth, depth + 1);
                facts.leaf_ids.push_back(~count);
                for (uint32_t slot = bvh_leaf_first(link); slot < bvh_leaf_first(link) + count;
                     ++slot) {
                    if (slot >= bvh.triangles.size()) {
                        fail("leaf out of range");
                        return all;
                    }
                    seen[slot] += 1;
                    const LeafTriangle &triangle = bvh.triangles[slot];
                    facts.leaf_ids.push_back(triangle.id);
                    for (uint32_t corner = 0; corner < 3; ++corner) {
                        const Eigen::Vector3f p(triangle.coordinate[0][corner],
                                                triangle.coordinate[1][corner],
                                                triangle.coordinate[2][corner]);
                        if (p != mesh.vertex(triangle.id, corner)) {
                            fail("vertex differs from the mesh's");
                        }
                        content.extend(p.cast<double>());
                    }
                }
                cost += half_area(boxes[side]) * count;
            }
            if (!content.isEmpty() &&
                (!boxes[side].contains(content) || !content.contains(boxes[side]))) {
                fail("box is not the bound of its content");
            }
            if (!content.isEmpty()) {
                all.extend(content);
            }
        }
        root_area = half_area(all);
        return all;
    };
    visit(visit, 0, 0);
    facts.sah_cost = root_area > 0 ? (cost + root_area) / root_area : 0;
    if (std::any_of(seen.begin(), seen.end(), [](uint32_t n) { return n != 1; })) {
        fail("a triangle is not in exactly one leaf");
    }
    if (facts.nodes != bvh.nodes.size()) {
        fail("unreachable nodes");
    }
    return facts;
}

}  // namespace rtrays::test
