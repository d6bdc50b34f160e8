// SPDX-License-Identifier: MIT
// Surfaces other than triangles (renderer/scene/stores.h, ShapeArrays), intersected in double.
#pragma once

#include <Eigen/Geometry>
#include <variant>

#include "reference/camera.h"
#include "reference/julia.h"
#include "reference/math.h"
#include "reference/quadric.h"
#include "renderer/scene/stores.h"

namespace rtrays::reference {

/// z = 0: the unit disc, or all of it.
struct Flat {
    bool bounded;

    bool intersect(const Vec3 &origin, const Vec3 &direction, double t_max, double &t) const;
};

/// One surface, placed in the world. Rays keep their parameter t in object space: directions there
/// are not of unit length.
class Shape {
  public:
    /// Throws `Error` (bad input) naming the shape for a transform that is not affine and
    /// invertible, and for parameters out of range.
    Shape(const ShapeArrays &shapes, size_t index);

    uint32_t material() const { return material_; }
    uint32_t light() const { return light_; }
    ShapeArrays::Kind kind() const { return kind_; }
    const Eigen::Matrix3d &linear() const { return linear_; }  ///< world from object
    const Vec3 &centre() const { return centre_; }             ///< the object's origin in the world

    /// Nearest hit with t in (0, t_max); `object` is the point in object space, on the surface to
    /// rounding.
    bool intersect(const Ray &ray, double t_max, double &t, Vec3 &object) const;

    Vec3 to_world(const Vec3 &object) const { return linear_ * object + centre_; }

    Vec3 normal(const Vec3 &object) const;  ///< world, unit, on the front
    Vec3 tangent(
        const Vec3 &object) const;  ///< world, along dp/du; the object's x axis for a Julia set
    Eigen::Vector2d uv(const Vec3 &object) const;

    bool is_bounded() const { return kind_ != ShapeArrays::Kind::plane; }
    const Eigen::AlignedBox3d &bounds() const { return bounds_; }  ///< world; of bounded shapes

    double offset() const { return offset_; }  ///< of spawn points from a bounded surface

    /// Where a ray that leaves the point to the side of `direction` starts: off the surface by
    /// 1e-10 of its size and distance from the origin, 1e5 times the rounding of the double
    /// arithmetic that looks for its next hit.
    Vec3 spawn_point(const Vec3 &object, const Vec3 &direction) const;

  private:
    ShapeArrays::Kind kind_;
    Eigen::Matrix3d linear_;
    Eigen::Matrix3d inverse_;
    Vec3 centre_;
    double offset_;
    uint32_t material_;
    uint32_t light_;
    Eigen::AlignedBox3d bounds_;
    std::variant<Quadric, Flat, JuliaSet> surface_;
};

}  // namespace rtrays::reference
