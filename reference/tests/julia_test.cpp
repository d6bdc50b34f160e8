// SPDX-License-Identifier: MIT
#include "reference/julia.h"

#include <gtest/gtest.h>

#include <limits>

#include "reference/rng.h"

namespace rtrays::reference {
namespace {

struct Case {
    const char *name;
    Eigen::Vector4d constant;
    double slice;
    uint32_t iterations;
};

const Case cases[] = {
    {"sphere", {0, 0, 0, 0}, 0.0, 3},
    {"one iteration", {-0.2, 0.8, 0, 0}, 0.1, 1},
    {"figure", {-0.2, 0.6, 0.2, 0.2}, 0.0, 8},
    {"dendrite", {-1.0, 0.2, 0.0, 0.0}, 0.0, 10},
    {"off slice", {-0.125, -0.256, 0.847, 0.0895}, 0.3, 12},
};

Vec3 random_point(Rng &rng, double radius) {
    return radius * Vec3(2 * rng.uniform() - 1, 2 * rng.uniform() - 1, 2 * rng.uniform() - 1);
}

/// Returns the slope of |z_n| along the normal, by central differences.
double slope(const JuliaSet &set, const Vec3 &point) {
    const Vec3 step = 1e-7 * set.normal(point);
    return (set.modulus(point + step) - set.modulus(point - step)) / 2e-7;
}

struct Ray3 {
    Vec3 origin, direction;
};

Ray3 random_ray(Rng &rng) {
    const Vec3 origin = 4.0 * random_point(rng, 1.0).normalized();
    return {origin, random_point(rng, 1.0) - origin};  // not of unit length
}

TEST(Julia, hits_satisfy_the_level_set_and_have_its_gradient) {
    Rng rng(101, 0, 0);
    for (const Case &c : cases) {
        const JuliaSet set(c.constant, c.slice, c.iterations);
        int hits = 0;
        for (int i = 0; i < 3000; ++i) {
            const Ray3 ray = random_ray(rng);
            double t = 0.0;
            if (!set.intersect(ray.origin, ray.direction, std::numeric_limits<double>::infinity(),
                               t)) {
                continue;
            }
            ++hits;
            const Vec3 point = ray.origin + t * ray.direction;
            // The error of the modulus over its slope is a distance.
            const double gradient = slope(set, point);
            ASSERT_GT(gradient, 0.0) << c.name;  // the normal points outwards
            ASSERT_LT(std::abs(set.modulus(point) - 4.0) / gradient, 1e-13) << c.name;
            // The ray comes from outside.
            ASSERT_LT(set.normal(point).dot(ray.direction), 0.0) << c.name;
            // The modulus is constant along every direction in the surface.
            const Frame frame(set.normal(point));
            const Vec3 tangent = frame.to_world({1, 0, 0}), bitangent = frame.to_world({0, 1, 0});
            for (const Vec3 &along : {tangent, bitangent}) {
                const double h = 1e-7;
                const double change =
                    (set.modulus(point + h * along) - set.modulus(point - h * along)) / (2 * h);
                ASSERT_LT(std::abs(change), 1e-3 * gradient) << c.name;
            }
        }
        EXPECT_GT(hits, 500) << c.name;
    }
}

TEST(Julia, nothing_nearer_is_found_by_small_steps) {
    Rng rng(102, 0, 0);
    for (const Case &c : cases) {
        const JuliaSet set(c.constant, c.slice, c.iterations);
        int found = 0;
        for (int i = 0; i < 1500; ++i) {
            const Ray3 ray = random_ray(rng);
            double nearest = std::numeric_limits<double>::infinity();
            for (double t = 0.0; t < 2.0; t += 2e-4) {
                if (set.modulus(ray.origin + t * ray.direction) < 4.0) {
                    nearest = t;
                    break;
                }
            }
            double t = std::numeric_limits<double>::infinity();
            const bool hit = set.intersect(ray.origin, ray.direction, t, t);
            // Small steps may miss a thin part, but they never find a hit that marching misses.
            ASSERT_LE(hit ? t : std::numeric_limits<double>::infinity(), nearest) << c.name;
            found += std::isfinite(nearest);
        }
        EXPECT_GT(found, 200) << c.name;
    }
}

TEST(Julia, rays_from_inside_and_limits_are_respected) {
    const JuliaSet ball(Eigen::Vector4d::Zero(), 0.0, 1);  // |z|^2 = 4: radius 2
    double t = 0.0;
    ASSERT_TRUE(ball.intersect(Vec3::Zero(), Vec3::UnitX(), 10.0, t));
    EXPECT_NEAR(t, 2.0, 1e-14);
    EXPECT_FALSE(ball.intersect(Vec3::Zero(), Vec3::UnitX(), 1.9, t));
    EXPECT_FALSE(ball.intersect({2.0 + 1e-10, 0, 0}, Vec3::UnitX(), 10.0, t));
    ASSERT_TRUE(ball.intersect({2.0 - 1e-10, 0, 0}, Vec3::UnitX(), 10.0, t));
    EXPECT_NEAR(t, 1e-10, 1e-14);
    ASSERT_TRUE(ball.intersect({-9, 0, 0}, 0.5 * Vec3::UnitX(), 100.0, t));
    EXPECT_NEAR(t, 14.0, 1e-13);
    EXPECT_EQ(JuliaSet(Eigen::Vector4d::Zero(), 2.5, 1).bounding_radius(),
              0.0);  // the slice misses the surface
    EXPECT_FALSE(
        JuliaSet(Eigen::Vector4d::Zero(), 2.5, 1).intersect({-9, 0, 0}, Vec3::UnitX(), 100.0, t));
}

TEST(Julia, rays_leave_the_surface_and_grazing_ones_end) {
    Rng rng(103, 0, 0);
    const JuliaSet set(cases[2].constant, 0.0, 8);
    for (int i = 0; i < 300; ++i) {
        const Ray3 ray = random_ray(rng);
        double t = 0.0;
        if (set.intersect(ray.origin, ray.direction, 10.0, t)) {
            const Vec3 point = ray.origin + t * ray.direction;
            const Frame frame(set.normal(point));
            const Vec3 direction = frame.to_world(Vec3(1, 0, 1e-6));
            set.intersect(point + 1e-10 * frame.z(), direction, 10.0, t);
            EXPECT_FALSE(set.intersect(point + 1e-10 * frame.z(), frame.z(), 1e-6, t));
            ASSERT_TRUE(set.intersect(point - 1e-10 * frame.z(), frame.z(), 1e-6, t));
            EXPECT_NEAR(t, 1e-10, 1e-13);
        }
    }
}

}  // namespace
}  // namespace rtrays::reference
