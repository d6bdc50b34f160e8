// SPDX-License-Identifier: MIT
#include "renderer/scene/cores/shape.h"

#include <fmt/format.h>

#include <cmath>
#include <utility>

#include "renderer/scene/cores/transform.h"

namespace rtrays {

namespace {

using Eigen::Vector3d;
using Kind = ShapeArrays::Kind;
using Need = Parameter::Need;

/// Limit of |c|. |z| > 4 gives |z^2 + c| >= 16 - |c| > 4 while |c| < 12, so that the level sets
/// |z_n| = 4 are nested. All Julia sets of visual interest have |c| < 2.
constexpr double largest_julia_constant = 4;

Parameter length(const char *name, const char *help, Need need = Need::required) {
    return {name, help, 1.0, need, ranges::positive};
}

Vector3d unscaled(const ParameterSet &) {
    return {1, 1, 1};
}
Vector3d radius_all(const ParameterSet &p) {
    return Vector3d::Constant(p.number("radius"));
}
Vector3d radius_and_height(const ParameterSet &p) {
    return {p.number("radius"), p.number("radius"), p.number("height")};
}
Vector3d radius_and_half_height(const ParameterSet &p) {
    return {p.number("radius"), p.number("radius"), 0.5 * p.number("height")};
}

void check_julia(const ParameterSet &julia) {
    const double size = julia.get<Eigen::Vector4d>("constant").norm();
    const double n = julia.number("iterations");
    if (size > largest_julia_constant) {
        throw input_error(fmt::format("constant: its length, {}, exceeds the limit of {}", size,
                                      largest_julia_constant));
    }
    if (n != std::floor(n)) {
        throw input_error(fmt::format("iterations: {} is not a whole number", n));
    }
}

}  // namespace

const std::vector<ShapeType> &shape_types() {
    static const ParameterTable round_and_high = {
        length("radius", "radius at z = 0, scene units"),
        length("height", "height along z from 0, scene units")};
    static const std::vector<ShapeType> types = {
        {{"sphere", {length("radius", "radius, scene units", Need::defaulted)}, {}},
         Kind::sphere,
         radius_all},
        {{"ellipsoid",
          {{"radii", "radii along x, y and z, scene units", Vector3d(1, 1, 1), Need::required,
            ranges::positive}},
          {}},
         Kind::sphere,
         [](const ParameterSet &p) { return p.vector3("radii"); }},
        {{"cylinder", round_and_high, {}}, Kind::cylinder, radius_and_height},
        {{"cone", round_and_high, {}}, Kind::cone, radius_and_height},
        {{"paraboloid",
          {length("radius", "radius of the rim at z = height, scene units"),
           length("height", "height along z from 0, scene units")},
          {}},
         Kind::paraboloid,
         radius_and_height},
        {{"hyperboloid",
          {length("radius", "radius of the waist at z = 0, scene units"),
           length("height", "height along z, from -height / 2 to height / 2, scene units"),
           {"flare",
            "the radius of the rims is the radius of the waist times sqrt(1 + flare)",
            1.0,
            Need::required,
            {1e-6, 1e6, true, true}}},
          {}},
         Kind::hyperboloid,
         radius_and_half_height},
        {{"disc", {length("radius", "radius, scene units", Need::defaulted)}, {}},
         Kind::disc,
         radius_all},
        {{"plane", {}, {}}, Kind::plane, unscaled},
        {{"julia",
          {{"constant", "constant c of z <- z^2 + c as (real, i, j, k)",
            Eigen::Vector4d(0, 0, 0, 0), Need::required},
           {"slice",
            "fourth coordinate of the rendered slice",
            0.0,
            Need::defaulted,
            {-4, 4, true, true}},
           {"iterations",
            "number n of iterations for the level set |z_n| = 4",
            10.0,
            Need::defaulted,
            {1, 100, true, true}}},
          check_julia},
         Kind::julia,
         unscaled},
    };
    return types;
}

ShapeCore::ShapeCore(std::string name, const std::string &type, const ParameterValues &values)
    : ParameterCore(std::move(name),
                    static_type<CoreType>(find_type(shape_types(), type, "geometry")), values) {}

Kind ShapeCore::kind() const {
    return static_cast<const ShapeType &>(type()).kind;
}

Eigen::Matrix4d ShapeCore::object_from_canonical() const {
    return scaling(static_cast<const ShapeType &>(type()).scale(parameters()));
}

Eigen::AlignedBox3d ShapeCore::canonical_bounds() const {
    switch (kind()) {
        case Kind::sphere:
            return {Vector3d(-1, -1, -1), Vector3d(1, 1, 1)};
        case Kind::cylinder:
        case Kind::cone:
        case Kind::paraboloid:
            return {Vector3d(-1, -1, 0), Vector3d(1, 1, 1)};
        case Kind::hyperboloid: {
            const double rim = std::sqrt(1 + parameters().number("flare"));
            return {Vector3d(-rim, -rim, -1), Vector3d(rim, rim, 1)};
        }
        case Kind::disc:
            return {Vector3d(-1, -1, 0), Vector3d(1, 1, 0)};
        case Kind::plane:
            return {};
        case Kind::julia: {
            // |z_0| > sqrt(4 + |c|) gives |z_1| >= |z_0|^2 - |c| > 4, and later iterates grow.
            const double r = std::sqrt(4 + parameters().get<Eigen::Vector4d>("constant").norm());
            return {Vector3d(-r, -r, -r), Vector3d(r, r, r)};
        }
    }
    return {};
}

}  // namespace rtrays
