// SPDX-License-Identifier: MIT
// The stackless layout: the two-wide tree, node by node in depth-first order.
#include <gtest/gtest.h>

#include <cstring>

#include "renderer/tests/bvh_tree.h"

namespace rtrays {
namespace {

using namespace test;

/// Walks both trees together; returns the place after the subtree of `index`, and says where they differ.
uint32_t compare_subtree(const HostBvh &tree, uint32_t index, const HostBvh &stackless, uint32_t place,
                         std::string *fault) {
    for (uint32_t side = 0; side < 2; ++side) {
        const BvhNode &node = tree.nodes[index];
        if (node.count[side] == 0) {
            continue;
        }
        if (place >= stackless.stackless_nodes.size()) {
            *fault = "nodes are missing";
            return place;
        }
        const StacklessNode &child = stackless.stackless_nodes[place];
        const bool is_leaf = (node.child[side] & BVH_LEAF_BIT) != 0;
        if (std::memcmp(child.bounds, node.bounds[side], sizeof child.bounds) != 0 ||
            child.leaf != (is_leaf ? node.child[side] : 0)) {
            *fault = "node " + std::to_string(place) + " differs";
        }
        place = is_leaf ? place + 1 : compare_subtree(tree, node.child[side], stackless, place + 1, fault);
        if (child.escape != place) {
            *fault = "node " + std::to_string(place) + " escapes to elsewhere";
        }
    }
    return place;
}

TEST(BvhLinearize, HoldsTheTreeInDepthFirstOrder) {
    std::vector<Mesh> meshes = {{"empty", {}, {}}, room(), soup(30000, 1), terrain(100, 2)};
    for (uint32_t count = 1; count < 12; ++count) {
        meshes.push_back(soup(count, count));
    }
    for (const Mesh &mesh : meshes) {
        const HostBvh tree = build_bvh(mesh), stackless = build_bvh(mesh, BvhLayout::bvh2_stackless);
        std::string fault;
        const uint32_t end = compare_subtree(tree, 0, stackless, 1, &fault);
        EXPECT_EQ(fault, "") << mesh.name << ' ' << mesh.triangles.size();
        EXPECT_EQ(stackless.stackless_nodes[0].escape, end) << mesh.name;
        EXPECT_EQ(stackless.stackless_nodes.size(), end) << mesh.name;
        ASSERT_EQ(stackless.triangles.size(), tree.triangles.size());
        EXPECT_EQ(std::memcmp(stackless.triangles.data(), tree.triangles.data(),
                              tree.triangles.size() * sizeof(LeafTriangle)),
                  0)
            << mesh.name;
    }
}

}  // namespace
}  // namespace rtrays
