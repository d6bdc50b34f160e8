// SPDX-License-Identifier: MIT
// Tests refitting: bounds are exact, and hits agree with Embree, however far triangles have moved.
#include <embree3/rtcore.h>

#include <cstring>

#include "renderer/bvh/refit.h"
#include "renderer/testing/double_intersector.h"
#include "renderer/testing/embree_scene.h"
#include "renderer/testing/errors.h"
#include "renderer/testing/ray_sets.h"
#include "renderer/testing/tree_test.h"

namespace rtrays {
namespace {

using namespace test;

class BvhRefit : public TreeTest {};
EACH_TREE(BvhRefit);

/// Returns the mesh twisted about the vertical axis through the centre of its box, by `turns` from
/// bottom to top.
Mesh twisted(Mesh mesh, float turns) {
    const Eigen::AlignedBox3f box = mesh.box();
    for (Eigen::Vector3f &p : mesh.positions) {
        const float height = (p.y() - box.min().y()) / std::max(box.sizes().y(), 1e-20f);
        const Eigen::AngleAxisf turn(6.2831853f * turns * height, Eigen::Vector3f::UnitY());
        p = box.center() + turn * (p - box.center());
    }
    return mesh;
}

/// Refits `bvh`, which was built for a mesh with the same triangles, to this mesh. Returns whether
/// that succeeded.
bool refit(Bvh &bvh, const Mesh &mesh) {
    const BvhInput input(test_device(), mesh.positions, mesh.triangles);
    return BvhRefitter(test_device(), bvh).refit(bvh, input.positions, input.indices);
}

template <typename Record>
bool same_bytes(const std::vector<Record> &a, const std::vector<Record> &b) {
    return a.size() == b.size() &&
           (a.empty() || std::memcmp(a.data(), b.data(), a.size() * sizeof(Record)) == 0);
}

bool same_tree(const HostBvh &a, const HostBvh &b) {
    return same_bytes(a.nodes, b.nodes) && same_bytes(a.triangles, b.triangles) &&
           same_bytes(a.stackless_nodes, b.stackless_nodes) &&
           same_bytes(a.wide_nodes, b.wide_nodes) && same_bytes(a.blocks, b.blocks);
}

std::vector<Mesh> meshes() {
    return {soup(3000, 1),  sphere(60, 120, 1.0f, 0.01f, {0, 0, 0}),
            terrain(70, 2), room(),
            soup(1, 1),     soup(6, 1)};
}

TEST_P(BvhRefit, ThereAndBackIsTheSameTree) {
    for (const Mesh &mesh : meshes()) {
        Bvh bvh = build_on_device(mesh, GetParam());
        const HostBvh built(bvh);
        const Mesh moved = twisted(mesh, 2);
        EXPECT_TRUE(refit(bvh, mesh)) << mesh.name;
        EXPECT_TRUE(same_tree(HostBvh(bvh), built))
            << mesh.name << ": the tree of an unchanged mesh must not change";
        EXPECT_TRUE(refit(bvh, moved)) << mesh.name;
        EXPECT_FALSE(same_tree(HostBvh(bvh), built)) << mesh.name;
        EXPECT_TRUE(refit(bvh, mesh)) << mesh.name;
        EXPECT_TRUE(same_tree(HostBvh(bvh), built)) << mesh.name;
    }
}

TEST_P(BvhRefit, BoundsAreExact) {
    for (const Mesh &mesh : meshes()) {
        Bvh bvh = build_on_device(mesh, GetParam());
        const Mesh moved = twisted(mesh, 2);
        refit(bvh, moved);
        const HostBvh tree(bvh);
        if (GetParam().layout == BvhLayout::bvh2) {
            EXPECT_EQ(inspect_tree(tree, moved).fault, "") << mesh.name;
        }
        // For the other layouts, check the bounds of the scene. The hits below test the inner
        // boxes.
        const Eigen::AlignedBox3f box = moved.box();
        for (int axis = 0; axis < 3; ++axis) {
            const float lower =
                tree.layout == BvhLayout::wide8 ? tree.wide_nodes[0].bounds[0][axis][0]
                : tree.layout == BvhLayout::bvh2_stackless
                    ? tree.stackless_nodes[0].bounds[0][axis]
                    : std::min(tree.nodes[0].bounds[0][0][axis], tree.nodes[0].bounds[1][0][axis]);
            EXPECT_EQ(lower, box.min()[axis]) << mesh.name;
        }
    }
}

TEST_P(BvhRefit, HitsEqualThoseOfEmbree) {
    for (const Mesh &mesh :
         {soup(3000, 1), sphere(60, 120, 1.0f, 0.01f, {0, 0, 0}), terrain(70, 2)}) {
        Bvh bvh = build_on_device(mesh, GetParam());
        const Mesh moved = twisted(mesh, 2);
        ASSERT_TRUE(refit(bvh, moved));
        const HostBvh tree(bvh);
        const EmbreeScene embree(moved);
        const DoubleJudge judge(moved);
        const float tolerance = 1e-5f * moved.box().diagonal().norm();
        size_t wrong = 0, hits = 0;
        const std::vector<RayRecord> rays = fuzzed_rays(moved, 30000, 17);
        for (const RayRecord &ray : rays) {
            const Hit ours = tree.nearest(ray_origin(ray), ray_direction(ray));
            const float theirs = embree.nearest(ray);
            hits += ours.triangle != NO_HIT ? 1 : 0;
            const bool same = (ours.t == INFINITY && theirs == INFINITY) ||
                              std::abs(ours.t - theirs) <= tolerance;
            wrong += same || judge.is_right(ray_origin(ray), ray_direction(ray), ours.t,
                                            ours.triangle, static_cast<double>(tolerance))
                         ? 0
                         : 1;
        }
        EXPECT_EQ(wrong, 0u) << mesh.name;
        EXPECT_GT(hits, rays.size() / 10)
            << mesh.name << ": too few rays hit for a meaningful test";
    }
}

TEST_P(BvhRefit, BitsDoNotDependOnTheDistributionOfWork) {
    const Mesh mesh = terrain(60, 5), moved = twisted(mesh, 1);
    const auto refitted = [&](uint32_t group_size) {
        Bvh bvh =
            BvhBuilder(test_device(), {group_size, 1024, 256, GetParam().layout, GetParam().method})
                .build(mesh.positions, mesh.triangles);
        const BvhInput input(test_device(), moved.positions, moved.triangles);
        BvhRefitter(test_device(), bvh, group_size).refit(bvh, input.positions, input.indices);
        return HostBvh(bvh);
    };
    EXPECT_TRUE(same_tree(refitted(1), refitted(64)));
}

TEST_P(BvhRefit, TrianglesThatCannotBeHitGoAndComeBack) {
    const Mesh mesh = soup(3000, 3);
    Mesh faulty = mesh;
    faulty.positions[3 * 7].x() = NAN;
    faulty.positions[3 * 500 + 1].y() = INFINITY;
    faulty.positions[3 * 100] = faulty.positions[3 * 100 + 1];

    Bvh bvh = build_on_device(mesh, GetParam());
    EXPECT_TRUE(refit(bvh, faulty));
    EXPECT_EQ(bvh.report().not_finite, 2u);
    EXPECT_EQ(bvh.report().degenerate, 1u);
    const HostBvh tree(bvh);
    const Eigen::Vector3f above(0.5f, 0.5f, 3);
    for (uint32_t triangle = 0; triangle < 3000; ++triangle) {
        const Eigen::Vector3f middle =
            (mesh.vertex(triangle, 0) + mesh.vertex(triangle, 1) + mesh.vertex(triangle, 2)) / 3;
        const uint32_t found = tree.nearest(above, middle - above).triangle;
        EXPECT_TRUE(found != 7 && found != 500 && found != 100);
    }
    EXPECT_TRUE(refit(bvh, mesh));
    EXPECT_EQ(bvh.report().rejected(), 0u);
    EXPECT_TRUE(same_tree(HostBvh(bvh), build_bvh(mesh, GetParam())));

    Bvh without = build_on_device(faulty, GetParam());
    EXPECT_TRUE(refit(without, faulty));
    EXPECT_FALSE(refit(without, mesh)) << "excluded triangles that become valid require a rebuild";
}

TEST_P(BvhRefit, OtherInputIsAnError) {
    const Mesh mesh = soup(100, 1), larger = soup(101, 1);
    Bvh bvh = build_on_device(mesh, GetParam());
    expect_input_error("built from 100 triangles; expected 3 vertex indices for each, got 303",
                       [&] { refit(bvh, larger); });
    Mesh cut = mesh;
    cut.positions.pop_back();
    expect_input_error("1 triangles refer to a vertex that does not exist; there are 299 vertices",
                       [&] { refit(bvh, cut); });
    Bvh nothing = build_on_device({"empty", {}, {}}, GetParam());
    EXPECT_TRUE(refit(nothing, {"empty", {}, {}}));
    EXPECT_EQ(HostBvh(nothing).nearest({0, 0, 0}, {0, 0, 1}).triangle, NO_HIT);
}

}  // namespace
}  // namespace rtrays
