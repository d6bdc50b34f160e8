// SPDX-License-Identifier: MIT
// Compares hits of traversal with brute force in double precision, any hit with nearest hit, and
// the device with the host.
#include <gtest/gtest.h>

#include "renderer/device/kernel.h"
#include "renderer/testing/double_intersector.h"
#include "renderer/testing/ray_sets.h"
#include "renderer/testing/tree_test.h"

namespace rtrays {
namespace {

using namespace test;

class TraversalHits : public TreeTest {};
EACH_TREE(TraversalHits);

std::vector<Mesh> small_meshes() {
    return {room(),
            soup(60, 2),
            sphere(6, 10, 1.0f, 0.1f, {0, 0, 0}),
            sphere(6, 10, 1e-6f, 0.1f, {0, 0, 0}),
            sphere(6, 10, 1e6f, 0.1f, {3e6f, 0, 0}),
            terrain(6, 1)};
}

TEST_P(TraversalHits, AgreeWithBruteForceInDouble) {
    for (const Mesh &mesh : small_meshes()) {
        const HostBvh bvh = build_bvh(mesh, GetParam());
        const double tolerance = 1e-5 * static_cast<double>(mesh.box().diagonal().norm());
        int wrong = 0, hits = 0;
        const size_t count = 30000;
        const DoubleJudge judge(mesh);
        for (const RayRecord &ray : fuzzed_rays(mesh, count, 5)) {
            const Hit hit = bvh.nearest(ray_origin(ray), ray_direction(ray));
            const bool right = hit_is_right(mesh, ray_origin(ray), ray_direction(ray), hit.t,
                                            hit.triangle, tolerance);
            wrong += right ? 0 : 1;
            ASSERT_EQ(
                judge.is_right(ray_origin(ray), ray_direction(ray), hit.t, hit.triangle, tolerance),
                right);
            // Both judges must also agree on a missing hit.
            ASSERT_EQ(
                judge.is_right(ray_origin(ray), ray_direction(ray), INFINITY, NO_HIT, tolerance),
                hit_is_right(mesh, ray_origin(ray), ray_direction(ray), INFINITY, NO_HIT,
                             tolerance));
            hits += hit.triangle != NO_HIT ? 1 : 0;
        }
        EXPECT_EQ(wrong, 0) << mesh.name;
        EXPECT_GT(hits, static_cast<int>(count / 10))
            << mesh.name << ": too few rays hit for a meaningful test";
    }
}

TEST_P(TraversalHits, TheJudgeRejectsWrongHits) {
    const Mesh mesh = room();
    const Eigen::Vector3f origin(450, 400, 200), down(0, -1, 0);
    const Hit hit = build_bvh(mesh, GetParam()).nearest(origin, down);
    const double tolerance = 1e-2;
    EXPECT_TRUE(hit_is_right(mesh, origin, down, hit.t, hit.triangle, tolerance));
    EXPECT_FALSE(hit_is_right(mesh, origin, down, hit.t, NO_HIT, tolerance));
    EXPECT_FALSE(hit_is_right(mesh, origin, down, hit.t * 1.001f, hit.triangle, tolerance));
    EXPECT_FALSE(hit_is_right(mesh, {200, 400, 200}, down, 400, hit.triangle, tolerance))
        << "behind a block";
}

TEST_P(TraversalHits, AnyHitIsNearestHitBelowTheLimit) {
    for (const Mesh &mesh : {room(), soup(5000, 8), terrain(40, 2)}) {
        const HostBvh bvh = build_bvh(mesh, GetParam());
        Random random(3);
        const float size = mesh.box().diagonal().norm();
        int occluded = 0;
        for (const RayRecord &ray : fuzzed_rays(mesh, 60000, 6)) {
            const float t_max = uniform(random, 0, 1.5f * size);
            const bool any = bvh.any(ray_origin(ray), ray_direction(ray), t_max);
            const Hit limited = bvh.nearest(ray_origin(ray), ray_direction(ray), t_max);
            ASSERT_EQ(any, limited.triangle != NO_HIT);
            ASSERT_EQ(any, bvh.nearest(ray_origin(ray), ray_direction(ray)).t < t_max);
            occluded += any ? 1 : 0;
        }
        EXPECT_GT(occluded, 6000) << mesh.name;
    }
}

/// Opacities of the triangles of a mesh: opaque, half, none and textured ones in turn.
struct Opacities {
    std::vector<uint32_t> masks;
    std::vector<MaskedTriangle> masked;
    std::vector<OpacityRecord> records = std::vector<OpacityRecord>(3);
    std::vector<float> texels = {0, 1, 0.5f, 0.25f};

    explicit Opacities(const Mesh &mesh) {
        records[0].opacity = 0.5f;
        records[2].opacity = 1;
        records[2].texture = {0, 2, 2, 0, {1, 1}, {0, 0}};
        for (uint32_t i = 0; i < mesh.triangles.size(); ++i) {
            masks.push_back(i % 4 == 3 ? OPAQUE : static_cast<uint32_t>(masked.size()));
            if (i % 4 != 3) {
                masked.push_back({{{0, 0}, {1, 0}, {0, 1}}, i % 4, 0});
            }
        }
    }

    OpacityTest test(const RayRecord &ray) const {
        return {masks.data(), masked.data(), records.data(), texels.data(),
                hash_of_ray(to_float3(ray_origin(ray)), to_float3(ray_direction(ray)))};
    }
};

/// Returns the nearest hit that stops the ray, found by testing every triangle.
Hit nearest_of_all(const HostBvh &bvh2, const Mesh &mesh, const RayRecord &ray,
                   const OpacityTest &opacity) {
    Hit hit = no_hit(INFINITY);
    const Eigen::AlignedBox3f box = mesh.box();
    TraversalRay prepared;
    if (!make_traversal_ray(to_float3(ray_origin(ray)), to_float3(ray_direction(ray)),
                            to_float3(box.min()), to_float3(box.max()), &prepared)) {
        return hit;
    }
    for (const LeafTriangle &triangle : bvh2.triangles) {
        Hit found = hit;
        if (intersect_triangle(&triangle, &prepared, hit.t, &found) &&
            triangle_stops(&opacity, triangle.id, found.u, found.v)) {
            hit = found;
            hit.triangle = triangle.id;
        }
    }
    return hit;
}

TEST_P(TraversalHits, RaysPassTrianglesThatDoNotStopThem) {
    const Mesh mesh = soup(300, 8);
    const Opacities opacities(mesh);
    const HostBvh bvh = build_bvh(mesh, GetParam()), bvh2 = build_bvh(mesh);
    int passed = 0, hits = 0;
    for (const RayRecord &ray : fuzzed_rays(mesh, 30000, 9)) {
        const OpacityTest opacity = opacities.test(ray);
        const Hit expected = nearest_of_all(bvh2, mesh, ray, opacity);
        bvh.visit([&](const auto *nodes, const auto *triangles) {
            const float3 origin = to_float3(ray_origin(ray));
            const float3 direction = to_float3(ray_direction(ray));
            const Hit hit = trace_nearest(nodes, triangles, origin, direction, INFINITY, opacity);
            EXPECT_EQ(hit.t, expected.t);
            EXPECT_EQ(hit.triangle == NO_HIT, expected.triangle == NO_HIT);
            for (const float t_max : {hit.t, std::nextafter(hit.t, INFINITY)}) {
                EXPECT_EQ(trace_any(nodes, triangles, origin, direction, t_max, opacity),
                          t_max > hit.t);
            }
        });
        passed += expected.t != bvh.nearest(ray_origin(ray), ray_direction(ray)).t ? 1 : 0;
        hits += expected.triangle != NO_HIT ? 1 : 0;
    }
    EXPECT_GT(passed, 3000);
    EXPECT_GT(hits, 3000);
}

TEST_P(TraversalHits, BarycentricsGiveTheHitPoint) {
    const Mesh mesh = soup(5000, 8);
    const HostBvh bvh = build_bvh(mesh, GetParam());
    for (const RayRecord &ray : fuzzed_rays(mesh, 30000, 6)) {
        const Hit hit = bvh.nearest(ray_origin(ray), ray_direction(ray));
        if (hit.triangle == NO_HIT) {
            continue;
        }
        ASSERT_EQ(bvh.triangle_at(hit.slot), hit.triangle);
        ASSERT_TRUE(hit.u >= 0 && hit.v >= 0 && hit.u + hit.v <= 1.000001f);
        const Eigen::Vector3f a = mesh.vertex(hit.triangle, 0);
        const Eigen::Vector3f p = a + hit.u * (mesh.vertex(hit.triangle, 1) - a) +
                                  hit.v * (mesh.vertex(hit.triangle, 2) - a);
        const Eigen::Vector3f along = ray_origin(ray) + hit.t * ray_direction(ray);
        // The hit point on the triangle is off the ray only by rounding, whatever the angle between
        // ray and triangle.
        ASSERT_LT((p - ray_origin(ray)).cross(ray_direction(ray)).norm(),
                  2e-6f * mesh.box().diagonal().norm())
            << along;
    }
}

TEST_P(TraversalHits, DeviceFindsWhatTheHostFinds) {
    DeviceContext &device = test_device();
    const Program program(
        device, {"kernels/traversal/trace_rays.cl"},
        {{"BVH_LAYOUT", std::to_string(static_cast<uint32_t>(GetParam().layout))}});
    for (const Mesh &mesh : {room(), terrain(100, 4)}) {
        const Bvh bvh = build_on_device(mesh, GetParam());
        const HostBvh host(bvh);
        std::vector<RayRecord> rays = fuzzed_rays(mesh, 100001, 7);
        Random random(3);
        for (size_t i = 0; i < rays.size(); i += 2) {
            rays[i].t_max = uniform(random, 0, 1.5f * mesh.box().diagonal().norm());
        }
        const Buffer<RayRecord> ray_buffer(device, "test rays", rays);
        const Buffer<Hit> hit_buffer(device, "test hits", rays.size());
        const Buffer<uint32_t> occluded_buffer(device, "test occlusion", rays.size());
        const auto count = static_cast<uint32_t>(rays.size());
        Kernel nearest(program, "trace_nearest_rays", 64);
        bvh.visit([&](const auto &nodes, const auto &triangles) {
            nearest.bind({nodes, triangles, ray_buffer, count, hit_buffer});
        });
        nearest.enqueue(count);
        Kernel any(program, "trace_any_rays", 64);
        bvh.visit([&](const auto &nodes, const auto &triangles) {
            any.bind({nodes, triangles, ray_buffer, count, occluded_buffer});
        });
        any.enqueue(count);
        device.finish();
        const std::vector<Hit> hits = hit_buffer.read();
        const std::vector<uint32_t> occluded = occluded_buffer.read();
        for (size_t i = 0; i < rays.size(); ++i) {
            const Hit expected =
                host.nearest(ray_origin(rays[i]), ray_direction(rays[i]), rays[i].t_max);
            ASSERT_EQ(hits[i].triangle, expected.triangle) << i;
            ASSERT_EQ(hits[i].t, expected.t) << i;
            ASSERT_EQ(hits[i].u, expected.u) << i;
            ASSERT_EQ(hits[i].v, expected.v) << i;
            ASSERT_EQ(hits[i].slot, expected.slot) << i;
            ASSERT_EQ(occluded[i] != 0, expected.triangle != NO_HIT) << i;
        }
    }
}

}  // namespace
}  // namespace rtrays
