// SPDX-License-Identifier: MIT
#include "reference/shape.h"

#include <fmt/format.h>

#include "renderer/base/error.h"

namespace rtrays::reference {

namespace {

using Kind = ShapeArrays::Kind;
using Surface = std::variant<Quadric, Flat, JuliaSet>;

constexpr double relative_offset = 1e-10;

Surface make_surface(const ShapeArrays &shapes, size_t i) {
    const auto require = [&](bool condition, const char *complaint) {
        if (!condition) {
            throw input_error(fmt::format("shape {} '{}': {}", i, shapes.name[i], complaint));
        }
    };
    switch (shapes.kind[i]) {
        case Kind::disc:
            return Flat{true};
        case Kind::plane:
            return Flat{false};
        case Kind::julia: {
            const uint32_t n = shapes.julia_iterations[i];
            require(n >= 1 && n <= JuliaSet::most_iterations, "iterations must be in [1, 64]");
            require(shapes.julia_constant[i].allFinite() && std::isfinite(shapes.julia_slice[i]),
                    "constant and slice must be finite");
            return JuliaSet(shapes.julia_constant[i], shapes.julia_slice[i], n);
        }
        case Kind::hyperboloid:
            require(shapes.flare[i] > 0.0 && std::isfinite(shapes.flare[i]),
                    "flare must be positive");
            break;
        default:
            break;
    }
    return Quadric(shapes.kind[i], shapes.flare[i]);
}

Eigen::AlignedBox3d object_bounds(const Surface &surface) {
    if (const auto *quadric = std::get_if<Quadric>(&surface)) {
        const double r = quadric->radius();
        return {Vec3(-r, -r, quadric->low()), Vec3(r, r, quadric->high())};
    }
    if (const auto *julia = std::get_if<JuliaSet>(&surface)) {
        return {Vec3::Constant(-julia->bounding_radius()),
                Vec3::Constant(julia->bounding_radius())};
    }
    return {Vec3(-1, -1, 0), Vec3(1, 1, 0)};
}

}  // namespace

bool Flat::intersect(const Vec3 &origin, const Vec3 &direction, double t_max, double &t) const {
    // Infinite or NaN for a ray along the plane: no hit.
    const double at = -origin.z() / direction.z();
    if (!(at > 0.0 && at < t_max)) {
        return false;
    }
    const double x = origin.x() + at * direction.x(), y = origin.y() + at * direction.y();
    t = at;
    return !bounded || x * x + y * y <= 1.0;
}

Shape::Shape(const ShapeArrays &shapes, size_t index)
    : kind_(shapes.kind[index]),
      linear_(shapes.world_from_object[index].topLeftCorner<3, 3>()),
      centre_(shapes.world_from_object[index].topRightCorner<3, 1>()),
      material_(shapes.material[index]),
      light_(shapes.light[index]),
      surface_(make_surface(shapes, index)) {
    const Eigen::Matrix4d &transform = shapes.world_from_object[index];
    const bool affine = transform.row(3) == Eigen::RowVector4d(0, 0, 0, 1);
    const double scale = linear_.norm();
    // Compares the determinant with that of a rotation of the same scale. Below this ratio, double
    // has no digits left.
    if (!transform.allFinite() || !affine ||
        !(std::abs(linear_.determinant()) > 1e-12 * scale * scale * scale)) {
        throw input_error(fmt::format("shape {} '{}': the transform must be affine and invertible",
                                      index, shapes.name[index]));
    }
    inverse_ = linear_.inverse();
    const Eigen::AlignedBox3d box = object_bounds(surface_);
    const Vec3 middle = to_world(box.center());
    const Vec3 half = linear_.cwiseAbs() * (0.5 * box.sizes());
    bounds_ = {middle - half, middle + half};
    offset_ = relative_offset * (middle.cwiseAbs().maxCoeff() + half.maxCoeff());
}

bool Shape::intersect(const Ray &ray, double t_max, double &t, Vec3 &object) const {
    const Vec3 origin = inverse_ * (ray.origin - centre_);
    const Vec3 direction = inverse_ * ray.direction;
    if (!std::visit(
            [&](const auto &surface) { return surface.intersect(origin, direction, t_max, t); },
            surface_)) {
        return false;
    }
    object = origin + t * direction;
    if (const auto *quadric = std::get_if<Quadric>(&surface_)) {
        object = quadric->project(object);
    } else if (std::holds_alternative<Flat>(surface_)) {
        object.z() = 0.0;
    }
    return true;
}

Vec3 Shape::normal(const Vec3 &object) const {
    Vec3 gradient = Vec3::UnitZ();
    if (const auto *quadric = std::get_if<Quadric>(&surface_)) {
        gradient = quadric->gradient(object);
    } else if (const auto *julia = std::get_if<JuliaSet>(&surface_)) {
        gradient = julia->normal(object);
    }
    // Gradients transform by the inverse transpose, mirrored or not (PBRT 4th ed., 3.10.3).
    const Vec3 normal = inverse_.transpose() * gradient;
    const double length = normal.norm();
    return length > 0.0 ? Vec3(normal / length)
                        : Vec3(linear_.col(2).normalized());  // apex of a cone
}

Vec3 Shape::tangent(const Vec3 &object) const {
    const bool round = std::holds_alternative<Quadric>(surface_);
    return linear_ * (round ? Vec3(-object.y(), object.x(), 0.0) : Vec3(Vec3::UnitX()));
}

Eigen::Vector2d Shape::uv(const Vec3 &object) const {
    if (const auto *quadric = std::get_if<Quadric>(&surface_)) {
        return quadric->uv(object);
    }
    switch (kind_) {
        case Kind::disc:
            return 0.5 * (object.head<2>() + Eigen::Vector2d::Ones());
        case Kind::plane:
            return object.head<2>();
        default:
            return Eigen::Vector2d::Zero();
    }
}

Vec3 Shape::spawn_point(const Vec3 &object, const Vec3 &direction) const {
    const Vec3 n = normal(object);
    const Vec3 position = to_world(object);
    // A plane has points at any distance from the origin of its object.
    const double offset = is_bounded()
                              ? offset_
                              : std::max(offset_, relative_offset * position.cwiseAbs().maxCoeff());
    return position + std::copysign(offset, n.dot(direction)) * n;
}

}  // namespace rtrays::reference
