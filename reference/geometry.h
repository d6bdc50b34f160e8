// SPDX-License-Identifier: MIT
// Surfaces and ray queries. Embree finds WHICH triangle a ray hits, in float and with its robust
// (watertight) traversal; where on it is computed again in double. Other shapes are user geometry,
// intersected in double from the start; infinite planes, which have no bounds, are tried one by
// one.
#pragma once

#include <embree3/rtcore.h>

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "reference/camera.h"
#include "reference/math.h"
#include "reference/shape.h"
#include "reference/triangle.h"
#include "renderer/scene/stores.h"

namespace rtrays::reference {

/// A point on a surface.
struct SurfacePoint {
    Vec3 position;
    Vec3 local;  ///< triangles: second and third barycentric coordinate; shapes: object space
    uint32_t primitive;  ///< triangles first, then shapes
};

/// What interpolation and texturing need to know of a point.
struct Parametrization {
    Vec3 shading_normal;  ///< unit; the geometric one where the surface has no other
    Vec3 tangent;         ///< along dp/du, any length
    Eigen::Vector2d uv;   ///< zero where the surface has no coordinates
};

/// How a ray batch relates to its neighbours: a hint to Embree, without effect on the result.
enum class Coherence { coherent, incoherent };

/// Numbers of the build, for statistics.
struct GeometryStats {
    size_t triangles = 0;
    size_t degenerate_triangles = 0;  ///< of zero area, left out
    size_t shapes = 0;
    double build_seconds = 0;
    std::string engine;  ///< "embree 3.13.5"
};

/// All surfaces of a scene. Immutable, shared by all threads.
class Geometry {
  public:
    /// Throws `Error` (bad input) for vertex positions that are not finite and shapes out of range,
    /// (run failed) when Embree reports an error.
    Geometry(const MeshArrays &meshes, const ShapeArrays &shapes);
    Geometry(const Geometry &) = delete;
    Geometry &operator=(const Geometry &) = delete;

    const std::vector<TriangleRecord> &triangles() const { return triangles_; }
    const std::vector<Shape> &shapes() const { return shapes_; }
    const GeometryStats &stats() const { return stats_; }

    /// Of all bounded surfaces; empty when there is none.
    const Eigen::AlignedBox3d &bounds() const { return bounds_; }

    bool is_triangle(const SurfacePoint &point) const { return point.primitive < first_shape_; }
    const TriangleRecord &triangle(const SurfacePoint &point) const {
        return triangles_[point.primitive];
    }
    const Shape &shape(const SurfacePoint &point) const {
        return shapes_[point.primitive - first_shape_];
    }

    Vec3 normal(const SurfacePoint &point) const {
        return is_triangle(point) ? triangle(point).normal : shape(point).normal(point.local);
    }
    uint32_t material(const SurfacePoint &point) const {
        return is_triangle(point) ? triangle(point).material : shape(point).material();
    }
    uint32_t light(const SurfacePoint &point) const {
        return is_triangle(point) ? triangle(point).light : shape(point).light();
    }
    bool has_shading_normal(const SurfacePoint &point) const {
        return is_triangle(point) && triangle(point).has_normals;
    }

    /// Interpolated normal and coordinates. The tangent of a triangle is dp/du of its texture
    /// coordinates; without these, or where they are degenerate, its first edge.
    Parametrization parametrize(const SurfacePoint &point) const;

    /// Nearest hit of a ray. Returns false when there is none.
    bool intersect(const Ray &ray, Coherence coherence, SurfacePoint &hit) const;

    /// Whether anything lies strictly between two points; both must have left their surfaces
    /// already
    /// (`spawn_point`).
    bool occluded(const Vec3 &from, const Vec3 &to) const {
        return blocked({from, to - from}, 1.0);
    }

    /// Whether anything lies in the direction of the ray, however far.
    bool occluded(const Ray &ray) const;

    /// Where a ray that leaves `point` to the side of `direction` starts, so that it never meets
    /// its own surface again (see `TriangleRecord` and `Shape`).
    Vec3 spawn_point(const SurfacePoint &point, const Vec3 &direction) const {
        return is_triangle(point)
                   ? triangle(point).spawn_point(point.position, point.local, direction)
                   : shape(point).spawn_point(point.local, direction);
    }

  private:
    struct Release {
        void operator()(RTCDevice device) const { rtcReleaseDevice(device); }
        void operator()(RTCScene scene) const { rtcReleaseScene(scene); }
    };
    void attach_triangles(const MeshArrays &meshes, const std::vector<Triangle> &indices);
    /// The ray's direction need not be of unit length; t in (0, t_max).
    bool blocked(const Ray &ray, double t_max) const;

    std::unique_ptr<RTCDeviceTy, Release> device_;
    std::unique_ptr<RTCSceneTy, Release> scene_;
    std::vector<TriangleRecord> triangles_;
    std::vector<Shape> shapes_;
    uint32_t first_shape_ = 0;         ///< number of triangles
    std::vector<uint32_t> unbounded_;  ///< indices of shapes
    Eigen::AlignedBox3d bounds_;
    // Of vertices, for meshes that have them; `vertices_` is empty when none has.
    std::vector<Triangle> vertices_;  ///< per triangle
    std::vector<Eigen::Vector3f> normals_;
    std::vector<Eigen::Vector2f> uvs_;
    GeometryStats stats_;
};

}  // namespace rtrays::reference
