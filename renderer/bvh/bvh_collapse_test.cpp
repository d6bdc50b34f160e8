// SPDX-License-Identifier: MIT
// Tests the eight-wide layout: it is a valid tree over the triangles of its two-wide source tree.
#include <gtest/gtest.h>

#include <cstring>

#include "renderer/testing/bvh_tree.h"

namespace rtrays {
namespace {

using namespace test;

/// Results of a walk over the nodes. `fault` is empty for a valid tree.
struct WideFacts {
    std::string fault;
    size_t nodes = 1, leaves = 0;  // node 0 is not part of the tree
    uint32_t depth = 0;
};

WideFacts inspect_wide(const HostBvh &bvh, const Mesh &mesh) {
    WideFacts facts;
    std::vector<uint32_t> seen(mesh.triangles.size(), 0);
    const auto fail = [&](const std::string &what) {
        facts.fault = facts.fault.empty() ? what : facts.fault;
    };
    const auto box_of = [](const WideNode &node, uint32_t lane) {
        return Eigen::AlignedBox3f(Eigen::Vector3f(node.bounds[0][0][lane], node.bounds[0][1][lane],
                                                   node.bounds[0][2][lane]),
                                   Eigen::Vector3f(node.bounds[1][0][lane], node.bounds[1][1][lane],
                                                   node.bounds[1][2][lane]));
    };
    const auto visit_leaf = [&](uint32_t link) {
        Eigen::AlignedBox3f content;
        const uint32_t index = wide_leaf_block(link), count = wide_leaf_count(link);
        facts.leaves += 1;
        if (index >= bvh.blocks.size()) {
            fail("leaf out of range");
            return content;
        }
        const TriangleBlock &block = bvh.blocks[index];
        for (uint32_t lane = 0; lane < WIDE_LANES; ++lane) {
            const uint32_t source = lane < count ? lane : 0;
            seen[block.id[lane]] += lane < count ? 1 : 0;
            for (uint32_t corner = 0; corner < 3; ++corner) {
                const Eigen::Vector3f p(block.coordinate[0][corner][lane],
                                        block.coordinate[1][corner][lane],
                                        block.coordinate[2][corner][lane]);
                if (p != mesh.vertex(block.id[source], corner)) {
                    fail("vertex differs from the mesh's");
                }
                content.extend(p);
            }
        }
        return content;
    };
    const auto visit = [&](auto &&self, uint32_t index, uint32_t depth) -> Eigen::AlignedBox3f {
        Eigen::AlignedBox3f all;
        facts.nodes += 1;
        if (index == 0 || index >= bvh.wide_nodes.size() || facts.nodes > bvh.wide_nodes.size()) {
            fail("link out of range or cycle");
            return all;
        }
        facts.depth = std::max(facts.depth, depth);
        uint32_t children = 0, inner = 0;
        for (uint32_t lane = 0; lane < WIDE_LANES; ++lane) {
            const Eigen::AlignedBox3f box = box_of(bvh.wide_nodes[index], lane);
            if (box.isEmpty()) {
                continue;
            }
            const uint32_t link = bvh.wide_nodes[index].child[lane];
            const bool is_leaf = (link & BVH_LEAF_BIT) != 0;
            children += 1;
            inner += is_leaf ? 0 : 1;
            const Eigen::AlignedBox3f content =
                is_leaf ? visit_leaf(link) : self(self, link, depth + 1);
            if (!box.contains(content) || !content.contains(box)) {
                fail("box is not the bound of its content");
            }
            all.extend(box);
        }
        if (children < 2 || (children < WIDE_LANES && inner > 0)) {
            fail("a node could have had more children");
        }
        return all;
    };
    const WideNode &head = bvh.wide_nodes.at(0);
    if (!box_of(head, 0).isEmpty()) {
        const uint32_t root = head.child[0];
        const Eigen::AlignedBox3f content =
            (root & BVH_LEAF_BIT) != 0 ? visit_leaf(root) : visit(visit, root, 0);
        if (!content.isApprox(box_of(head, 0), 0.0f)) {
            fail("node 0 does not hold the scene's box");
        }
    }
    const auto all_seen = static_cast<uint32_t>(std::count(seen.begin(), seen.end(), 1u));
    if (all_seen != bvh.report.triangles ||
        all_seen + bvh.report.rejected() != mesh.triangles.size()) {
        fail("a triangle is not in exactly one leaf");
    }
    if (facts.nodes != bvh.wide_nodes.size() || facts.leaves != bvh.blocks.size()) {
        fail("unreachable nodes or leaves");
    }
    return facts;
}

/// Returns whether nodes and leaves are numbered in order of their references, node by node and
/// lane by lane. The root is node 1.
bool is_numbered_by_level(const HostBvh &bvh) {
    uint32_t node = 1, leaf = 0;
    for (const WideNode &wide : bvh.wide_nodes) {
        for (uint32_t lane = 0;
             lane < WIDE_LANES && wide.bounds[0][0][lane] <= wide.bounds[1][0][lane]; ++lane) {
            const uint32_t link = wide.child[lane];
            const bool is_leaf = (link & BVH_LEAF_BIT) != 0;
            if (is_leaf ? wide_leaf_block(link) != leaf++ : link != node++) {
                return false;
            }
        }
    }
    return true;
}

WideFacts expect_valid(const HostBvh &bvh, const Mesh &mesh) {
    const WideFacts facts = inspect_wide(bvh, mesh);
    EXPECT_EQ(facts.fault, "") << mesh.name << ' ' << mesh.triangles.size();
    EXPECT_TRUE(is_numbered_by_level(bvh)) << mesh.name << ' ' << mesh.triangles.size();
    EXPECT_EQ(facts.nodes, bvh.report.wide_nodes);
    EXPECT_EQ(facts.leaves, bvh.report.wide_leaves);
    EXPECT_EQ(bvh.report.bytes,
              facts.nodes * sizeof(WideNode) + facts.leaves * sizeof(TriangleBlock));
    return facts;
}

class BvhCollapse : public testing::TestWithParam<Named<BvhMethod>> {
  protected:
    static TreeKind kind() { return {BvhLayout::wide8, GetParam().value}; }
};
INSTANTIATE_TEST_SUITE_P(Methods, BvhCollapse, testing::ValuesIn(bvh_methods),
                         [](const auto &test) { return std::string(test.param.name); });

TEST_P(BvhCollapse, TreeIsValidOfEverySize) {
    expect_valid(build_bvh({"empty", {}, {}}, kind()), {"empty", {}, {}});
    for (uint32_t count = 1; count < 40; ++count) {
        const Mesh mesh = soup(count, count);
        expect_valid(build_bvh(mesh, kind()), mesh);
    }
    for (const Mesh &mesh :
         {room(), soup(30000, 1), terrain(100, 2), sphere(80, 160, 1.0f, 0.05f, {0, 0, 0})}) {
        const HostBvh bvh = build_bvh(mesh, kind());
        const WideFacts facts = expect_valid(bvh, mesh);
        const double fill =
            static_cast<double>(bvh.report.triangles) / static_cast<double>(facts.leaves);
        RecordProperty("triangles_per_leaf_" + mesh.name, std::to_string(fill));
        if (mesh.triangles.size() > 1000) {  // smaller meshes have too few leaves
            EXPECT_GT(fill, 4) << mesh.name << ": more than half of the lanes must be used";
        }
    }
}

TEST_P(BvhCollapse, DegenerateInputEnds) {
    Mesh coincident{"coincident", {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}, {}};
    coincident.triangles.assign(100000, {0, 1, 2});
    expect_valid(build_bvh(coincident, kind()), coincident);

    Mesh faulty = soup(3000, 3);
    faulty.positions[3 * 7].x() = NAN;
    faulty.positions[3 * 100] = faulty.positions[3 * 100 + 1];
    const HostBvh bvh = build_bvh(faulty, kind());
    EXPECT_EQ(bvh.report.rejected(), 2u);
    expect_valid(bvh, faulty);

    // Each split separates one triangle from the rest, which gives the deepest possible tree with
    // leaves of single triangles.
    Mesh peeled{"peeled", {}, {}};
    for (int axis = 0; axis < 3; ++axis) {
        float distance = 1e11f;
        for (int i = 0; i < 31; ++i, distance /= 20) {
            const Eigen::Vector3f p = distance * Eigen::Vector3f::Unit(axis);
            const float size = 1e-3f * distance;
            peeled.add_triangle(p, p + size * Eigen::Vector3f(1, 2, 3),
                                p + size * Eigen::Vector3f(3, 1, 2));
        }
    }
    const HostBvh deep = build_bvh(peeled, kind());
    const WideFacts facts = expect_valid(deep, peeled);
    EXPECT_LT(facts.depth * (WIDE_LANES - 1), WIDE_STACK_SIZE);
    EXPECT_NE(deep.nearest(peeled.vertex(40, 0) - Eigen::Vector3f(0, 0, 1), {0, 0, 1}).triangle,
              NO_HIT);
}

TEST_P(BvhCollapse, BitsDoNotDependOnTheDistributionOfWork) {
    const Mesh mesh = terrain(80, 5);
    const auto build = [&](uint32_t group_size) {
        return HostBvh(
            BvhBuilder(test_device(), {group_size, 1024, 256, BvhLayout::wide8, GetParam().value})
                .build(mesh.positions, mesh.triangles));
    };
    const HostBvh expected = build(1), other = build(64);
    ASSERT_EQ(other.wide_nodes.size(), expected.wide_nodes.size());
    ASSERT_EQ(other.blocks.size(), expected.blocks.size());
    EXPECT_EQ(std::memcmp(other.wide_nodes.data(), expected.wide_nodes.data(),
                          expected.wide_nodes.size() * sizeof(WideNode)),
              0);
    EXPECT_EQ(std::memcmp(other.blocks.data(), expected.blocks.data(),
                          expected.blocks.size() * sizeof(TriangleBlock)),
              0);
}

}  // namespace
}  // namespace rtrays
