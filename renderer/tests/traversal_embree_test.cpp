// SPDX-License-Identifier: MIT
// Hits against Embree 3 (ROBUST), 1e6 fuzzed rays in all: same hit or miss, |dt| <= 1e-5 of the scale. Where
// they differ, brute force in double decides whether ours is right.
#include <embree3/rtcore.h>
#include <gtest/gtest.h>

#include <array>
#include <cstdio>

#include "renderer/tests/bvh_tree.h"
#include "renderer/tests/double_intersector.h"
#include "renderer/tests/ray_sets.h"

namespace rtrays {
namespace {

using namespace test;

class EmbreeScene {
  public:
    explicit EmbreeScene(const Mesh &mesh)
        : device_(rtcNewDevice("threads=1")), scene_(rtcNewScene(device_)) {
        rtcSetSceneFlags(scene_, RTC_SCENE_FLAG_ROBUST);
        const RTCGeometry geometry = rtcNewGeometry(device_, RTC_GEOMETRY_TYPE_TRIANGLE);
        auto *positions = static_cast<float *>(rtcSetNewGeometryBuffer(geometry, RTC_BUFFER_TYPE_VERTEX, 0,
                                                                       RTC_FORMAT_FLOAT3, 3 * sizeof(float),
                                                                       mesh.positions.size()));
        for (size_t i = 0; i < mesh.positions.size(); ++i) {
            std::copy_n(mesh.positions[i].data(), 3, positions + 3 * i);
        }
        auto *indices = static_cast<uint32_t *>(
            rtcSetNewGeometryBuffer(geometry, RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT3,
                                    3 * sizeof(uint32_t), mesh.triangles.size()));
        for (size_t i = 0; i < mesh.triangles.size(); ++i) {
            std::copy_n(mesh.triangles[i].data(), 3, indices + 3 * i);
        }
        rtcCommitGeometry(geometry);
        rtcAttachGeometry(scene_, geometry);
        rtcReleaseGeometry(geometry);
        rtcCommitScene(scene_);
    }
    ~EmbreeScene() {
        rtcReleaseScene(scene_);
        rtcReleaseDevice(device_);
    }
    EmbreeScene(const EmbreeScene &) = delete;
    EmbreeScene &operator=(const EmbreeScene &) = delete;

    /// Distance of the nearest hit, infinite for none.
    float nearest(const RayRecord &ray) const {
        RTCIntersectContext context;
        rtcInitIntersectContext(&context);
        RTCRayHit hit{};
        hit.ray = {ray.origin[0],
                   ray.origin[1],
                   ray.origin[2],
                   0,
                   ray.direction[0],
                   ray.direction[1],
                   ray.direction[2],
                   0,
                   INFINITY,
                   ~0u,
                   0,
                   0};
        hit.hit.geomID = RTC_INVALID_GEOMETRY_ID;
        hit.hit.instID[0] = RTC_INVALID_GEOMETRY_ID;
        rtcIntersect1(scene_, &context, &hit);
        return hit.hit.geomID == RTC_INVALID_GEOMETRY_ID ? INFINITY : hit.ray.tfar;
    }

  private:
    RTCDevice device_;
    RTCScene scene_;
};

/// Differences by kind of ray: random, grazing, and along an axis through a vertex or an edge (ray_sets.h).
using Differences = std::array<size_t, 3>;

/// Rays on which ours differs from Embree and double precision does not side with ours.
size_t count_wrong(const Mesh &mesh, size_t count, Differences *differences) {
    const HostBvh bvh = build_bvh(mesh);
    const EmbreeScene embree(mesh);
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
        wrong += hit_is_right(mesh, ray_origin(ray), ray_direction(ray), ours.t, ours.triangle,
                              static_cast<double>(tolerance))
                     ? 0
                     : 1;
    }
    EXPECT_GT(hits, count / 10) << mesh.name << ": rays must hit something to mean anything";
    return wrong;
}

TEST(TraversalEmbree, FuzzedRaysAgree) {
    constexpr size_t rays_of_each = 250000;
    size_t wrong = 0, rays = 0;
    Differences differences{};
    for (const Mesh &mesh :
         {room(), soup(3000, 1), sphere(100, 200, 1.0f, 0.01f, {0, 0, 0}), terrain(120, 2)}) {
        wrong += count_wrong(mesh, rays_of_each, &differences);
        rays += rays_of_each;
    }
    std::printf(
        "of %zu rays %zu random, %zu grazing, %zu tied ones differ from Embree; %zu of them wrong in "
        "double\n",
        rays, differences[0], differences[1], differences[2], wrong);
    EXPECT_EQ(wrong, 0u);
    EXPECT_LE(static_cast<double>(differences[0]), 1e-4 * static_cast<double>(rays))
        << "too many to be rounding";
}

}  // namespace
}  // namespace rtrays
