// SPDX-License-Identifier: MIT
// Tests every builder and layout with difficult input. Builds must end in bounded time and memory
// and count excluded triangles, and rays must find hits that are right in double precision.
#include <chrono>
#include <limits>

#include "renderer/testing/double_intersector.h"
#include "renderer/testing/ray_sets.h"
#include "renderer/testing/tree_test.h"

namespace rtrays {
namespace {

using namespace test;

constexpr float nan = std::numeric_limits<float>::quiet_NaN();
constexpr float infinity = std::numeric_limits<float>::infinity();

class BvhRobustness : public TreeTest {};
EACH_TREE(BvhRobustness);

/// Builds a tree of the mesh, checks the numbers of triangles that cannot be hit, and checks the
/// bounds of time and memory.
HostBvh expect_built(const Mesh &mesh, TreeKind kind, uint32_t not_finite, uint32_t degenerate) {
    const auto start = std::chrono::steady_clock::now();
    const HostBvh tree(build_on_device(mesh, kind));
    const double seconds =
        std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
    const uint64_t count = mesh.triangles.size(), input = 12 * (mesh.positions.size() + count);
    EXPECT_LT(seconds, 20 + 2e-5 * static_cast<double>(count))
        << mesh.name << ": takes milliseconds apart from compilation and other load";
    EXPECT_LE(tree.report.bytes_peak, input + bvh_peak_bytes + bvh_peak_bytes_per_triangle * count)
        << mesh.name;
    EXPECT_EQ(tree.report.not_finite, not_finite) << mesh.name;
    EXPECT_EQ(tree.report.degenerate, degenerate) << mesh.name;
    EXPECT_EQ(tree.report.triangles + not_finite + degenerate, count) << mesh.name;
    EXPECT_LE(tree.report.depth, 62u) << mesh.name;
    return tree;
}

/// Traces rays at the mesh. All hits must be right, and at least one ray in a hundred must hit.
void expect_right_hits(const HostBvh &tree, const Mesh &mesh, size_t count) {
    const double tolerance = 1e-5 * static_cast<double>(mesh.box().diagonal().norm());
    size_t wrong = 0, hits = 0;
    for (const RayRecord &ray : fuzzed_rays(mesh, count, 5)) {
        const Hit hit = tree.nearest(ray_origin(ray), ray_direction(ray));
        wrong +=
            hit_is_right(mesh, ray_origin(ray), ray_direction(ray), hit.t, hit.triangle, tolerance)
                ? 0
                : 1;
        hits += hit.triangle != NO_HIT ? 1 : 0;
    }
    EXPECT_EQ(wrong, 0u) << mesh.name;
    EXPECT_GE(hits, count / 100) << mesh.name << ": too few rays hit for a meaningful test";
}

TEST_P(BvhRobustness, NothingAndAlmostNothing) {
    const HostBvh nothing = expect_built({"empty", {}, {}}, GetParam(), 0, 0);
    EXPECT_EQ(nothing.nearest({0, 0, 0}, {0, 0, 1}).triangle, NO_HIT);
    for (uint32_t count = 1; count < 34; ++count) {
        const Mesh mesh = soup(count, count);
        expect_right_hits(expect_built(mesh, GetParam(), 0, 0), mesh, 300);
    }
}

TEST_P(BvhRobustness, AMillionIdenticalTriangles) {
    Mesh mesh{"coincident", {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}, {}};
    mesh.triangles.assign(1000000, {0, 1, 2});
    const HostBvh tree = expect_built(mesh, GetParam(), 0, 0);
    EXPECT_FLOAT_EQ(tree.nearest({0.2f, 0.2f, 1}, {0, 0, -1}).t, 1.0f);
    EXPECT_EQ(tree.nearest({0.8f, 0.8f, 1}, {0, 0, -1}).triangle, NO_HIT);
}

TEST_P(BvhRobustness, EqualCentroids) {
    Mesh mesh{"equal centroids", {}, {}};
    for (int i = 1; i <= 3000; ++i) {
        const auto r = static_cast<float>(i);
        mesh.add_triangle({-r, -r, r}, {r, -r, -r}, {0, r, 0});
    }
    expect_right_hits(expect_built(mesh, GetParam(), 0, 0), mesh, 200);
}

TEST_P(BvhRobustness, EqualCodes) {
    // All triangles but the first are in one cell of any grid of floats over the scene.
    Mesh mesh = soup(3000, 4);
    mesh.name = "equal codes";
    for (Eigen::Vector3f &p : mesh.positions) {
        p *= 1e-6f;
    }
    mesh.add_triangle({100, 100, 100}, {101, 100, 100}, {100, 101, 100});
    expect_built(mesh, GetParam(), 0, 0);
    Mesh dense = mesh;
    dense.triangles.pop_back();
    dense.positions.resize(9000);
    const HostBvh tree(build_on_device(mesh, GetParam()));
    size_t hits = 0;
    for (const RayRecord &ray : fuzzed_rays(dense, 300, 5)) {
        const Hit hit = tree.nearest(ray_origin(ray), ray_direction(ray));
        EXPECT_TRUE(
            hit_is_right(mesh, ray_origin(ray), ray_direction(ray), hit.t, hit.triangle, 1e-9));
        hits += hit.triangle != NO_HIT ? 1 : 0;
    }
    EXPECT_GT(hits, 30u);
}

TEST_P(BvhRobustness, Slivers) {
    Random random(7);
    Mesh mesh{"slivers", {}, {}};
    for (int i = 0; i < 3000; ++i) {
        const Eigen::Vector3f a(uniform(random), uniform(random), uniform(random));
        const Eigen::Vector3f b = a + uniform_direction(random);
        mesh.add_triangle(a, b, a + uniform(random) * (b - a) + 1e-4f * uniform_direction(random));
    }
    const HostBvh tree = expect_built(mesh, GetParam(), 0, 0);
    const double tolerance = 1e-5 * static_cast<double>(mesh.box().diagonal().norm());
    size_t hits = 0;
    for (uint32_t i = 0; i < 300; ++i) {  // rays at their centres, because others miss
        const Eigen::Vector3f middle =
            (mesh.vertex(i, 0) + mesh.vertex(i, 1) + mesh.vertex(i, 2)) / 3;
        const Eigen::Vector3f origin = middle + uniform_direction(random);
        const Hit hit = tree.nearest(origin, middle - origin);
        EXPECT_TRUE(hit_is_right(mesh, origin, middle - origin, hit.t, hit.triangle, tolerance))
            << i;
        hits += hit.triangle != NO_HIT ? 1 : 0;
    }
    EXPECT_GT(hits, 150u);
}

TEST_P(BvhRobustness, ZeroAreas) {
    Mesh mesh{"zero areas", {}, {}};
    for (int i = 0; i < 5000; ++i) {
        const Eigen::Vector3f p(static_cast<float>(i % 17), static_cast<float>(i % 5),
                                static_cast<float>(i % 3));
        mesh.add_triangle(p, p, p + Eigen::Vector3f(static_cast<float>(i % 2), 0, 0));
    }
    const HostBvh none = expect_built(mesh, GetParam(), 0, 5000);
    EXPECT_EQ(none.nearest({0, 0, 9}, {0, 0, -1}).triangle, NO_HIT);
    mesh.add_triangle({0, 0, 0}, {16, 0, 0}, {0, 4, 0});
    EXPECT_EQ(expect_built(mesh, GetParam(), 0, 5000).nearest({1, 1, 9}, {0, 0, -1}).triangle,
              5000u);
}

TEST_P(BvhRobustness, NumbersThatAreNone) {
    Mesh mesh = soup(3000, 3);
    const Mesh whole = mesh;
    for (uint32_t i = 0; i < 3000; i += 10) {
        mesh.positions[3 * i + i % 3][static_cast<int>(i / 10 % 3)] = i % 20 == 0    ? nan
                                                                      : i % 40 == 10 ? infinity
                                                                                     : -1e30f;
    }
    const HostBvh tree = expect_built(mesh, GetParam(), 300, 0);
    size_t hits = 0;
    for (const RayRecord &ray : fuzzed_rays(whole, 3000, 5)) {
        const Hit hit = tree.nearest(ray_origin(ray), ray_direction(ray));
        EXPECT_TRUE(hit.triangle == NO_HIT || hit.triangle % 10 != 0);
        hits += hit.triangle != NO_HIT ? 1 : 0;
    }
    EXPECT_GT(hits, 30u);
}

TEST_P(BvhRobustness, FarAway) {
    Mesh mesh = sphere(30, 60, 1000.0f, 0.05f, {1e6f, -1e6f, 1e6f});
    expect_right_hits(expect_built(mesh, GetParam(), 0, 0), mesh, 300);
    mesh = sphere(30, 60, 1e6f, 0.05f, {1e6f, 0, 0});
    expect_right_hits(expect_built(mesh, GetParam(), 0, 0), mesh, 300);
}

TEST_P(BvhRobustness, OrdinaryMeshesTakeHalfOfTheMemory) {
    // GPUs have smaller subtrees and reserve memory for more of them.
    const double share = test_device().info().is_cpu ? 0.5 : 0.75;
    for (const Mesh &mesh :
         {soup(50000, 1), sphere(150, 160, 1.0f, 0.01f, {0, 0, 0}), terrain(150, 2)}) {
        const HostBvh tree = expect_built(mesh, GetParam(), 0, 0);
        const double per_triangle = static_cast<double>(tree.report.bytes_peak) /
                                    static_cast<double>(tree.report.triangles);
        RecordProperty("bytes_per_triangle_" + mesh.name, std::to_string(per_triangle));
        EXPECT_LT(per_triangle, share * bvh_peak_bytes_per_triangle) << mesh.name;
    }
}

}  // namespace
}  // namespace rtrays
