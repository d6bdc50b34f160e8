// SPDX-License-Identifier: MIT
// Quadrics, discs and planes: hits against brute force on the implicit functions, and closed
// surfaces.
#include "reference/shape.h"

#include <gtest/gtest.h>

#include <limits>

#include "reference/geometry.h"
#include "reference/sampling.h"
#include "reference/tests/test_scenes.h"
#include "renderer/base/error.h"

namespace rtrays::reference {
namespace {

using Kind = ShapeArrays::Kind;

const std::vector<Kind> all_kinds{Kind::sphere,      Kind::cylinder, Kind::cone, Kind::paraboloid,
                                  Kind::hyperboloid, Kind::disc,     Kind::plane};

/// Evaluates the definitions of renderer/scene/stores.h, with flare 1.
double implicit(Kind kind, const Vec3 &p) {
    const double r2 = p.x() * p.x() + p.y() * p.y();
    switch (kind) {
        case Kind::sphere:
            return r2 + p.z() * p.z() - 1;
        case Kind::cylinder:
            return r2 - 1;
        case Kind::cone:
            return r2 - (1 - p.z()) * (1 - p.z());
        case Kind::paraboloid:
            return r2 - p.z();
        case Kind::hyperboloid:
            return r2 - 1 - p.z() * p.z();
        default:
            return p.z();
    }
}

bool in_range(Kind kind, const Vec3 &p, double slack) {
    switch (kind) {
        case Kind::cylinder:
        case Kind::cone:
        case Kind::paraboloid:
            return p.z() >= -slack && p.z() <= 1 + slack;
        case Kind::hyperboloid:
            return std::abs(p.z()) <= 1 + slack;
        case Kind::disc:
            return p.head<2>().norm() <= 1 + slack;
        default:
            return true;
    }
}

Vec3 random_vector(Rng &rng) {
    return {2 * rng.uniform() - 1, 2 * rng.uniform() - 1, 2 * rng.uniform() - 1};
}

/// Returns a transform with rotation, unequal scales and shear, and with a reflection if
/// `mirrored`.
Eigen::Matrix4d random_transform(Rng &rng, bool mirrored) {
    Eigen::Matrix4d transform = Eigen::Matrix4d::Identity();
    do {
        for (int c = 0; c < 3; ++c) {
            transform.block<3, 1>(0, c) = 1.5 * random_vector(rng);
        }
    } while (std::abs(transform.topLeftCorner<3, 3>().determinant()) < 0.3);
    if ((transform.topLeftCorner<3, 3>().determinant() < 0) != mirrored) {
        transform.col(0) *= -1;
    }
    transform.topRightCorner<3, 1>() = 3.0 * random_vector(rng);
    return transform;
}

/// Returns a ray from around the shape towards a point in the cube of its object space.
Ray random_ray(Rng &rng, const Shape &shape) {
    const Vec3 origin = shape.centre() + 4.0 * random_vector(rng);
    return {origin, (shape.to_world(random_vector(rng)) - origin).normalized()};
}

/// Returns the first sign change of the implicit function in range, found by 4000 steps and
/// bisection.
double brute_force(Kind kind, const Eigen::Matrix4d &world_from_object, const Ray &ray,
                   double range) {
    const Eigen::Affine3d inverse = Eigen::Affine3d(world_from_object).inverse();
    const auto at = [&](double t) { return Vec3(inverse * Vec3(ray.origin + t * ray.direction)); };
    constexpr int steps = 4000;
    double before = implicit(kind, at(0.0));
    for (int i = 1; i <= steps; ++i) {
        const double now = implicit(kind, at(range * i / steps));
        if ((now > 0) != (before > 0)) {
            double low = range * (i - 1) / steps, high = range * i / steps;
            for (int k = 0; k < 60; ++k) {
                const double mid = 0.5 * (low + high);
                ((implicit(kind, at(mid)) > 0) == (before > 0) ? low : high) = mid;
            }
            if (in_range(kind, at(high), -1e-9)) {
                return high;
            }
        }
        before = now;
    }
    return std::numeric_limits<double>::infinity();
}

TEST(Shape, hits_are_those_of_brute_force) {
    Rng rng(111, 0, 0);
    for (const Kind kind : all_kinds) {
        int hits = 0, missed_by_steps = 0;
        for (int i = 0; i < 3000; ++i) {
            TestScene scene;
            const Eigen::Matrix4d transform = random_transform(rng, i % 2 == 1);
            scene.add_shape(kind, transform, 0);
            const Shape shape(scene.shapes, 0);
            const Ray ray = random_ray(rng, shape);
            double t = std::numeric_limits<double>::infinity();
            Vec3 object = Vec3::Zero();
            const bool hit = shape.intersect(ray, t, t, object);
            const double expected = brute_force(kind, transform, ray, 20.0);
            if (hit) {
                ++hits;
                ASSERT_NEAR(implicit(kind, object), 0.0, 1e-12);
                ASSERT_TRUE(in_range(kind, object, 1e-9));
                ASSERT_NEAR((shape.to_world(object) - ray.origin - t * ray.direction).norm(), 0.0,
                            1e-8 + 1e-9 * t);
                // Steps may jump over two crossings, but they find no nearer one.
                ASSERT_LE(t, expected + 1e-8);
                missed_by_steps += t < expected - 1e-8 && t < 20.0;
            } else {
                ASSERT_FALSE(std::isfinite(expected)) << static_cast<int>(kind) << " " << i;
            }
        }
        EXPECT_GT(hits, 200) << static_cast<int>(kind);
        EXPECT_LT(missed_by_steps, 30) << static_cast<int>(kind);
    }
}

TEST(Shape, normals_follow_the_gradient_and_coordinates_the_tangent) {
    Rng rng(112, 0, 0);
    for (const Kind kind : all_kinds) {
        for (int i = 0; i < 500; ++i) {
            TestScene scene;
            const Eigen::Matrix4d transform = random_transform(rng, i % 2 == 1);
            scene.add_shape(kind, transform, 0);
            const Shape shape(scene.shapes, 0);
            const Ray ray = random_ray(rng, shape);
            double t = std::numeric_limits<double>::infinity();
            Vec3 object = Vec3::Zero();
            if (!shape.intersect(ray, t, t, object) || object.head<2>().norm() < 0.05) {
                continue;
            }
            const Eigen::Affine3d inverse = Eigen::Affine3d(transform).inverse();
            const Vec3 world = shape.to_world(object), normal = shape.normal(object);
            const auto value = [&](const Vec3 &p) { return implicit(kind, inverse * p); };
            const double h = 1e-6;
            Vec3 gradient;
            for (int k = 0; k < 3; ++k) {
                gradient[k] =
                    (value(world + h * Vec3::Unit(k)) - value(world - h * Vec3::Unit(k))) / (2 * h);
            }
            ASSERT_NEAR((gradient.normalized() - normal).norm(), 0.0, 1e-6);
            const Vec3 tangent = shape.tangent(object);
            ASSERT_NEAR(tangent.dot(normal), 0.0, 1e-9 * tangent.norm());
            const Vec3 along = object + h * (inverse.linear() * tangent);
            Eigen::Vector2d change = shape.uv(along) - shape.uv(object);
            change.x() -= std::round(change.x());  // across the seam
            ASSERT_GT(change.x(), 0.0);
            ASSERT_LT(std::abs(change.y()), 1e-3 * change.x());
        }
    }
}

TEST(Shape, coordinates_are_as_documented) {
    const auto uv = [](Kind kind, const Vec3 &object) {
        TestScene scene;
        scene.add_shape(kind, Eigen::Matrix4d::Identity(), 0);
        return Shape(scene.shapes, 0).uv(object);
    };
    const auto expect = [](const Eigen::Vector2d &value, double u, double v) {
        EXPECT_NEAR((value - Eigen::Vector2d(u, v)).norm(), 0.0, 1e-15);
    };
    expect(uv(Kind::sphere, {0, 1, 0}), 0.25, 0.5);
    expect(uv(Kind::sphere, {0, 0, 1}), 0.0, 1.0);
    expect(uv(Kind::sphere, Vec3(0, -1, 1).normalized()), 0.75, 0.75);
    expect(uv(Kind::cylinder, {-1, 0, 0.3}), 0.5, 0.3);
    expect(uv(Kind::hyperboloid, {1, 0, 0}), 0.0, 0.5);
    expect(uv(Kind::disc, {0.5, -0.5, 0}), 0.75, 0.25);
    expect(uv(Kind::plane, {7, -3, 0}), 7, -3);
}

struct Placement {
    const char *name;
    double scale;
    Vec3 offset;  ///< in units of the scale
};

class ClosedSphere : public testing::TestWithParam<Placement> {};

TEST_P(ClosedSphere, neither_leaks_nor_hits_itself) {
    // Inside a sphere, the chord of a ray at the angle theta to the normal is 2 r cos(theta), even
    // at grazing angles.
    const Placement &p = GetParam();
    TestScene scene;
    scene.add_shape(Kind::sphere, placed(p.scale * p.offset, p.scale), 0);
    const Geometry geometry(scene.meshes, scene.shapes);
    Rng rng(113, 0, 0);
    Ray ray{p.scale * p.offset, Vec3(0.3, -0.5, 0.8).normalized()};
    for (int i = 0; i < 500000; ++i) {
        SurfacePoint hit;
        ASSERT_TRUE(geometry.intersect(ray, Coherence::incoherent, hit)) << i;
        Vec3 local = sample_cosine_hemisphere(rng);
        if (i % 8 == 0) {
            local.z() = 1e-3 * rng.uniform() + 1e-6;
            local.normalize();
        }
        const Vec3 normal = geometry.normal(hit);
        ray.direction = Frame(-normal).to_world(local);
        ray.origin = geometry.spawn_point(hit, ray.direction);
        SurfacePoint next;
        ASSERT_TRUE(geometry.intersect(ray, Coherence::incoherent, next)) << i;
        const double chord = (next.position - hit.position).norm();
        // A start off the surface lengthens the chord by offset / cos(theta).
        const double offset = 1e-10 * (p.offset.cwiseAbs().maxCoeff() + 1.0);
        ASSERT_NEAR(chord / p.scale, 2.0 * local.z(), 1.1 * offset / local.z() + 1e-12) << i;
        // Outwards the ray hits nothing, although it starts on the surface.
        const Vec3 out = Frame(normal).to_world(local);
        ASSERT_FALSE(geometry.occluded({geometry.spawn_point(hit, out), out})) << i;
    }
}

INSTANTIATE_TEST_SUITE_P(placements, ClosedSphere,
                         testing::Values(Placement{"origin", 1.0, Vec3::Zero()},
                                         Placement{"tiny", 1e-6, Vec3::Zero()},
                                         Placement{"huge", 1e6, Vec3::Zero()},
                                         Placement{"moved", 1.0, Vec3(148.376, 12.34, -223.423)}),
                         [](const auto &param_info) { return std::string(param_info.param.name); });

TEST(Shape, stands_among_triangles_and_planes) {
    TestScene scene;
    scene.add_quad({Vec3(-1, 2, -1), Vec3(-1, 2, 1), Vec3(1, 2, 1), Vec3(1, 2, -1)}, 0);
    scene.add_shape(Kind::sphere, placed({0, 1, 0}, 0.5), 1);
    Eigen::Matrix4d floor = Eigen::Matrix4d::Identity();
    floor.topLeftCorner<3, 3>() =
        Eigen::AngleAxisd(-0.5 * pi, Vec3::UnitX()).toRotationMatrix();  // +z up
    scene.add_shape(Kind::plane, floor, 2);
    const Geometry geometry(scene.meshes, scene.shapes);
    const auto first_hit = [&](const Vec3 &origin, const Vec3 &direction) {
        SurfacePoint hit;
        EXPECT_TRUE(geometry.intersect({origin, direction}, Coherence::coherent, hit));
        return geometry.material(hit);
    };
    EXPECT_EQ(first_hit({0, 5, 0}, -Vec3::UnitY()), 0u);
    EXPECT_EQ(first_hit({0, 1.9, 0}, -Vec3::UnitY()), 1u);
    EXPECT_EQ(first_hit({0.7, 1.9, 0}, -Vec3::UnitY()), 2u);
    EXPECT_EQ(first_hit({0, 1, 0}, Vec3::UnitY()), 1u);  // from inside
    EXPECT_TRUE(geometry.occluded(Vec3(0, 0.1, 0), Vec3(0, 1.9, 0)));
    EXPECT_FALSE(geometry.occluded(Vec3(0.7, 0.1, 0), Vec3(0.7, 1.9, 0)));
    EXPECT_TRUE(geometry.occluded(Vec3(7, 0.1, 0), Vec3(7, -0.1, 0)));
    EXPECT_TRUE(geometry.occluded({Vec3(1e6, 5, 0), -Vec3::UnitY()}));
    EXPECT_FALSE(geometry.occluded({Vec3(1e6, 5, 0), Vec3::UnitY()}));
    // The plane has no bounds, so the scene's bounds ignore it.
    EXPECT_EQ(geometry.bounds().min(), Vec3(-1, 0.5, -1));
    EXPECT_EQ(geometry.bounds().max(), Vec3(1, 2, 1));
    SurfacePoint hit;
    ASSERT_TRUE(geometry.intersect({Vec3(1e6, 3, 7), -Vec3::UnitY()}, Coherence::coherent, hit));
    EXPECT_NEAR((geometry.normal(hit) - Vec3::UnitY()).norm(), 0.0, 1e-15);
    EXPECT_NEAR((hit.position - Vec3(1e6, 0, 7)).norm(), 0.0, 1e-9);
}

TEST(Shape, refuses_transforms_and_parameters_out_of_range) {
    TestScene scene;
    scene.add_shape(Kind::hyperboloid, Eigen::Matrix4d::Identity(), 0);
    scene.shapes.flare[0] = 0.0;
    EXPECT_THROW(Shape(scene.shapes, 0), Error);
    scene.shapes.flare[0] = 1.0;
    scene.shapes.world_from_object[0].col(0).setZero();
    EXPECT_THROW(Shape(scene.shapes, 0), Error);
    scene.shapes.world_from_object[0].setIdentity();
    scene.shapes.kind[0] = Kind::julia;
    EXPECT_THROW(Shape(scene.shapes, 0), Error);  // no iterations
    scene.shapes.julia_iterations[0] = 5;
    EXPECT_NO_THROW(Shape(scene.shapes, 0));
}

}  // namespace
}  // namespace rtrays::reference
