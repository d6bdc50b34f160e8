// SPDX-License-Identifier: MIT
// Tests quadrics, discs and planes: compares the device code with extended precision. The rays are
// random, grazing, axis-parallel, from far away and from inside; the shapes have random affine
// maps.
#define FEATURE_shapes 1
#define FEATURE_quadrics 1
#include "testing/other_features.h"

#include <gtest/gtest.h>

#include "renderer/base/error.h"
#include "renderer/kernels/geometry/intersect_shapes.h"
#include "renderer/kernels/geometry/shape_point.h"
#include "renderer/testing/shape_hits.h"
#include "renderer/testing/shapes_double.h"

namespace rtrays::test {
namespace {

constexpr Kind quadrics[] = {Kind::sphere,      Kind::cylinder, Kind::cone, Kind::paraboloid,
                             Kind::hyperboloid, Kind::disc,     Kind::plane};
constexpr double half_ulp = 0x1p-24;

/// Returns a shape under a random affine map: ratio of axes up to `ratio`, mirrored half the time,
/// overall size 1e-6 to 1e6, at a distance of up to ten times its size from the origin.
Shape random_shape(Kind kind, double ratio, Random &random) {
    Shape shape;
    shape.kind = kind;
    shape.flare = kind == Kind::hyperboloid ? log_uniform(random, -2, 1) : 0;
    const double size = log_uniform(random, -6, 6);
    Eigen::Vector3d axes;
    for (int i = 0; i < 3; ++i) {
        axes[i] = size / log_uniform(random, 0, std::log10(ratio));
    }
    axes.x() = uniform(random) < 0.5 ? -axes.x() : axes.x();
    shape.world_from_object.topLeftCorner<3, 3>() =
        uniform_rotation(random) * axes.asDiagonal() *
        (ratio > 1 ? uniform_rotation(random) : Eigen::Matrix3d::Identity());
    shape.world_from_object.topRightCorner<3, 1>() =
        uniform(random, 0, 10) * size * uniform_direction(random);
    return shape;
}

struct Ray {
    float3 origin, direction;
};

enum class RaySet { random, grazing, object_axis, world_axis, far, inside };
constexpr RaySet ray_sets[] = {RaySet::random,     RaySet::grazing, RaySet::object_axis,
                               RaySet::world_axis, RaySet::far,     RaySet::inside};

Ray make_ray(const Shape &shape, RaySet set, Random &random) {
    const Eigen::Matrix3d linear = shape.linear();
    const double size = linear.norm();
    const Eigen::Vector3d p = shape.surface_point(random);
    Eigen::Vector3d target = linear * p + shape.centre();
    Eigen::Vector3d direction = uniform_direction(random);
    double distance = size * uniform(random, 0, 3);
    switch (set) {
        case RaySet::random:
            target += size * uniform(random, 0, 1) * uniform_direction(random);
            break;
        case RaySet::grazing: {
            const Eigen::Vector3d g = shape.gradient(p.cast<Real>()).cast<double>();
            const Eigen::Vector3d n = (linear.inverse().transpose() * g).normalized();
            direction =
                (direction.cross(n).normalized() + n * log_uniform(random, -7, -1)).normalized();
            break;
        }
        case RaySet::object_axis:
            direction = linear.col(std::uniform_int_distribution<int>(0, 2)(random)).normalized();
            break;
        case RaySet::world_axis:
            direction = Eigen::Vector3d::Unit(std::uniform_int_distribution<int>(0, 2)(random));
            break;
        case RaySet::far:
            distance = size * log_uniform(random, 1, 5);
            target += size * uniform(random, 0, 0.5) * uniform_direction(random);
            break;
        case RaySet::inside:
            target = shape.centre() + 0.9 * linear * (p.norm() > 1 ? p / p.norm() : p);
            distance = 0;
            break;
    }
    direction = uniform(random) < 0.5 ? direction : Eigen::Vector3d(-direction);
    return {to_float3(target - distance * direction),
            to_float3(direction * log_uniform(random, -6, 6))};
}

/// Returns the point of a hit in the object space of ShapeArrays.
Vector3r canonical(Kind kind, float3 object_point) {
    Vector3r p = to_double(object_point).cast<Real>();
    p.z() += kind == Kind::cone ? 1 : 0;
    return p;
}

class Quadrics : public testing::TestWithParam<Kind> {};

/// Checks hits, misses, distances and points of `count` rays per set. Tolerances are backward
/// errors: a result is right if it is exact for a ray within 64 half ulps of the size of shape and
/// coordinates.
void check_against_double(Kind kind, double ratio, int count) {
    Random random(1000 + static_cast<uint64_t>(kind));
    int hit_count = 0;
    for (const RaySet set : ray_sets) {
        for (int i = 0; i < count; ++i) {
            const Shape shape = random_shape(kind, ratio, random);
            const ShapeRecord record = compile(shape);
            const Ray ray = make_ray(shape, set, random);
            const ShapeHit hit = nearest_shape(&record, 1, ray.origin, ray.direction, INFINITY);
            const Eigen::Vector3d o = to_double(ray.origin), d = to_double(ray.direction);
            const bool found = hit.shape != NO_HIT;
            const double t = found ? static_cast<double>(hit.t) : static_cast<double>(INFINITY);
            double tolerance = 64 * half_ulp * shape.scale();
            if (kind == Kind::plane) {  // a plane has no size, so use its distance along the ray
                tolerance += 16 * half_ulp * shape.condition() *
                             ((o - shape.centre()).norm() + (found ? t * d.norm() : 0.0));
            }
            ASSERT_TRUE(nothing_before(shape, o, d, t, tolerance, random))
                << "set " << static_cast<int>(set) << " t " << t;
            ASSERT_EQ(any_shape(&record, 1, ray.origin, ray.direction, INFINITY), found);
            if (found) {
                ++hit_count;
                const Vector3r p = canonical(kind, hit.object_point);
                const double off =
                    static_cast<double>(std::abs(shape.value(p)) / shape.gradient(p).norm());
                ASSERT_LE(off, 8 * half_ulp * std::max(1.0, static_cast<double>(p.norm())))
                    << static_cast<int>(set);
                ASSERT_FALSE(shape.clipped(p * (1 - 1e-6)) && shape.clipped(p * (1 + 1e-6)));
                const double from_ray =
                    (shape.linear() * p.cast<double>() + shape.centre() - (o + t * d)).norm();
                ASSERT_LE(from_ray, tolerance + 8 * half_ulp * t * d.norm())
                    << static_cast<int>(set);
                // t_max is exclusive and has no other effect.
                ASSERT_FALSE(any_shape(&record, 1, ray.origin, ray.direction, hit.t));
                ASSERT_EQ(nearest_shape(&record, 1, ray.origin, ray.direction,
                                        std::nextafter(hit.t, INFINITY))
                              .t,
                          hit.t);
            }
        }
    }
    EXPECT_GT(hit_count, count);
}

TEST_P(Quadrics, AgreeWithExtendedPrecisionUnderSimilarities) {
    check_against_double(GetParam(), 1, 20'000);
}
TEST_P(Quadrics, AgreeWithExtendedPrecisionUnderAffineMaps) {
    check_against_double(GetParam(), 100, 20'000);
}

struct Departures {
    int rays = 0;
    int hits = 0;       ///< hits of the same shape, legitimate or not
    int self_hits = 0;  ///< hits of the point that the ray left
    int leaks = 0;      ///< rays through a sphere or an ellipsoid, or hits of it from outside
};

/// Traces rays that leave a hit to either side, at all angles down to 1e-8. A ray that leaves a
/// quadric at t = 0 meets it again at -2 B / A or not at all, and offsets only increase that
/// distance. `error_factor` scales the error bound of the point.
Departures leave(Kind kind, int count, float error_factor) {
    Random random(2000 + static_cast<uint64_t>(kind));
    Departures departures;
    for (int k = 0; departures.rays < count; ++k) {
        const Shape shape = random_shape(kind, k % 2 == 0 ? 1 : 100, random);
        const ShapeRecord record = compile(shape);
        const Ray ray = make_ray(shape, ray_sets[k / 2 % 6], random);
        const ShapeHit hit = nearest_shape(&record, 1, ray.origin, ray.direction, INFINITY);
        if (hit.shape == NO_HIT) {
            continue;
        }
        SurfacePoint point = shape_point(&record, hit.object_point);
        point.error *= error_factor;
        const Eigen::Vector3d n = to_double(point.normal);
        for (int i = 0; i < 10; ++i, ++departures.rays) {
            const double cosine =
                (i % 2 == 0 ? 1 : -1) * (i % 4 < 2 ? uniform(random) : log_uniform(random, -8, 0));
            const Eigen::Vector3d tangent = uniform_direction(random).cross(n).normalized();
            const float3 away = to_float3((tangent * std::sqrt(1 - cosine * cosine) + cosine * n) *
                                          log_uniform(random, -6, 6));
            const bool front = !(dot(point.normal, away) < 0.0f);
            const ShapeHit next =
                nearest_shape(&record, 1, offset_ray_origin(point, away), away, INFINITY);
            const Vector3r d = shape.linear().cast<Real>().inverse() * to_double(away).cast<Real>();
            const RayQuadratic q =
                along_ray(shape, canonical(kind, hit.object_point), d / d.norm());
            const bool returns = front ? q.a < 0 : q.a > 0;
            const auto chord = static_cast<double>(returns ? std::abs(2 * q.b / q.a) : INFINITY);
            if (next.shape != NO_HIT) {
                ++departures.hits;
                const double way =
                    static_cast<double>(next.t) * static_cast<double>(d.norm());  // in object space
                // The local size of a cone is that of its ring.
                const double local_size = kind == Kind::cone ? length(hit.object_point) : 1;
                departures.self_hits += way < 0.5 * std::min(chord, 0.2 * local_size);
            }
            departures.leaks += kind == Kind::sphere && (next.shape != NO_HIT) == front;
        }
    }
    return departures;
}

TEST_P(Quadrics, AreNotHitAgainByRaysThatLeave) {
    const Departures departures = leave(GetParam(), 200'000, 1.0f);
    EXPECT_EQ(departures.self_hits, 0);
    EXPECT_EQ(departures.leaks, 0);
    const bool concave_inside = GetParam() != Kind::disc && GetParam() != Kind::plane;
    EXPECT_EQ(departures.hits > departures.rays / 20, concave_inside) << departures.hits;
}

// The error bound is necessary: without it, rays hit the point that they left or leak.
TEST_P(Quadrics, AreHitAgainWhenTheErrorIsUnderstated) {
    const Departures departures = leave(GetParam(), 200'000, 0.0f);
    EXPECT_GT(departures.self_hits + departures.leaks, 0);
}

TEST_P(Quadrics, PointsAndNormalsAreThoseOfTheSurface) {
    const Kind kind = GetParam();
    Random random(3000 + static_cast<uint64_t>(kind));
    for (int i = 0; i < 20'000; ++i) {
        const Shape shape = random_shape(kind, 10, random);
        const ShapeRecord record = compile(shape);
        Eigen::Vector3d p = shape.surface_point(random);
        p.z() -= kind == Kind::cone ? 1 : 0;
        const float3 object_point = to_float3(p);
        const SurfacePoint point = shape_point(&record, object_point);
        const Vector3r exact = canonical(kind, object_point);
        const Eigen::Vector3d world = shape.linear() * exact.cast<double>() + shape.centre();
        for (int axis = 0; axis < 3; ++axis) {
            ASSERT_LE(std::abs(to_double(point.position)[axis] - world[axis]),
                      to_double(point.error)[axis]);
            ASSERT_LE(to_double(point.error)[axis], 1e-4 * shape.scale());
        }
        const Eigen::Vector3d g =
            shape.linear().inverse().transpose() * shape.gradient(exact).cast<double>();
        ASSERT_LT((to_double(point.normal) - g.normalized()).norm(), 1e-4);
    }
}

/// Returns (u, v), as ShapeArrays defines them.
Eigen::Vector2d canonical_uv(Kind kind, const Eigen::Vector3d &p) {
    const double turn = std::atan2(p.y(), p.x()) / (2 * M_PI), u = turn < 0 ? turn + 1 : turn;
    switch (kind) {
        case Kind::sphere:
            return {u, 1 - std::acos(p.z()) / M_PI};
        case Kind::hyperboloid:
            return {u, (p.z() + 1) / 2};
        case Kind::disc:
            return {(p.x() + 1) / 2, (p.y() + 1) / 2};
        case Kind::plane:
            return {p.x(), p.y()};
        default:
            return {u, p.z()};
    }
}

// Compares texture coordinates with their definition, and the tangent with the difference of two
// points along u.
TEST_P(Quadrics, TextureCoordinatesAndTangentsAreThoseDefined) {
    const Kind kind = GetParam();
    Random random(4000 + static_cast<uint64_t>(kind));
    for (int i = 0; i < 5'000; ++i) {
        const Shape shape = random_shape(kind, 10, random);
        const ShapeRecord record = compile(shape);
        const Eigen::Vector3d p = shape.surface_point(random);
        const auto object_point = [&](Eigen::Vector3d q) {
            return to_float3(q - Eigen::Vector3d(0, 0, kind == Kind::cone ? 1 : 0));
        };
        const float2 uv = shape_uv(&record, object_point(p));
        const Eigen::Vector2d expected = canonical_uv(kind, p);
        const double around = std::abs(static_cast<double>(uv.x) - expected.x());
        ASSERT_LT(
            std::min(around,
                     kind == Kind::plane || kind == Kind::disc ? around : std::abs(1 - around)),
            3e-6);
        ASSERT_NEAR(static_cast<double>(uv.y), expected.y(), 3e-6);
        if (kind != Kind::plane) {
            ASSERT_GE(std::min(uv.x, uv.y), 0.0f);
            ASSERT_LE(std::max(uv.x, uv.y), 1.0f);
        }
        const double h = 1e-6;
        Eigen::Vector3d next = p + Eigen::Vector3d(kind == Kind::disc ? 2 * h : h, 0, 0);
        if (kind != Kind::plane && kind != Kind::disc) {
            next = Eigen::AngleAxisd(2 * M_PI * h, Eigen::Vector3d::UnitZ()) * p;
        }
        const Eigen::Vector3d tangent = shape.linear() * (next - p) / h;
        ASSERT_LT((to_double(shape_tangent(&record, object_point(p))) - tangent).norm(),
                  1e-4 * shape.linear().norm());
    }
}

const char *const kind_names[] = {"sphere",      "cylinder", "cone", "paraboloid",
                                  "hyperboloid", "disc",     "plane"};

std::string kind_name(const testing::TestParamInfo<Kind> &kind) {
    return kind_names[static_cast<int>(kind.param)];
}

INSTANTIATE_TEST_SUITE_P(Kinds, Quadrics, testing::ValuesIn(quadrics), kind_name);

// Among many shapes, the nearest hit is found, and `any` is true exactly if there is one, for
// finite t_max as well.
TEST(Shapes, AnyIsTrueExactlyWhereANearestExists) {
    Random random(5);
    std::vector<ShapeRecord> records;
    for (int i = 0; i < 14; ++i) {
        Shape shape;
        shape.kind = quadrics[i % 6];
        shape.flare = 0.5;
        shape.world_from_object.topLeftCorner<3, 3>() = 0.3 * uniform_rotation(random);
        shape.world_from_object.topRightCorner<3, 1>() =
            2 * uniform_direction(random) * uniform(random);
        records.push_back(compile(shape));
    }
    int both = 0;
    for (int i = 0; i < 100'000; ++i) {
        const float3 origin = to_float3(3 * uniform_direction(random)),
                     direction = to_float3(uniform_direction(random));
        const auto t_max = static_cast<float>(i % 3 == 0 ? INFINITY : uniform(random, 0, 5));
        const ShapeHit hit = nearest_shape(records.data(), 14, origin, direction, t_max);
        ASSERT_EQ(hit.shape != NO_HIT, any_shape(records.data(), 14, origin, direction, t_max));
        float nearest = t_max;
        for (const ShapeRecord &record : records) {
            nearest = std::min(nearest, nearest_shape(&record, 1, origin, direction, t_max).t);
        }
        ASSERT_EQ(hit.t, nearest);
        both += hit.shape != NO_HIT;
    }
    EXPECT_GT(both, 1'000);
}

// Bounding balls exclude most shapes for most rays, but never a shape whose centre the ray passes.
TEST(Shapes, BallsLeaveOutWhatARayMisses) {
    Random random(8);
    std::vector<ShapeRecord> records;
    for (int i = 0; i < 8; ++i) {
        Shape shape;
        shape.kind = i == 7 ? Kind::plane : Kind::sphere;
        shape.world_from_object.topLeftCorner<3, 3>() *= 0.25;
        shape.world_from_object.topRightCorner<3, 1>() = uniform_direction(random);
        records.push_back(compile(shape));
    }
    const std::vector<ShapeBounds> bounds = bound_shapes(records);
    uint32_t kept = 0;
    constexpr uint32_t rays = 100'000;
    for (uint32_t i = 0; i < rays; ++i) {
        const float3 origin = to_float3(3 * uniform_direction(random));
        const uint32_t target = i % 8;
        const float3 centre = shape_centre(&records[target]);
        ASSERT_TRUE(shapes_in_reach(bounds.data(), 8, origin, centre - origin, 1.0f) &
                    1u << target);
        const uint32_t short_of =
            shapes_in_reach(bounds.data(), 8, origin, 0.5f * (centre - origin), 1.0f);
        const uint32_t away = shapes_in_reach(bounds.data(), 8, origin, origin - centre, INFINITY);
        ASSERT_EQ(short_of >> target & 1u, target == 7) << i;
        ASSERT_EQ(away >> target & 1u, target == 7) << i;
        kept += static_cast<uint32_t>(__builtin_popcount(shapes_in_reach(
            bounds.data(), 7, origin, to_float3(uniform_direction(random)), INFINITY)));
    }
    // A ball covers the fraction (1 - sqrt(1 - 0.26^2 / r^2)) / 2 of all directions, r in [2, 4].
    EXPECT_LT(kept, 7 * rays / 50);
}

// Rays and shapes at the ends of the range of float give a miss or a finite hit, never a NaN.
TEST(Shapes, ExtremeRaysGiveFiniteHitsOrMisses) {
    Random random(6);
    const float values[] = {0.0f, -0.0f, 1e-45f, 1e-38f, -1e-20f, 1e-7f, 0.5f,     -1.0f,
                            1.0f, 2.0f,  1e5f,   -1e10f, 1e20f,   3e38f, INFINITY, NAN};
    const auto any_value = [&] {
        return values[std::uniform_int_distribution<size_t>(0, 15)(random)];
    };
    for (int i = 0; i < 700'000; ++i) {
        Shape shape;
        shape.kind = quadrics[i % 7];
        shape.flare = 1;
        shape.world_from_object.topLeftCorner<3, 3>() *= i % 3 == 0   ? 1.0
                                                         : i % 3 == 1 ? 1e-12
                                                                      : 1e12;
        const ShapeRecord record = compile(shape);
        const float3 origin = make_float3(any_value(), any_value(), any_value());
        const float3 direction = make_float3(any_value(), any_value(), any_value());
        const ShapeHit hit = nearest_shape(&record, 1, origin, direction, INFINITY);
        if (hit.shape != NO_HIT) {
            ASSERT_TRUE(hit.t > 0.0f && std::isfinite(hit.t));
            const SurfacePoint point = shape_point(&record, hit.object_point);
            for (const float3 v : {hit.object_point, point.position, point.error}) {
                ASSERT_TRUE(std::isfinite(v.x) && std::isfinite(v.y) && std::isfinite(v.z))
                    << kind_names[i % 7];
            }
            ASSERT_NEAR(length(point.normal), 1.0f, 1e-6f);
        }
    }
}

TEST(Shapes, CompileRefusesWhatFloatCannotHold) {
    Shape shape;
    shape.world_from_object.topLeftCorner<3, 3>() *= 1e-300;
    EXPECT_THROW(compile(shape), Error);
    shape.world_from_object.topLeftCorner<3, 3>() *= 1e300;
    shape.world_from_object(0, 3) = 1e300;
    EXPECT_THROW(compile(shape), Error);
}

}  // namespace
}  // namespace rtrays::test
