// SPDX-License-Identifier: MIT
// Triangles and ray queries. Embree finds WHICH triangle a ray hits, in float and with its robust
// (watertight) traversal; where on it is computed again in double.
#pragma once

#include <embree3/rtcore.h>

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "reference/camera.h"
#include "reference/math.h"
#include "renderer/scene/stores.h"

namespace rtrays::reference {

/// A triangle of non-zero area, world space.
struct TriangleRecord {
    Vec3 vertex;    ///< the first one
    Vec3 edge1;     ///< to the second vertex
    Vec3 edge2;     ///< to the third vertex
    Vec3 normal;    ///< unit, towards the side from which the vertices run counter-clockwise
    double offset;  ///< distance from the plane at which float rays start (see `spawn_point`)
    double margin;  ///< barycentric distance from the edges kept by ray origins
    uint32_t material;
    uint32_t light;  ///< `no_index` when it does not emit
    bool has_normals;
    bool has_uv;

    /// Second and third barycentric coordinate in, world position out.
    Vec3 point(const Eigen::Vector2d &barycentric) const {
        return vertex + barycentric.x() * edge1 + barycentric.y() * edge2;
    }
    double area() const { return 0.5 * edge1.cross(edge2).norm(); }
};

/// A point on a triangle.
struct SurfacePoint {
    Vec3 position;
    Eigen::Vector2d barycentric;
    uint32_t triangle;
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
    double build_seconds = 0;
    std::string engine;  ///< "embree 3.13.5"
};

/// All meshes of a scene in one Embree scene. Immutable, shared by all threads.
class Geometry {
  public:
    /// Throws `Error` (bad input) for vertex positions that are not finite, (run failed) when Embree
    /// reports an error.
    explicit Geometry(const MeshArrays &meshes);

    const TriangleRecord &triangle(uint32_t index) const { return triangles_[index]; }
    const std::vector<TriangleRecord> &triangles() const { return triangles_; }
    const GeometryStats &stats() const { return stats_; }

    const Vec3 &normal(const SurfacePoint &point) const { return triangles_[point.triangle].normal; }
    uint32_t material(const SurfacePoint &point) const { return triangles_[point.triangle].material; }
    uint32_t light(const SurfacePoint &point) const { return triangles_[point.triangle].light; }
    bool has_shading_normal(const SurfacePoint &point) const {
        return triangles_[point.triangle].has_normals;
    }

    /// Interpolated normal and coordinates. The tangent of a triangle is dp/du of its texture coordinates;
    /// without these, or where they are degenerate, its first edge.
    Parametrization parametrize(const SurfacePoint &point) const;

    /// Nearest hit of a ray. Returns false when there is none.
    bool intersect(const Ray &ray, Coherence coherence, SurfacePoint &hit) const;

    /// Whether anything lies strictly between two points; both must have left their surfaces already
    /// (`spawn_point`).
    bool occluded(const Vec3 &from, const Vec3 &to) const;

    /// Where a ray that leaves `point` to the side of `direction` starts: off the plane by a multiple of
    /// what float rounding and Embree's float arithmetic can do, so that it never meets its own triangle,
    /// and away from the edges by four times as much, so that it is not pushed through a neighbour that
    /// meets this triangle at an edge with more than 14 degrees.
    Vec3 spawn_point(const SurfacePoint &point, const Vec3 &direction) const;

  private:
    struct Release {
        void operator()(RTCDevice device) const { rtcReleaseDevice(device); }
        void operator()(RTCScene scene) const { rtcReleaseScene(scene); }
    };
    std::unique_ptr<RTCDeviceTy, Release> device_;
    std::unique_ptr<RTCSceneTy, Release> scene_;
    std::vector<TriangleRecord> triangles_;
    // Of vertices, for meshes that have them; `vertices_` is empty when none has.
    std::vector<Triangle> vertices_;  ///< per triangle
    std::vector<Eigen::Vector3f> normals_;
    std::vector<Eigen::Vector2f> uvs_;
    GeometryStats stats_;
};

}  // namespace rtrays::reference
