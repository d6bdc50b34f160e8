// SPDX-License-Identifier: MIT
#include "renderer/compile/shapes.h"

#include <fmt/format.h>

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "renderer/base/error.h"

namespace rtrays {

namespace {

using Kind = ShapeArrays::Kind;

constexpr float unbounded = INFINITY;  ///< z is not clipped
/// Factor on bound2. Without it, rounding could clip surfaces that the bound touches.
constexpr double margin = 1.0 + 0x1p-10;

/// Device parameters of a canonical quadric. A hyperboloid's b and bounds depend on its flare.
struct Quadric {
    float a, b, c, d;
    float z_lower, z_upper;
    double bound2;
    uint32_t uv_kind;
};

Quadric quadric_of(Kind kind, double flare) {
    switch (kind) {
        case Kind::sphere:
            return {1, 1, 0, -1, -unbounded, unbounded, margin, SHAPE_UV_SPHERE};
        case Kind::cylinder:
            return {1, 0, 0, -1, 0, 1, 2 * margin, SHAPE_UV_HEIGHT};
        // The apex is at the origin, so that nothing cancels near it.
        case Kind::cone:
            return {1, -1, 0, 0, -1, 0, 2 * margin, SHAPE_UV_DEPTH};
        // The surface has no points below 0. By rounding, a clip there could make a hole at the
        // apex.
        case Kind::paraboloid:
            return {1, 0, -1, 0, -unbounded, 1, 2 * margin, SHAPE_UV_HEIGHT};
        case Kind::hyperboloid:
            return {1,
                    static_cast<float>(-flare),
                    0,
                    -1,
                    -1,
                    1,
                    (2 + flare) * margin,
                    SHAPE_UV_SYMMETRIC};
        case Kind::disc:
            return {0, 0, 1, 0, -unbounded, unbounded, 1, SHAPE_UV_DISC};
        case Kind::plane:
            return {0, 0, 1, 0, -unbounded, unbounded, SHAPE_UNBOUNDED, SHAPE_UV_PLANE};
        case Kind::julia:
            break;
    }
    throw std::logic_error("not a quadric");
}

void set_transform(const Eigen::Matrix4d &world_from_object, ShapeRecord &record) {
    const Eigen::Matrix<float, 3, 4> world = world_from_object.topRows<3>().cast<float>();
    // Inverts the rounded matrix, so that only the rounding of the inverse separates the two from
    // exact inverses.
    const Eigen::Matrix3d linear = world.leftCols<3>().cast<double>();
    const Eigen::Matrix3d exact_inverse = linear.inverse();
    const Eigen::Matrix3f inverse = exact_inverse.cast<float>();
    for (int row = 0; row < 3; ++row) {
        std::copy_n(Eigen::RowVector4f(world.row(row)).data(), 4, record.world_from_object[row]);
        std::copy_n(Eigen::RowVector3f(inverse.row(row)).data(), 3, record.object_from_world[row]);
    }
    record.error2 = static_cast<float>(
        std::pow(16 * std::ldexp(1.0, -24) * linear.norm() * exact_inverse.norm(), 2));
    if (!world.allFinite() || !inverse.allFinite()) {
        throw input_error("the transform cannot be inverted in single precision");
    }
}

/// Sets the parameters of the surface |z_n| = 4. Its bound follows from the last iterate back to
/// the first: |z_k+1| <= r requires |z_k|^2 <= r + |c|.
void set_julia(const Eigen::Vector4d &constant, double slice, uint32_t iterations,
               ShapeRecord &record) {
    const double modulus = constant.norm();
    if (!(modulus <= 1e6)) {
        throw input_error("the modulus of the Julia constant must be at most 1e6");
    }
    double radius = 4;
    for (uint32_t i = 0; i < iterations; ++i) {
        radius = std::sqrt(radius + modulus);
    }
    const double bound2 = radius * radius - slice * slice;
    if (!(bound2 > 1e-6 * radius * radius)) {
        throw input_error(fmt::format("the Julia set does not reach slice {}", slice));
    }
    record.iterations = iterations;
    record.a = static_cast<float>(constant[0]);
    record.b = static_cast<float>(constant[1]);
    record.c = static_cast<float>(constant[2]);
    record.d = static_cast<float>(constant[3]);
    record.z_lower = static_cast<float>(slice);
    // From this radius on r^2 - |c| >= r, so that |z| stays at least r.
    record.z_upper = static_cast<float>(
        std::max(4.0, (1.0 + 1e-6) * (1.0 + std::sqrt(1.0 + 4.0 * modulus)) / 2.0));
    record.bound2 = static_cast<float>(bound2 * margin);
    record.uv_kind = SHAPE_UV_NONE;
}

}  // namespace

std::vector<ShapeRecord> compile_shapes(const ShapeArrays &shapes) {
    std::vector<ShapeRecord> records;
    records.reserve(shapes.kind.size());
    for (size_t i = 0; i < shapes.kind.size(); ++i) {
        ShapeRecord record{};
        const Kind kind = shapes.kind[i];
        record.kind = kind == Kind::julia ? SHAPE_JULIA : SHAPE_QUADRIC;
        record.material = shapes.material[i];
        record.light = NO_EMITTER;  // compile_lights sets it for shapes that emit
        record.opacity = OPAQUE;    // compile_opacity sets it for shapes that are not
        try {
            Eigen::Matrix4d world_from_object = shapes.world_from_object[i];
            if (kind == Kind::julia) {
                set_julia(shapes.julia_constant[i], shapes.julia_slice[i],
                          shapes.julia_iterations[i], record);
            } else {
                const Quadric quadric = quadric_of(kind, shapes.flare[i]);
                record.a = quadric.a;
                record.b = quadric.b;
                record.c = quadric.c;
                record.d = quadric.d;
                record.z_lower = quadric.z_lower;
                record.z_upper = quadric.z_upper;
                record.bound2 = static_cast<float>(quadric.bound2);
                record.uv_kind = quadric.uv_kind;
            }
            if (kind == Kind::cone) {
                world_from_object.col(3) += world_from_object.col(2);
            }
            set_transform(world_from_object, record);
        } catch (const Error &error) {
            throw input_error(fmt::format("shape '{}': {}", shapes.name[i], error.what()));
        }
        records.push_back(record);
    }
    return records;
}

std::vector<ShapeBounds> bound_shapes(const std::vector<ShapeRecord> &shapes) {
    std::vector<ShapeBounds> bounds((shapes.size() + SHAPE_LANES - 1) / SHAPE_LANES);
    for (size_t i = 0; i < shapes.size(); ++i) {
        const ShapeRecord &shape = shapes[i];
        ShapeBounds &to = bounds[i / SHAPE_LANES];
        const size_t lane = i % SHAPE_LANES;
        Eigen::Matrix3d linear;
        for (int row = 0; row < 3; ++row) {
            to.centre[row][lane] = shape.world_from_object[row][3];
            for (int column = 0; column < 3; ++column) {
                linear(row, column) = shape.world_from_object[row][column];
            }
        }
        // (R + e)^2 <= 1.05 R^2 + 21 e^2, where R is the object's radius times the largest stretch
        // of the transform.
        const double stretch = linear.jacobiSvd().singularValues()[0];
        const bool bounded = shape.bound2 < SHAPE_UNBOUNDED;
        to.bound2[lane] =
            bounded ? static_cast<float>(1.05 * stretch * stretch * shape.bound2) : INFINITY;
        to.error2[lane] = 21.0f * shape.error2;
    }
    return bounds;
}

FeatureMask shape_features(const ShapeArrays &shapes) {
    const auto julias =
        static_cast<size_t>(std::count(shapes.kind.begin(), shapes.kind.end(), Kind::julia));
    return FeatureMask()
        .with(Feature::shapes, !shapes.kind.empty())
        .with(Feature::julia, julias > 0)
        .with(Feature::quadrics, shapes.kind.size() > julias);
}

}  // namespace rtrays
