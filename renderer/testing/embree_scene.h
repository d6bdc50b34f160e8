// SPDX-License-Identifier: MIT
// A mesh in an Embree 3 scene, with which the traversal is compared. The ROBUST flag is the
// default.
#pragma once

#include <embree3/rtcore.h>

#include <algorithm>
#include <atomic>
#include <string>

#include "renderer/kernels/traversal/ray_record.h"
#include "renderer/testing/bvh_meshes.h"

namespace rtrays::test {

struct EmbreeHit {
    float t;            ///< infinite for a miss, and the other members are then undefined
    float u, v;         ///< weights of vertices 1 and 2
    uint32_t triangle;  ///< index in the mesh
};

class EmbreeScene {
  public:
    /// Creates the scene and builds the hierarchy. `configuration` is passed to rtcNewDevice.
    explicit EmbreeScene(const Mesh &mesh, const std::string &configuration = "threads=1")
        : EmbreeScene(mesh, configuration, RTC_BUILD_QUALITY_MEDIUM, RTC_SCENE_FLAG_ROBUST) {
        commit();
    }

    /// Creates the scene without a hierarchy. Call `commit` once before tracing rays.
    EmbreeScene(const Mesh &mesh, const std::string &configuration, RTCBuildQuality quality,
                RTCSceneFlags flags)
        : device_(rtcNewDevice(configuration.c_str())), scene_(rtcNewScene(device_)) {
        rtcSetDeviceMemoryMonitorFunction(device_, account, this);
        rtcSetSceneFlags(scene_, flags);
        rtcSetSceneBuildQuality(scene_, quality);
        const RTCGeometry geometry = rtcNewGeometry(device_, RTC_GEOMETRY_TYPE_TRIANGLE);
        auto *positions = static_cast<float *>(
            rtcSetNewGeometryBuffer(geometry, RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT3,
                                    3 * sizeof(float), mesh.positions.size()));
        for (size_t i = 0; i < mesh.positions.size(); ++i) {
            std::copy_n(mesh.positions[i].data(), 3, positions + 3 * i);
        }
        auto *indices = static_cast<uint32_t *>(
            rtcSetNewGeometryBuffer(geometry, RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT3,
                                    3 * sizeof(uint32_t), mesh.triangles.size()));
        for (size_t i = 0; i < mesh.triangles.size(); ++i) {
            std::copy_n(mesh.triangles[i].data(), 3, indices + 3 * i);
        }
        rtcSetGeometryBuildQuality(geometry, quality);
        rtcCommitGeometry(geometry);
        rtcAttachGeometry(scene_, geometry);
        rtcReleaseGeometry(geometry);
    }
    ~EmbreeScene() {
        rtcReleaseScene(scene_);
        rtcReleaseDevice(device_);
    }
    EmbreeScene(const EmbreeScene &) = delete;
    EmbreeScene &operator=(const EmbreeScene &) = delete;

    /// Builds the hierarchy.
    void commit() { rtcCommitScene(scene_); }

    RTCDevice device() const { return device_; }
    RTCScene scene() const { return scene_; }

    /// Memory that Embree holds for this scene, in bytes, including vertices and indices; the
    /// current value and the peak so far.
    int64_t bytes() const { return bytes_; }
    int64_t bytes_peak() const { return bytes_peak_; }

    EmbreeHit nearest_hit(const RayRecord &ray) const {
        RTCIntersectContext context;
        rtcInitIntersectContext(&context);
        RTCRayHit hit{embree_ray(ray), {}};
        hit.hit.geomID = RTC_INVALID_GEOMETRY_ID;
        hit.hit.instID[0] = RTC_INVALID_GEOMETRY_ID;
        rtcIntersect1(scene_, &context, &hit);
        const bool found = hit.hit.geomID != RTC_INVALID_GEOMETRY_ID;
        return {found ? hit.ray.tfar : INFINITY, hit.hit.u, hit.hit.v, hit.hit.primID};
    }

    /// Returns the distance of the nearest hit, infinite for a miss.
    float nearest(const RayRecord &ray) const { return nearest_hit(ray).t; }

    /// Returns whether the ray hits anything before its end.
    bool occluded(const RayRecord &ray) const {
        RTCIntersectContext context;
        rtcInitIntersectContext(&context);
        RTCRay shadow = embree_ray(ray);
        rtcOccluded1(scene_, &context, &shadow);
        return shadow.tfar < 0;
    }

    static RTCRay embree_ray(const RayRecord &ray) {
        return {ray.origin[0],
                ray.origin[1],
                ray.origin[2],
                0,
                ray.direction[0],
                ray.direction[1],
                ray.direction[2],
                0,
                ray.t_max,
                ~0u,
                0,
                0};
    }

  private:
    static bool account(void *self, ssize_t bytes, bool) {
        auto *scene = static_cast<EmbreeScene *>(self);
        const int64_t now = scene->bytes_ += bytes;
        for (int64_t peak = scene->bytes_peak_;
             peak < now && !scene->bytes_peak_.compare_exchange_weak(peak, now);) {
        }
        return true;
    }

    std::atomic<int64_t> bytes_ = 0, bytes_peak_ = 0;
    RTCDevice device_;
    RTCScene scene_;
};

}  // namespace rtrays::test
