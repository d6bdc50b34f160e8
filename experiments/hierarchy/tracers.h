// SPDX-License-Identifier: MIT
// Arrays of rays through a hierarchy on the OpenCL device, and through Embree's.
#pragma once

#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "experiments/hierarchy/rays.h"
#include "renderer/bvh/builder.h"
#include "renderer/device/kernel.h"
#include "renderer/kernels/traversal/intersect_triangle.h"
#include "renderer/tests/embree_scene.h"

namespace rtrays {

/// A way to build and lay out a hierarchy on the device.
struct HierarchyVariant {
    std::string name;  ///< "binned_sah wide8"
    BvhBuildParameters parameters;
};

/// Every layout by the usual builder, and the usual layout by every other builder.
std::vector<HierarchyVariant> hierarchy_variants(const DeviceInfo &device);

/// Vertices and triangles on the device.
struct DeviceMesh {
    DeviceMesh(DeviceContext &device, const test::Mesh &mesh);

    Buffer<float> positions;
    Buffer<uint32_t> indices;
};

/// Rays on the device, to be traced through any number of hierarchies.
struct DeviceRays {
    DeviceRays(DeviceContext &device, const std::vector<RayRecord> &rays, Query query);

    Query query;
    uint32_t count;
    Buffer<RayRecord> rays;
    Buffer<Hit> hits;            ///< of Query::nearest
    Buffer<uint32_t> occlusion;  ///< of Query::any

    /// Number of rays that hit something when they were last traced.
    size_t hit_count() const;
};

class DeviceTracer {
  public:
    DeviceTracer(DeviceContext &device, Bvh bvh);

    const Bvh &bvh() const { return bvh_; }
    Bvh &bvh() { return bvh_; }  ///< to be fitted anew

    /// Traces and waits. The first launch of a kernel compiles it.
    void trace(const DeviceRays &rays) const;

    /// Means over the rays: {nodes visited, triangles tested}.
    std::pair<double, double> work_per_ray(const DeviceRays &rays) const;

  private:
    template <typename T>
    Kernel kernel(const Program &program, const std::string &name, const DeviceRays &rays,
                  const Buffer<T> &results) const;

    DeviceContext *device_;
    Bvh bvh_;
    Program trace_, count_;
};

/// How Embree is asked: ray by ray (rtcIntersect1, rtcOccluded1) or sixteen at a time
/// (rtcIntersect16, rtcOccluded16).
enum class EmbreeCall { single, packets };

const char *name_of(EmbreeCall call, Query query);

/// An instruction set that Embree is built for, and the bits of its registers.
struct EmbreeIsa {
    const char *name;
    uint32_t width;
};

/// Those that this processor has, the widest last. Throws `Error` where there is none.
std::vector<EmbreeIsa> embree_isas();

/// Embree's hierarchy of medium quality, ROBUST, traced by as many threads as it was built by.
class EmbreeTracer {
  public:
    EmbreeTracer(const test::Mesh &mesh, uint32_t threads, const EmbreeIsa &isa);

    const test::EmbreeScene &scene() const { return scene_; }
    const std::string &isa() const { return isa_; }

    /// Number of rays that hit something. `coherent`: what packets are told of their rays.
    size_t trace(const std::vector<RayRecord> &rays, Query query, EmbreeCall call,
                 bool coherent) const;

    /// Distance of the nearest hit of every ray, infinite for none.
    std::vector<float> nearest(const std::vector<RayRecord> &rays) const;

  private:
    /// Calls work(begin, end) with a piece of [0, count) on every thread and adds up what it
    /// returns.
    template <typename Work>
    size_t on_all_threads(size_t count, const Work &work) const;

    std::string isa_;
    size_t threads_;
    test::EmbreeScene scene_;
};

/// One for every instruction set of this processor.
std::vector<std::unique_ptr<EmbreeTracer>> embree_tracers(const test::Mesh &mesh, uint32_t threads);

}  // namespace rtrays
