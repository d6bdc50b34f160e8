// SPDX-License-Identifier: MIT
// Tests the stackless layout: it stores the two-wide tree with pairs of children in depth-first
// order, and a traversal order for every octant.
#include <gtest/gtest.h>

#include <cstring>

#include "renderer/testing/bvh_tree.h"

namespace rtrays {
namespace {

using namespace test;

/// Walks both trees together, from node `index` of `tree` and node `number` of `stackless`. `pair`
/// is the first pair of the subtree. Returns the pair after the subtree, and reports a difference
/// in `fault`.
uint32_t compare_subtree(const HostBvh &tree, uint32_t index, const HostBvh &stackless,
                         uint32_t number, uint32_t pair, std::string *fault) {
    const BvhNode &node = tree.nodes[index];
    if (pair + 2 > stackless.stackless_nodes.size() ||
        stackless.stackless_nodes[number].link != pair) {
        *fault = "the children of node " + std::to_string(number) + " are missing";
        return pair;
    }
    uint32_t next = pair + 2;
    for (uint32_t side = 0; side < 2; ++side) {
        const StacklessNode &child = stackless.stackless_nodes[pair + side];
        const bool is_leaf = (node.child[side] & BVH_LEAF_BIT) != 0;
        if (std::memcmp(child.bounds, node.bounds[side], sizeof child.bounds) != 0 ||
            (is_leaf && child.link != node.child[side])) {
            *fault = "node " + std::to_string(pair + side) + " differs";
        }
        if (!is_leaf) {
            next = compare_subtree(tree, node.child[side], stackless, pair + side, next, fault);
        }
    }
    return next;
}

/// Checks the traversal links of an octant below a node, after which traversal continues at
/// `after`. Counts the visited nodes in `seen`.
void follow(const std::vector<StacklessNode> &nodes, uint32_t number, uint32_t octant,
            uint32_t after, size_t *seen, std::string *fault) {
    const StacklessNode &node = nodes[number];
    *seen += 1;
    if (node.escape[octant] != after) {
        *fault = "node " + std::to_string(number) + " escapes to elsewhere";
    }
    if ((node.link & BVH_LEAF_BIT) == 0) {
        const uint32_t first = node.link + (node.right_first >> octant & 1);
        const uint32_t second = first ^ 1;
        follow(nodes, first, octant, second, seen, fault);
        follow(nodes, second, octant, after, seen, fault);
    }
}

class BvhLinearize : public testing::TestWithParam<Named<BvhMethod>> {};
INSTANTIATE_TEST_SUITE_P(Methods, BvhLinearize, testing::ValuesIn(bvh_methods),
                         [](const auto &test) { return std::string(test.param.name); });

TEST_P(BvhLinearize, HoldsTheTreeByPairs) {
    std::vector<Mesh> meshes = {{"empty", {}, {}}, room(), soup(30000, 1), terrain(100, 2)};
    for (uint32_t count = 1; count < 12; ++count) {
        meshes.push_back(soup(count, count));
    }
    for (const Mesh &mesh : meshes) {
        const HostBvh tree = build_bvh(mesh, {BvhLayout::bvh2, GetParam().value});
        const HostBvh stackless = build_bvh(mesh, {BvhLayout::bvh2_stackless, GetParam().value});
        std::string fault;
        const uint32_t end = compare_subtree(tree, 0, stackless, 0, 2, &fault);
        EXPECT_EQ(fault, "") << mesh.name << ' ' << mesh.triangles.size();
        ASSERT_EQ(stackless.stackless_nodes.size(), end) << mesh.name;
        for (uint32_t octant = 0; octant < 8; ++octant) {
            size_t seen = 0;
            follow(stackless.stackless_nodes, 0, octant, 0, &seen, &fault);
            EXPECT_EQ(fault, "") << mesh.name << ", octant " << octant;
            EXPECT_EQ(seen, end - 1) << mesh.name << ", octant " << octant;
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
