// SPDX-License-Identifier: MIT
// Compares hits with Embree 3 (ROBUST) for 1e6 fuzzed rays per layout: both must hit or miss, with
// |dt| <= 1e-5 of the scale. If they differ, an intersector in double precision decides whether the
// hit is right. A test in traversal_hits_test.cpp compares that intersector with brute force.
#include <gtest/gtest.h>

#include <array>
#include <cstdio>

#include "renderer/testing/double_intersector.h"
#include "renderer/testing/embree_scene.h"
#include "renderer/testing/ray_sets.h"
#include "renderer/testing/tree_test.h"

namespace rtrays {
namespace {

using namespace test;

class TraversalEmbree : public TreeTest {};
EACH_TREE(TraversalEmbree);

/// Number of differences per type of ray: random, grazing, and along an axis through a vertex or an
/// edge (ray_sets.h).
using Differences = std::array<size_t, 3>;

/// Returns the number of rays whose hit differs from Embree's and is wrong in double precision.
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
    EXPECT_GT(hits, count / 10) << mesh.name << ": too few rays hit for a meaningful test";
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
        << "too many differences for rounding errors";
}

}  // namespace
}  // namespace rtrays
