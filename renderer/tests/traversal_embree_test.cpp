// SPDX-License-Identifier: MIT
// Hits against Embree 3 (ROBUST), 1e6 fuzzed rays for each layout: same hit or miss, |dt| <= 1e-5
// of the scale. Where they differ, double precision decides whether ours is right: a judge held to
// brute force in traversal_hits_test.cpp.
#include <gtest/gtest.h>

#include <array>
#include <cstdio>

#include "renderer/tests/double_intersector.h"
#include "renderer/tests/embree_scene.h"
#include "renderer/tests/ray_sets.h"
#include "renderer/tests/tree_test.h"

namespace rtrays {
namespace {

using namespace test;

class TraversalEmbree : public TreeTest {};
EACH_TREE(TraversalEmbree);

/// Differences by kind of ray: random, grazing, and along an axis through a vertex or an edge
/// (ray_sets.h).
using Differences = std::array<size_t, 3>;

/// Rays on which ours differs from Embree and double precision does not side with ours.
size_t count_wrong(const Mesh &mesh, TreeKind kind, size_t count, Differences *differences) {
    const HostBvh bvh = build_bvh(mesh, kind);
    const EmbreeScene embree(mesh);
    const DoubleJudge judge(mesh);
    const float tolerance = 1e-5f * mesh.box().diagonal().norm();
    const std::vector<RayRecord> rays = fuzzed_rays(mesh, count, 13);
    size_t wrong = 0, hits = 0;
    for (size_t i = 0; i < rays.size(); ++i) {
        const RayRecord &ray = rays[i];
        const Hit ours = bvh.nearest(ray_origin(ray), ray_direction(ray));
        const float theirs = embree.nearest(ray);
        hits += ours.triangle != NO_HIT ? 1 : 0;
        if ((ours.t == INFINITY && theirs == INFINITY) || std::abs(ours.t - theirs) <= tolerance) {
            continue;
        }
        (*differences)[i % 3] += 1;
        wrong += judge.is_right(ray_origin(ray), ray_direction(ray), ours.t, ours.triangle,
                                static_cast<double>(tolerance))
                     ? 0
                     : 1;
    }
    EXPECT_GT(hits, count / 10) << mesh.name << ": rays must hit something to mean anything";
    return wrong;
}

TEST_P(TraversalEmbree, FuzzedRaysAgree) {
    constexpr size_t rays_of_each = 250000;
    size_t wrong = 0, rays = 0;
    Differences differences{};
    for (const Mesh &mesh :
         {room(), soup(3000, 1), sphere(100, 200, 1.0f, 0.01f, {0, 0, 0}), terrain(120, 2)}) {
        wrong += count_wrong(mesh, GetParam(), rays_of_each, &differences);
        rays += rays_of_each;
    }
    std::printf(
        "of %zu rays %zu random, %zu grazing, %zu tied ones differ from Embree; %zu of them wrong "
        "in "
        "double\n",
        rays, differences[0], differences[1], differences[2], wrong);
    EXPECT_EQ(wrong, 0u);
    EXPECT_LE(static_cast<double>(differences[0]), 1e-4 * static_cast<double>(rays))
        << "too many to be rounding";
}

}  // namespace
}  // namespace rtrays
