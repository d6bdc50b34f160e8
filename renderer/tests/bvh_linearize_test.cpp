// SPDX-License-Identifier: MIT
// The stackless layout: the two-wide tree, node by node in depth-first order, and a way through it for every
// octant.
#include <gtest/gtest.h>

#include <cstring>

#include "renderer/tests/bvh_tree.h"

namespace rtrays {
namespace {

using namespace test;

/// Walks both trees together; returns the place after the subtree of `index`, and says where they differ.
uint32_t compare_subtree(const HostBvh &tree, uint32_t index, const HostBvh &stackless, uint32_t place,
                         std::string *fault) {
    const StacklessNode parent = stackless.stackless_nodes[place];
    ++place;
    for (uint32_t side = 0; side < 2; ++side) {
        const BvhNode &node = tree.nodes[index];
        if (node.count[side] == 0) {
            continue;
        }
        if (place >= stackless.stackless_nodes.size() || (side == 1 && parent.link != place)) {
            *fault = "node " + std::to_string(place) + " is missing";
            return place;
        }
        const StacklessNode &child = stackless.stackless_nodes[place];
        const bool is_leaf = (node.child[side] & BVH_LEAF_BIT) != 0;
        if (std::memcmp(child.bounds, node.bounds[side], sizeof child.bounds) != 0 ||
            (is_leaf && child.link != node.child[side])) {
            *fault = "node " + std::to_string(place) + " differs";
        }
        place = is_leaf ? place + 1 : compare_subtree(tree, node.child[side], stackless, place, fault);
    }
    return place;
}

/// Checks the ways of an octant below a node, after which it goes on at `after`; counts the nodes seen.
void follow(const std::vector<StacklessNode> &nodes, uint32_t place, uint32_t octant, uint32_t after,
            size_t *seen, std::string *fault) {
    const StacklessNode &node = nodes[place];
    *seen += 1;
    if (node.escape[octant] != after) {
        *fault = "node " + std::to_string(place) + " escapes to elsewhere";
    }
    if ((node.link & BVH_LEAF_BIT) != 0 || nodes.size() == 1) {
        return;
    }
    const uint32_t left = place + 1, right = node.link;
    if (right == nodes.size()) {  // a root over a single leaf
        follow(nodes, left, octant, after, seen, fault);
    } else if ((node.right_first >> octant & 1) != 0) {
        follow(nodes, right, octant, left, seen, fault);
        follow(nodes, left, octant, after, seen, fault);
    } else {
        follow(nodes, left, octant, right, seen, fault);
        follow(nodes, right, octant, after, seen, fault);
    }
}

class BvhLinearize : public testing::TestWithParam<NamedBvhMethod> {};
INSTANTIATE_TEST_SUITE_P(Methods, BvhLinearize, testing::ValuesIn(bvh_methods),
                         [](const auto &test) { return std::string(test.param.name); });

TEST_P(BvhLinearize, HoldsTheTreeInDepthFirstOrder) {
    std::vector<Mesh> meshes = {{"empty", {}, {}}, room(), soup(30000, 1), terrain(100, 2)};
    for (uint32_t count = 1; count < 12; ++count) {
        meshes.push_back(soup(count, count));
    }
    for (const Mesh &mesh : meshes) {
        const HostBvh tree = build_bvh(mesh, {BvhLayout::bvh2, GetParam().method});
        const HostBvh stackless = build_bvh(mesh, {BvhLayout::bvh2_stackless, GetParam().method});
        std::string fault;
        const uint32_t end = compare_subtree(tree, 0, stackless, 0, &fault);
        EXPECT_EQ(fault, "") << mesh.name << ' ' << mesh.triangles.size();
        ASSERT_EQ(stackless.stackless_nodes.size(), end) << mesh.name;
        for (uint32_t octant = 0; octant < 8; ++octant) {
            size_t seen = 0;
            follow(stackless.stackless_nodes, 0, octant, end, &seen, &fault);
            EXPECT_EQ(fault, "") << mesh.name << ", octant " << octant;
            EXPECT_EQ(seen, end) << mesh.name << ", octant " << octant;
        }
        ASSERT_EQ(stackless.triangles.size(), tree.triangles.size());
        EXPECT_EQ(std::memcmp(stackless.triangles.data(), tree.triangles.data(),
                              tree.triangles.size() * sizeof(LeafTriangle)),
                  0)
            << mesh.name;
    }
}

}  // namespace
}  // namespace rtrays
