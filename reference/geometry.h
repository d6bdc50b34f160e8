// SPDX-License-Identifier: MIT
// Surfaces of a scene and ray queries.
//
// Embree finds WHICH triangle a ray hits, in float and with its robust (watertight) traversal. The
// hit point on that triangle is recomputed in double. Other shapes are user geometry, intersected
// in double from the start. Infinite planes have no bounds and are tested one by one.
#pragma once

#include <embree3/rtcore.h>

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "reference/camera.h"
#include "reference/math.h"
#include "reference/opacity.h"
#include "reference/shape.h"
#include "reference/triangle.h"
#include "renderer/scene/stores.h"

namespace rtrays::reference {

/// A point on a surface.
struct SurfacePoint {
    Vec3 position;
    /// Triangles: barycentrics of the second and third vertex; shapes: object-space point.
    Vec3 local;
    uint32_t primitive;  ///< index, triangles first, then shapes
};

/// Shading normal, tangent and texture coordinates of a surface point.
struct Parametrization {
    Vec3 shading_normal;  ///< unit; the geometric normal if the surface has no other
    Vec3 tangent;         ///< along dp/du, of any length
    Eigen::Vector2d uv;   ///< zero if the surface has no coordinates
    /// Whether `tangent` is dp/du and `along_v` is dp/dv, with their lengths.
    bool derivatives = false;
    Vec3 along_v = Vec3::Zero();
    Spectrum colour = Spectrum::Ones();  ///< that of the vertices; white if the surface has none
};

/// Coherence of a ray with its neighbours. It is a hint to Embree and does not change the result.
enum class Coherence { coherent, incoherent };

/// Statistics of the build.
struct GeometryStats {
    size_t triangles = 0;
    size_t degenerate_triangles = 0;  ///< triangles of zero area, omitted
    size_t shapes = 0;
    double build_seconds = 0;
    std::string engine;  ///< name and version, as in "embree 3.13.5"
};

/// All surfaces of a scene. Immutable and shared by all threads.
class Geometry {
  public:
    /// Builds the Embree scene. Throws `Error` (bad input) for vertex positions that are not finite
    /// and for shapes out of range. Throws `Error` (run failed) if Embree reports an error.
    /// `opacities` are those of the materials, or empty if all surfaces are opaque.
    Geometry(const MeshArrays &meshes, const ShapeArrays &shapes,
             std::vector<Opacity> opacities = {});
    Geometry(const Geometry &) = delete;
    Geometry &operator=(const Geometry &) = delete;

    const std::vector<TriangleRecord> &triangles() const { return triangles_; }
    const std::vector<Shape> &shapes() const { return shapes_; }
    const GeometryStats &stats() const { return stats_; }

    /// Returns the bounds of all bounded surfaces; empty if there are none.
    const Eigen::AlignedBox3d &bounds() const { return bounds_; }

    bool is_triangle(const SurfacePoint &point) const { return point.primitive < first_shape_; }
    const TriangleRecord &triangle(const SurfacePoint &point) const {
        return triangles_[point.primitive];
    }
    const Shape &shape(const SurfacePoint &point) const {
        return shapes_[point.primitive - first_shape_];
    }

    /// Returns the point of a triangle where the ray meets its plane, moved onto the triangle.
    /// `barycentric` is the hit that Embree found.
    SurfacePoint triangle_point(const Ray &ray, uint32_t triangle,
                                const Eigen::Vector2d &barycentric) const;

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

    /// Returns interpolated normal, texture coordinates and colour. The tangent of a triangle is
    /// dp/du of its texture coordinates. If these are missing or degenerate, it is the first edge.
    Parametrization parametrize(const SurfacePoint &point) const;

    /// Returns whether no surface lets a ray pass.
    bool is_opaque() const { return opacities_.empty(); }

    /// Returns whether the point of primitive `hit.primitive` stops the ray with this key.
    /// `earlier_hits` counts the points of the primitive that the ray has passed.
    bool stops(const SurfacePoint &hit, uint64_t key, uint32_t earlier_hits) const;

    /// Finds the nearest hit of a ray. Returns false if there is none. `key` is a random number of
    /// the ray, which decides whether surfaces that are not opaque stop it.
    bool intersect(const Ray &ray, Coherence coherence, SurfacePoint &hit, uint64_t key = 0) const;

    /// Returns whether a surface is strictly between two points. Both points must already be off
    /// their surfaces (`spawn_point`).
    bool occluded(const Vec3 &from, const Vec3 &to, uint64_t key = 0) const {
        return blocked({from, to - from}, 1.0, key);
    }

    /// Returns whether the ray hits a surface at any distance.
    bool occluded(const Ray &ray, uint64_t key = 0) const;

    /// Returns the origin of a ray that leaves `point` to the side of `direction`. It is offset so
    /// that the ray never hits its own surface again (see `TriangleRecord` and `Shape`).
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
    /// Returns the part of a ray that may hit a surface, if it begins at more than a thousand radii
    /// from all surfaces. Embree rounds its origin to float, which has too few digits there.
    Ray from_nearby(const Ray &ray) const;
    /// Returns whether the ray hits a surface at t in (0, t_max). The direction of the ray need not
    /// have unit length.
    bool blocked(const Ray &ray, double t_max, uint64_t key) const;

    std::vector<Opacity> opacities_;  ///< indexed by material; empty if all surfaces are opaque
    std::unique_ptr<RTCDeviceTy, Release> device_;
    std::unique_ptr<RTCSceneTy, Release> scene_;
    std::vector<TriangleRecord> triangles_;
    std::vector<Shape> shapes_;
    uint32_t first_shape_ = 0;         ///< number of triangles
    std::vector<uint32_t> unbounded_;  ///< indices of shapes without bounds
    Eigen::AlignedBox3d bounds_;
    // Vertex attributes. `vertices_` is empty if no mesh has any of them.
    std::vector<Triangle> vertices_;  ///< vertex indices per triangle
    std::vector<Eigen::Vector3f> normals_;
    std::vector<Eigen::Vector2f> uvs_;
    std::vector<Rgb> colours_;
    GeometryStats stats_;
};

}  // namespace rtrays::reference
