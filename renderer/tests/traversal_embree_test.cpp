// SPDX-License-Identifier: MIT
// Hits against Embree 3 (ROBUST), 1e6 fuzzed rays in all: same hit or miss, |dt| <= 1e-5 of the scale. Where
// they differ, brute force in double decides whether ours is right; at most 1e-6 of the rays may be wrong.
#include <embree3/rtcore.h>
#include <gtest/gtest.h>

#include <cstdlib>
#include <filesystem>
#include <fstream>

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
    size_t wrong = 0, rays = 0;
    Differences differences{};
    for (const Mesh &mesh :
         {room(), soup(3000, 1), sphere(100, 200, 1.0f, 0.01f, {0, 0, 0}), terrain(120, 2)}) {
        wrong += count_wrong(mesh, 250000, &differences);
        rays += 250000;
    }
    std::printf(
        "of %zu rays %zu random, %zu grazing, %zu tied ones differ from Embree; %zu of them wrong in "
        "double\n",
        rays, differences[0], differences[1], differences[2], wrong);
    EXPECT_LE(static_cast<double>(wrong), 1e-6 * static_cast<double>(rays));
    EXPECT_LE(static_cast<double>(differences[0]), 1e-4 * static_cast<double>(rays))
        << "too many to be rounding";
}

/// A binary little-endian PLY whose vertices are floats and whose faces are triangles.
Mesh load_ply(const std::filesystem::path &path) {
    std::ifstream file(path, std::ios::binary);
    Mesh mesh{path.stem().string(), {}, {}};
    size_t vertices = 0, faces = 0, floats = 0, words_after_face = 0;
    bool in_vertex = false;
    for (std::string line; std::getline(file, line) && line != "end_header";) {
        if (line.rfind("element ", 0) == 0) {
            in_vertex = line.rfind("element vertex ", 0) == 0;
            (in_vertex ? vertices : faces) = std::stoul(line.substr(line.find_last_of(' ')));
        } else if (line.rfind("property ", 0) == 0 && line.rfind("property list", 0) != 0) {
            (in_vertex ? floats : words_after_face) += 1;
        }
    }
    std::vector<float> vertex(floats);
    for (size_t i = 0; i < vertices; ++i) {
        file.read(reinterpret_cast<char *>(vertex.data()),
                  static_cast<std::streamsize>(floats * sizeof(float)));
        mesh.positions.emplace_back(vertex[0], vertex[1], vertex[2]);
    }
    for (size_t i = 0; i < faces; ++i) {
        std::array<uint32_t, 3> triangle{};
        file.ignore(1);
        file.read(reinterpret_cast<char *>(triangle.data()), sizeof triangle);
        file.ignore(static_cast<std::streamsize>(4 * words_after_face));
        mesh.triangles.push_back(triangle);
    }
    EXPECT_TRUE(file.good() && faces > 0) << path;
    return mesh;
}

TEST(TraversalEmbree, RealModelsAgree) {
    const char *meshes = std::getenv("RTRAYS_MESHES");
    if (meshes == nullptr) {
        GTEST_SKIP() << "RTRAYS_MESHES is not set";
    }
    for (const char *name :
         {"bunny/bunny.ply", "conference/conference.ply", "sponza-crytek/sponza-crytek.ply"}) {
        const std::filesystem::path path = std::filesystem::path(meshes) / name;
        if (!std::filesystem::exists(path)) {
            continue;
        }
        Differences differences{};
        const size_t rays = 100000;
        const size_t wrong = count_wrong(load_ply(path), rays, &differences);
        std::printf(
            "%s: of %zu rays %zu random, %zu grazing, %zu tied ones differ from Embree; %zu of them wrong in "
            "double\n",
            name, rays, differences[0], differences[1], differences[2], wrong);
        EXPECT_EQ(wrong, 0u) << name;
    }
}

}  // namespace
}  // namespace rtrays
