// SPDX-License-Identifier: MIT
// Tests quaternion Julia sets: compares the device's ray marching with dense brute force in double
// precision, and with the one set that has a closed form.
#define FEATURE_shapes 1
#define FEATURE_julia 1
#include "testing/other_features.h"

#include <gtest/gtest.h>

#include "renderer/base/error.h"
#include "renderer/compile/shapes.h"
#include "renderer/kernels/geometry/intersect_shapes.h"
#include "renderer/kernels/geometry/shape_point.h"
#include "renderer/testing/shape_hits.h"
#include "renderer/testing/shapes_double.h"

namespace rtrays::test {
namespace {

constexpr double half_ulp = 0x1p-24;

struct Julia {
    const char *name;
    Eigen::Vector4d c;
    double slice;
    uint32_t iterations;
};

// The sets range from round to dust-like. The last one has |c| > 12, so that its escape radius
// exceeds 4.
const Julia julias[] = {
    {"basilica", {-1, 0.2, 0, 0}, 0, 8},        {"twisted", {-0.450, -0.447, 0.181, 0.306}, 0, 10},
    {"leaves", {-0.2, 0.8, 0, 0}, 0, 11},       {"slice", {0.185, 0.478, 0.125, -0.392}, 0.2, 9},
    {"dust", {-0.3, -0.9, 0.4, -0.1}, 0.05, 6}, {"once", {0.3, 0.4, 0, 0.1}, 0, 1},
    {"large", {-14, 1, 0.5, 0}, 0, 2}};

/// Returns z_n in double precision, with the quaternion product written out.
Eigen::Vector4d iterate(const Julia &julia, const Eigen::Vector3d &p) {
    Eigen::Vector4d z(p.x(), p.y(), p.z(), julia.slice);
    for (uint32_t i = 0; i < julia.iterations && z.squaredNorm() < 1e40; ++i) {
        z = Eigen::Vector4d(z[0] * z[0] - z[1] * z[1] - z[2] * z[2] - z[3] * z[3], 2 * z[0] * z[1],
                            2 * z[0] * z[2], 2 * z[0] * z[3]) +
            julia.c;
    }
    return z;
}

bool outside(const Julia &julia, const Eigen::Vector3d &p) {
    return iterate(julia, p).norm() > 4;
}

Eigen::Vector3d gradient(const Julia &julia, const Eigen::Vector3d &p) {
    const double h = 1e-9;
    Eigen::Vector3d g;
    for (int axis = 0; axis < 3; ++axis) {
        const Eigen::Vector3d step = h * Eigen::Vector3d::Unit(axis);
        g[axis] = (iterate(julia, p + step).norm() - iterate(julia, p - step).norm()) / (2 * h);
    }
    return g;
}

ShapeRecord compile(const Julia &julia,
                    const Eigen::Matrix4d &world_from_object = Eigen::Matrix4d::Identity()) {
    ShapeArrays arrays;
    arrays.name = {julia.name};
    arrays.kind = {Kind::julia};
    arrays.world_from_object = {world_from_object};
    arrays.material = {0};
    arrays.light = {no_index};
    arrays.flare = {0};
    arrays.julia_constant = {julia.c};
    arrays.julia_slice = {julia.slice};
    arrays.julia_iterations = {julia.iterations};
    return compile_shapes(arrays).at(0);
}

/// Returns the set with its constants rounded to float, which define the set on the device.
Julia rounded(Julia julia) {
    julia.c = julia.c.cast<float>().cast<double>();
    julia.slice = static_cast<double>(static_cast<float>(julia.slice));
    return julia;
}

double radius_of(const ShapeRecord &record) {
    return std::sqrt(static_cast<double>(record.bound2));
}

class JuliaSets : public testing::TestWithParam<Julia> {};

// Compares the bound that permits a step with dense samples: all points of a clear step must be on
// one side of the surface.
TEST_P(JuliaSets, ClearStepsDoNotPassTheSurface) {
    const Julia julia = rounded(GetParam());
    const ShapeRecord record = compile(julia);
    const double r = radius_of(record);
    Random random(1);
    Eigen::Vector3d on_surface = Eigen::Vector3d::Zero();  // valid after the first hit
    int clear = 0, rightly = 0;
    for (int i = 0; i < 20'000; ++i) {
        // The points are anywhere within the sphere or near the surface.
        float3 p = to_float3(uniform_direction(random) * r * uniform(random));
        const Eigen::Vector3d aim =
            i % 4 == 0 ? uniform_direction(random) * r * uniform(random) : on_surface;
        const ShapeHit hit = nearest_shape(&record, 1, p, to_float3(aim) - p, INFINITY);
        on_surface = hit.shape != NO_HIT ? to_double(hit.object_point) : on_surface;
        if (i % 2 == 0) {
            p = to_float3(on_surface + uniform_direction(random) * r * log_uniform(random, -5, -1));
        }
        const float3 step = to_float3(uniform_direction(random) * r * log_uniform(random, -4, 0));
        const JuliaProbe probe = probe_julia(&record, p, step, static_cast<float>(r));
        const bool side = outside(julia, to_double(p));
        bool passes = false;
        for (int k = 1; k <= 200; ++k) {
            passes = passes || outside(julia, to_double(p) + k / 200.0 * to_double(step)) != side;
        }
        ASSERT_FALSE(probe.clear && passes);
        ASSERT_TRUE(probe.ratio >= 0.0f && std::isfinite(probe.ratio));
        clear += probe.clear;
        rightly += passes;
    }
    EXPECT_GT(clear, 2'000);
    EXPECT_GT(rightly, 100);
}

/// Returns where the ray first crosses the surface, using dense samples and bisection; infinite if
/// it does not.
double first_crossing(const Julia &julia, const Eigen::Vector3d &o, const Eigen::Vector3d &d,
                      double s, double end, int samples) {
    const bool side = outside(julia, o + s * d);
    const double step = (end - s) / samples;
    for (int i = 1; i <= samples; ++i) {
        double before = s + (i - 1) * step, after = s + i * step;
        if (outside(julia, o + after * d) != side) {
            for (int k = 0; k < 50; ++k) {
                const double between = 0.5 * (before + after);
                (outside(julia, o + between * d) == side ? before : after) = between;
            }
            return after;
        }
    }
    return INFINITY;
}

/// Returns whether a ray may overlook a crossing. It may if it stays on the other side for less
/// than the smallest step, or if it stays nearer to the surface than rounding can resolve.
bool may_overlook(const Julia &julia, const ShapeRecord &record, const Eigen::Vector3d &o,
                  const Eigen::Vector3d &d, double crossing) {
    const double r = radius_of(record), start = crossing + 1e-9 * r;
    const double length =
        first_crossing(julia, o, d, start, crossing + 0.1 * r, 100'000) - crossing;
    if (!(length < 0.1 * r)) {
        return false;
    }
    double deepest = 0;
    for (int i = 1; i < 1'000; ++i) {
        const Eigen::Vector3d p = o + (crossing + i / 1e3 * length) * d;
        const double distance = std::abs(iterate(julia, p).norm() - 4) / gradient(julia, p).norm();
        deepest = std::max(
            deepest, distance / to_double(shape_point(&record, to_float3(p)).error).maxCoeff());
    }
    return length < 0x1p-16 * r * 1.01 || deepest < 1;
}

enum class RaySet { random, grazing, axis, far, inside };
constexpr RaySet ray_sets[] = {RaySet::random, RaySet::grazing, RaySet::axis, RaySet::far,
                               RaySet::inside};

TEST_P(JuliaSets, AreHitWhereBruteForceHitsThem) {
    const Julia julia = rounded(GetParam());
    const ShapeRecord record = compile(julia);
    const double r = radius_of(record);
    Random random(2);
    Eigen::Vector3d on_surface = Eigen::Vector3d::UnitX();
    int hit_count = 0, misses = 0, thin = 0;
    for (int i = 0; i < 1'500; ++i) {
        Eigen::Vector3d target = r * uniform(random) * uniform_direction(random),
                        direction = uniform_direction(random);
        double distance = 2 * r;
        switch (ray_sets[i % 5]) {
            case RaySet::random:
                break;
            case RaySet::grazing: {
                const Eigen::Vector3d n = gradient(julia, on_surface).normalized();
                target = on_surface;
                direction = direction.cross(n).normalized() + n * log_uniform(random, -6, -1);
                break;
            }
            case RaySet::axis:
                direction = Eigen::Vector3d::Unit(i / 5 % 3);
                break;
            case RaySet::far:
                distance = r * log_uniform(random, 1, 5);
                break;
            case RaySet::inside:
                distance = 0;
                break;
        }
        const float3 origin = to_float3(target - distance * direction), way = to_float3(direction);
        const ShapeHit hit = nearest_shape(&record, 1, origin, way, INFINITY);
        ASSERT_EQ(any_shape(&record, 1, origin, way, INFINITY), hit.shape != NO_HIT);
        // Brute force starts at the point nearest to the centre and uses the unit direction.
        const Eigen::Vector3d d = to_double(way).normalized();
        const double shift = distance > 0 ? -to_double(origin).dot(d) : 0.0;
        const Eigen::Vector3d o = to_double(origin) + shift * d;
        const double expected =
            first_crossing(julia, o, d, distance > 0 ? -1.1 * r : 0.0, 1.1 * r, 4'000);
        double s = INFINITY;
        if (hit.shape != NO_HIT) {
            ++hit_count;
            s = (to_double(hit.object_point) - o).dot(d);
            // The point must be on the surface: points at the distance of the rounding error that
            // shape_point states are on different sides.
            const SurfacePoint point = shape_point(&record, hit.object_point);
            const Eigen::Vector3d n = to_double(point.normal), p = to_double(hit.object_point);
            const double h = to_double(point.error).maxCoeff();
            ASSERT_TRUE(outside(julia, p + h * n) && !outside(julia, p - h * n)) << h;
            ASSERT_LT(((p - o) - s * d).norm(), 16 * half_ulp * r);
            ASSERT_NEAR(static_cast<double>(hit.t) * to_double(way).norm(), shift + s,
                        8 * half_ulp * (std::abs(shift) + r));
            ASSERT_EQ(nearest_shape(&record, 1, origin, way, std::nextafter(hit.t, INFINITY)).t,
                      hit.t);
            ASSERT_FALSE(any_shape(&record, 1, origin, way, hit.t));
        }
        if (expected < s - 1e-4 * r) {  // the march overlooked a crossing
            ASSERT_TRUE(may_overlook(julia, record, o, d, expected))
                << "set " << i % 5 << " at " << expected << ", found " << s;
            ++thin;
        }
        misses += hit.shape == NO_HIT;
        on_surface = hit.shape != NO_HIT ? to_double(hit.object_point) : on_surface;
    }
    EXPECT_GT(hit_count, 20);
    EXPECT_GT(misses, 20);
    EXPECT_LT(thin, 15);
}

Eigen::Matrix4d random_map(Random &random) {
    Eigen::Matrix4d map = Eigen::Matrix4d::Identity();
    const double size = log_uniform(random, -3, 3);
    const Eigen::Vector3d axes(log_uniform(random, -0.5, 0), log_uniform(random, -0.5, 0), -1);
    map.topLeftCorner<3, 3>() =
        size * uniform_rotation(random) * axes.asDiagonal() * uniform_rotation(random);
    map.topRightCorner<3, 1>() = 3 * size * uniform_direction(random);
    return map;
}

// Rays leave hits of sets under affine maps. They must start on the intended side, rays from inside
// must hit again, and a hit near the start must be a hit in double precision as well.
TEST_P(JuliaSets, AreNotHitAgainByRaysThatLeave) {
    const Julia julia = rounded(GetParam());
    Random random(3);
    int left = 0, wrong_side = 0, self_hits = 0, leaks = 0, near_hits = 0;
    while (left < 20'000) {
        const ShapeRecord record = compile(julia, random_map(random));
        const double r = radius_of(record);
        Eigen::Matrix4d world_from_object = Eigen::Matrix4d::Identity();  // rounded to float
        for (int i = 0; i < 12; ++i) {
            world_from_object(i / 4, i % 4) =
                static_cast<double>(record.world_from_object[i / 4][i % 4]);
        }
        const Eigen::Matrix4d object_from_world = world_from_object.inverse();
        for (int k = 0; k < 10; ++k) {
            const Eigen::Vector3d target = r * uniform(random) * uniform_direction(random);
            const Eigen::Vector3d from = 2 * r * uniform_direction(random);
            const auto world = [&](const Eigen::Vector3d &p) {
                return Eigen::Vector3d((world_from_object * p.homogeneous()).head<3>());
            };
            const float3 origin = to_float3(world(from));
            const ShapeHit hit = nearest_shape(
                &record, 1, origin, to_float3(world(target) - to_double(origin)), INFINITY);
            if (hit.shape == NO_HIT) {
                continue;
            }
            const SurfacePoint point = shape_point(&record, hit.object_point);
            const Eigen::Vector3d n = to_double(point.normal);
            for (int i = 0; i < 10; ++i, ++left) {
                const double cosine = (i % 2 == 0 ? 1 : -1) *
                                      (i % 4 < 2 ? uniform(random) : log_uniform(random, -7, 0));
                const Eigen::Vector3d tangent = uniform_direction(random).cross(n).normalized();
                const float3 away =
                    to_float3(tangent * std::sqrt(1 - cosine * cosine) + cosine * n);
                const bool front = !(dot(point.normal, away) < 0.0f);
                const float3 start = offset_ray_origin(point, away);
                const ShapeHit next = nearest_shape(&record, 1, start, away, INFINITY);
                const Eigen::Vector3d o =
                    (object_from_world * to_double(start).homogeneous()).head<3>();
                const Eigen::Vector3d w = object_from_world.topLeftCorner<3, 3>() * to_double(away);
                wrong_side += outside(julia, o) != front;
                leaks += !front && next.shape == NO_HIT;
                const double s =
                    next.shape != NO_HIT ? static_cast<double>(next.t) * w.norm() : INFINITY;
                if (s < 0x1p-10 * r) {
                    ++near_hits;
                    self_hits += !std::isfinite(
                        first_crossing(julia, o, w.normalized(), 0, s + 0x1p-16 * r, 2'000));
                }
            }
        }
    }
    EXPECT_EQ(wrong_side, 0);
    EXPECT_EQ(leaks, 0);
    EXPECT_EQ(self_hits, 0);
    // The set of one iteration is smooth.
    EXPECT_EQ(near_hits > 100, julia.iterations > 1) << near_hits;
}

TEST_P(JuliaSets, NormalsAreTheGradient) {
    const Julia julia = rounded(GetParam());
    const ShapeRecord record = compile(julia);
    const double r = radius_of(record);
    Random random(4);
    int checked = 0;
    for (int i = 0; i < 20'000; ++i) {
        const float3 origin = to_float3(2 * r * uniform_direction(random));
        const float3 way =
            to_float3(r * uniform(random) * uniform_direction(random) - to_double(origin));
        const ShapeHit hit = nearest_shape(&record, 1, origin, way, INFINITY);
        if (hit.shape != NO_HIT) {
            const SurfacePoint point = shape_point(&record, hit.object_point);
            const Eigen::Vector3d g = gradient(julia, to_double(hit.object_point));
            // The set has details of size 2^-n, so the normal magnifies the rounding error of a
            // position by 2^n.
            EXPECT_LT((to_double(point.normal) - g.normalized()).norm(),
                      1e-5 + 4e-7 * std::pow(2.0, julia.iterations));
            EXPECT_LT(dot(point.normal, way), 0.0f);  // the normal faces the ray's origin
            ++checked;
        }
    }
    EXPECT_GT(checked, 30);
}

std::string julia_name(const testing::TestParamInfo<Julia> &julia) {
    return julia.param.name;
}

INSTANTIATE_TEST_SUITE_P(Sets, JuliaSets, testing::ValuesIn(julias), julia_name);

// For c = 0, |z_n| = |z|^(2^n), so the set is a sphere of radius 4^(2^-n).
TEST(Julia, IsASphereForTheConstantZero) {
    Random random(7);
    for (const uint32_t iterations : {1u, 4u, 10u}) {
        const ShapeRecord record = compile({"sphere", Eigen::Vector4d::Zero(), 0, iterations});
        const double radius = std::pow(4.0, std::pow(0.5, iterations));
        int hit_count = 0;
        for (int i = 0; i < 3'000; ++i) {
            const float3 origin =
                to_float3((i % 2 == 0 ? 0.5 : 3.0) * radius * uniform_direction(random));
            const float3 way = to_float3(uniform_direction(random));
            const Eigen::Vector3d o = to_double(origin), d = to_double(way).normalized();
            const double b = o.dot(d), discriminant = b * b - o.squaredNorm() + radius * radius;
            const ShapeHit hit = nearest_shape(&record, 1, origin, way, INFINITY);
            if (std::abs(discriminant) < 1e-5) {
                continue;
            }
            const double expected =
                discriminant > 0 ? -b + (i % 2 == 0 ? 1 : -1) * std::sqrt(discriminant) : -1;
            ASSERT_EQ(hit.shape != NO_HIT, expected > 0);
            if (hit.shape != NO_HIT) {
                ++hit_count;
                ASSERT_NEAR(static_cast<double>(hit.t) * to_double(way).norm(), expected,
                            1e-6 * (1 + 1 / std::sqrt(discriminant)));
                const SurfacePoint point = shape_point(&record, hit.object_point);
                ASSERT_LT(
                    (to_double(point.normal) - to_double(hit.object_point).normalized()).norm(),
                    1e-5);
            }
        }
        EXPECT_GT(hit_count, 1'500);
    }
}

// More iterations than float resolves, and rays at the ends of its range, must give neither a NaN
// nor an endless march.
TEST(Julia, ExtremesGiveFiniteHitsOrMisses) {
    Random random(8);
    const float values[] = {0.0f, 1e-38f, 1e-7f,  0.5f,  -1.0f,    1.0f,
                            2.0f, 1e5f,   -1e10f, 3e38f, INFINITY, NAN};
    const auto any_value = [&] {
        return values[std::uniform_int_distribution<size_t>(0, 11)(random)];
    };
    for (const uint32_t iterations : {1u, 12u, 40u, 1000u}) {
        const ShapeRecord record = compile({"deep", {-0.2, 0.8, 0, 0}, 0, iterations});
        int hit_count = 0;
        for (int i = 0; i < 2'000; ++i) {
            const bool plain = i % 2 == 0;
            const float3 origin = plain ? to_float3(4 * uniform_direction(random))
                                        : make_float3(any_value(), any_value(), any_value());
            const float3 way = plain ? to_float3(uniform_direction(random)) - origin
                                     : make_float3(any_value(), any_value(), any_value());
            const ShapeHit hit = nearest_shape(&record, 1, origin, way, INFINITY);
            if (hit.shape != NO_HIT) {
                ++hit_count;
                ASSERT_TRUE(hit.t > 0.0f && std::isfinite(hit.t));
                const SurfacePoint point = shape_point(&record, hit.object_point);
                ASSERT_NEAR(length(point.normal), 1.0f, 1e-6f);
                ASSERT_LT(length(point.error), 0.1f);
            }
        }
        EXPECT_GT(hit_count, 50);
    }
}

TEST(Julia, CompileRefusesEmptyAndHugeSets) {
    EXPECT_THROW(compile({"empty", {-1, 0, 0, 0}, 5, 8}), Error);
    EXPECT_THROW(compile({"huge", {1e9, 0, 0, 0}, 0, 8}), Error);
}

}  // namespace
}  // namespace rtrays::test
