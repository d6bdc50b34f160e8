// SPDX-License-Identifier: MIT
// Shapes other than triangles (renderer/scene/stores.h, ShapeArrays), intersected in double.
#pragma once

#include <Eigen/Geometry>
#include <variant>

#include "reference/camera.h"
#include "reference/julia.h"
#include "reference/math.h"
#include "reference/quadric.h"
#include "renderer/scene/stores.h"

namespace rtrays::reference {

/// The plane z = 0, or its unit disc if `bounded`.
struct Flat {
    bool bounded;

    bool intersect(const Vec3 &origin, const Vec3 &direction, double t_max, double &t) const;
};

/// A shape placed in the world. Rays keep their parameter t in object space, so directions there do
/// not have unit length.
class Shape {
  public:
    /// Throws `Error` (bad input) naming the shape for a transform that is not affine and
    /// invertible, or for parameters out of range.
    Shape(const ShapeArrays &shapes, size_t index);

    uint32_t material() const { return material_; }
    uint32_t light() const { return light_; }
    ShapeArrays::Kind kind() const { return kind_; }
    const Eigen::Matrix3d &linear() const { return linear_; }  ///< linear part of world from object
    const Vec3 &centre() const { return centre_; }  ///< origin of the object in the world

    /// Finds the nearest hit with t in (0, t_max). `object` is the hit in object space, on the
    /// surface up to rounding. Returns false if there is none.
    bool intersect(const Ray &ray, double t_max, double &t, Vec3 &object) const;

    Vec3 to_world(const Vec3 &object) const { return linear_ * object + centre_; }
    Vec3 to_object(const Vec3 &world) const { return inverse_ * (world - centre_); }

    Vec3 normal(const Vec3 &object) const;  ///< in the world, unit, on the front
    /// Returns the tangent in the world along dp/du, or the object's x axis for a Julia set.
    Vec3 tangent(const Vec3 &object) const;
    Eigen::Vector2d uv(const Vec3 &object) const;

    bool is_bounded() const { return kind_ != ShapeArrays::Kind::plane; }
    /// In the world; valid for bounded shapes.
    const Eigen::AlignedBox3d &bounds() const { return bounds_; }

    double offset() const { return offset_; }  ///< distance of spawn points from a bounded surface

    /// Returns the origin of a ray that leaves the point to the side of `direction`. It is off the
    /// surface by 1e-10 of the shape's size and distance from the world origin. This is 1e5 times
    /// the rounding error of the double arithmetic that finds the next hit.
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
