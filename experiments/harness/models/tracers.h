// SPDX-License-Identifier: MIT
// Traces arrays of rays through a hierarchy on the OpenCL device, and through Embree's.
#pragma once

#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "experiments/harness/models/rays.h"
#include "renderer/bvh/builder.h"
#include "renderer/device/kernel.h"
#include "renderer/kernels/traversal/intersect_triangle.h"
#include "renderer/testing/embree_scene.h"

namespace rtrays {

/// A builder and a layout of a hierarchy on the device.
struct HierarchyVariant {
    std::string name;  ///< "binned_sah wide8"
    BvhBuildParameters parameters;
};

/// Returns every layout with the default builder, and the default layout with every other builder.
std::vector<HierarchyVariant> hierarchy_variants(const DeviceInfo &device);

/// Vertices and triangles on the device.
struct DeviceMesh {
    DeviceMesh(DeviceContext &device, const test::Mesh &mesh);

    Buffer<float> positions;
    Buffer<uint32_t> indices;
};

/// Rays on the device, which can be traced through several hierarchies.
struct DeviceRays {
    DeviceRays(DeviceContext &device, const std::vector<RayRecord> &rays, Query query);

    Query query;
    uint32_t count;
    Buffer<RayRecord> rays;
    Buffer<Hit> hits;            ///< results of Query::nearest
    Buffer<uint32_t> occlusion;  ///< results of Query::any

    /// Returns the number of rays that hit a triangle in the last trace.
    size_t hit_count() const;
};

/// Traces rays through a hierarchy on the device.
class DeviceTracer {
  public:
    DeviceTracer(DeviceContext &device, Bvh bvh);

    const Bvh &bvh() const { return bvh_; }
    Bvh &bvh() { return bvh_; }  ///< for refitting

    /// Traces the rays and waits for the device. The first launch of a kernel compiles it.
    void trace(const DeviceRays &rays) const;

    /// Returns means over the rays: {nodes visited, triangles tested}.
    std::pair<double, double> work_per_ray(const DeviceRays &rays) const;

  private:
    template <typename T>
    Kernel kernel(const Program &program, const std::string &name, const DeviceRays &rays,
                  const Buffer<T> &results) const;

    DeviceContext *device_;
    Bvh bvh_;
    Program trace_, count_;
};

/// Embree's interface: single rays (rtcIntersect1, rtcOccluded1) or packets of sixteen
/// (rtcIntersect16, rtcOccluded16).
enum class EmbreeCall { single, packets };

/// Returns the name of Embree's function.
const char *name_of(EmbreeCall call, Query query);

/// An instruction set of Embree, and its register width in bits.
struct EmbreeIsa {
    const char *name;
    uint32_t width;
};

/// Returns the instruction sets that this processor supports, the widest last. Throws `Error` (run
/// failed) if there is none.
std::vector<EmbreeIsa> embree_isas();

/// Embree's hierarchy of medium quality (ROBUST), built and traced by the same number of threads.
class EmbreeTracer {
  public:
    EmbreeTracer(const test::Mesh &mesh, uint32_t threads, const EmbreeIsa &isa);

    const test::EmbreeScene &scene() const { return scene_; }
    const std::string &isa() const { return isa_; }

    /// Traces the rays and returns the number of hits. `coherent` sets the packets' coherence flag.
    size_t trace(const std::vector<RayRecord> &rays, Query query, EmbreeCall call,
                 bool coherent) const;

    /// Returns the distance of the nearest hit of every ray, or infinity.
    std::vector<float> nearest(const std::vector<RayRecord> &rays) const;

  private:
    /// Calls work(begin, end) on every thread with a part of [0, count) and sums the results.
    template <typename Work>
    size_t on_all_threads(size_t count, const Work &work) const;

    std::string isa_;
    size_t threads_;
    test::EmbreeScene scene_;
};

/// Builds a tracer for every instruction set of this processor.
std::vector<std::unique_ptr<EmbreeTracer>> embree_tracers(const test::Mesh &mesh, uint32_t threads);

}  // namespace rtrays
