// SPDX-License-Identifier: MIT
// Tests discs and spheres as lights: compares samples with densities using chi-square tests, and
// the integrals of densities with 1.
//
// Seven chi-square tests of the samplers share a family-wise level of 0.01, so each has the level
// 0.01 / 7 (Bonferroni). Planted errors show that the sample counts suffice to detect 2 %.
#define FEATURE_shapes 1
#define FEATURE_quadrics 1
#define FEATURE_shape_lights 1
#include "testing/other_features.h"

#include <gtest/gtest.h>

#include "renderer/base/angles.h"
#include "renderer/kernels/geometry/intersect_shapes.h"
#include "renderer/kernels/light/shape_light.h"
#include "renderer/kernels/sampling/random.h"
#include "renderer/testing/chi_square.h"
#include "renderer/testing/shape_hits.h"
#include "renderer/testing/shapes_double.h"

namespace rtrays::test {
namespace {

constexpr double level = 0.01 / 7;
constexpr uint32_t sample_count = 1'000'000;
constexpr int rings = 20, sectors = 20;

struct Light {
    ShapeRecord shape;
    LightRecord light{};
    Eigen::Matrix3d linear;  ///< linear part of the transform, rounded to float
    Eigen::Vector3d centre;

    Light(Kind kind, const Eigen::Matrix3d &linear_part, const Eigen::Vector3d &position) {
        Shape described;
        described.kind = kind;
        described.world_from_object.topLeftCorner<3, 3>() = linear_part;
        described.world_from_object.topRightCorner<3, 1>() = position;
        shape = compile(described, 0);
        for (int row = 0; row < 3; ++row) {
            for (int column = 0; column < 3; ++column) {
                linear(row, column) = static_cast<double>(shape.world_from_object[row][column]);
            }
            centre[row] = static_cast<double>(shape.world_from_object[row][3]);
        }
        light.kind = kind == Kind::disc ? LIGHT_DISC : LIGHT_SPHERE;
        const double radius2 = linear.col(0).squaredNorm();
        light.area = static_cast<float>(
            kind == Kind::disc ? pi * linear.col(0).cross(linear.col(1)).norm() : 4 * pi * radius2);
    }

    ShapeLightSample sample(float3 from, bool cone, uint32_t i) const {
        const uint4 w = random_words(21, 0, 5, i, 0);
        return sample_shape_light(sampled(cone), &shape, from, uniform_float(w.x),
                                  uniform_float(w.y));
    }

    /// Returns the record that the scene compiler writes if spheres are sampled by cone or by area.
    LightRecord sampled(bool cone) const {
        LightRecord record = light;
        record.kind = light.kind == LIGHT_SPHERE && !cone ? LIGHT_SPHERE_BY_AREA : light.kind;
        return record;
    }

    /// Returns the density per area at a point of the surface, given in object space.
    double pdf_a(float3 from, bool cone, const Eigen::Vector3d &object_point) const {
        return static_cast<double>(shape_light_pdf_a(sampled(cone), &shape, from,
                                                     shape_point(&shape, to_float3(object_point))));
    }
};

struct Result {
    double p;
    double integral;  ///< integral of the density over the light
};

/// Compares sample counts with the integrated density. The bins divide the cosine to `axis` (object
/// space, unit) above `horizon` and the angle about the axis. `planted` raises the density of the
/// upper half of the bins.
Result check_sphere(const Light &light, float3 from, bool cone, const Eigen::Vector3d &axis,
                    double horizon, double planted) {
    const Frame frame = frame_from_z(to_float3(axis));
    const Eigen::Vector3d x = to_double(frame.x), y = to_double(frame.y), z = axis;
    const Eigen::Matrix3d inverse = light.linear.inverse();
    std::vector<uint64_t> observed(rings * sectors);
    uint64_t beyond = 0;
    for (uint32_t i = 0; i < sample_count; ++i) {
        // For a tiny sphere, the normal is precise, but the position is not.
        const Eigen::Vector3d n =
            (inverse * to_double(light.sample(from, cone, i).point.normal)).normalized();
        const double height = (n.dot(z) - horizon) / (1 - horizon);
        const double turn = std::atan2(n.dot(y), n.dot(x)) / (2 * pi) + 0.5;
        beyond += height < -1e-5;
        const int ring = std::clamp(static_cast<int>(height * rings), 0, rings - 1);
        const int sector = std::min(static_cast<int>(turn * sectors), sectors - 1);
        ++observed[static_cast<size_t>(ring * sectors + sector)];
    }
    EXPECT_EQ(beyond, 0u);
    const double radius2 = light.linear.col(0).squaredNorm();
    std::vector<double> expected;
    double integral = 0;
    for (int ring = 0; ring < rings; ++ring) {
        for (int sector = 0; sector < sectors; ++sector) {
            const auto density = [&](double height, double turn) {
                const double c = horizon + height * (1 - horizon), s = std::sqrt(1 - c * c),
                             phi = 2 * pi * (turn - 0.5);
                return light.pdf_a(from, cone,
                                   s * std::cos(phi) * x + s * std::sin(phi) * y + c * z);
            };
            const double probability =
                2 * pi * (1 - horizon) * radius2 *
                integrate(density, double(ring) / rings, (ring + 1.0) / rings,
                          double(sector) / sectors, (sector + 1.0) / sectors);
            integral += probability;
            expected.push_back(sample_count * probability *
                               (ring < rings / 2 ? 1.0 : 1.0 + planted));
        }
    }
    return {chi_square_p(observed, expected), integral};
}

Result check_cone(double radius, double distance, double planted = 0) {
    const Eigen::Matrix3d linear =
        radius * Eigen::AngleAxisd(0.7, Eigen::Vector3d(1, 2, 3).normalized()).toRotationMatrix();
    const Light light(Kind::sphere, linear, {0.3, -0.2, 0.5});
    const Eigen::Vector3d axis = Eigen::Vector3d(-0.4, 0.8, 0.2).normalized();
    const float3 from = to_float3(light.centre + distance * radius * axis);
    const Eigen::Vector3d way = to_double(from) - light.centre;
    return check_sphere(light, from, true, (light.linear.inverse() * way).normalized(),
                        radius / way.norm(), planted);
}

TEST(SphereLight, SamplesItsConeFromAFewRadii) {
    const Result result = check_cone(0.5, 2.5);
    EXPECT_GT(result.p, level);
    EXPECT_NEAR(result.integral, 1, 1e-4);
}

TEST(SphereLight, SamplesItsConeFromNearby) {
    const Result result = check_cone(2, 1.01);
    EXPECT_GT(result.p, level);
    // The density peaks within the first ring; the tolerance is the error of the quadrature.
    EXPECT_NEAR(result.integral, 1, 1e-2);
}

TEST(SphereLight, SamplesItsConeWhenTinyAndFar) {
    const Result result = check_cone(1e-2, 1e5);
    EXPECT_GT(result.p, level);
    EXPECT_NEAR(result.integral, 1, 1e-4);
}

TEST(SphereLight, PlantedErrorOfTwoPercentInTheConeIsRejected) {
    EXPECT_LT(check_cone(0.5, 2.5, 0.02).p, level);
}

Result check_area(bool inside, double planted = 0) {
    const Light light(Kind::sphere, 1.5 * Eigen::Matrix3d::Identity(), {1, 2, 3});
    const float3 from = to_float3(light.centre + (inside ? 0.5 : 4.0) * Eigen::Vector3d::UnitX());
    // Sampling by cone is requested only for points inside, where it must fall back to area.
    return check_sphere(light, from, inside, Eigen::Vector3d::UnitZ(), -1, planted);
}

TEST(SphereLight, SamplesItsAreaOnRequest) {
    const Result result = check_area(false);
    EXPECT_GT(result.p, level);
    EXPECT_NEAR(result.integral, 1, 1e-5);
}

TEST(SphereLight, SamplesItsAreaFromInside) {
    const Result result = check_area(true);
    EXPECT_GT(result.p, level);
    EXPECT_NEAR(result.integral, 1, 1e-5);
}

TEST(SphereLight, PlantedErrorOfTwoPercentInTheAreaIsRejected) {
    EXPECT_LT(check_area(false, 0.02).p, level);
}

/// Compares sample counts in bins of radius and angle in the disc's plane with the density times
/// the bin's area in world space.
Result check_disc(const Eigen::Matrix3d &linear, double planted = 0) {
    const Light light(Kind::disc, linear, {-1, 0, 2});
    const float3 from = make_float3(5, 5, 5);
    std::vector<uint64_t> observed(rings * sectors);
    const Eigen::Matrix3d inverse = light.linear.inverse();
    for (uint32_t i = 0; i < sample_count; ++i) {
        const Eigen::Vector3d p =
            inverse * (to_double(light.sample(from, true, i).point.position) - light.centre);
        const int ring = std::min(static_cast<int>(p.head<2>().norm() * rings), rings - 1);
        const int sector = std::min(
            static_cast<int>((std::atan2(p.y(), p.x()) / (2 * pi) + 0.5) * sectors), sectors - 1);
        ++observed[static_cast<size_t>(ring * sectors + sector)];
    }
    const double stretch = light.linear.col(0).cross(light.linear.col(1)).norm();
    std::vector<double> expected;
    double integral = 0;
    for (int ring = 0; ring < rings; ++ring) {
        for (int sector = 0; sector < sectors; ++sector) {
            const double area = stretch * pi * (2 * ring + 1) / (rings * rings * sectors);
            const double probability = light.pdf_a(from, true, {(ring + 0.5) / rings, 0, 0}) * area;
            integral += probability;
            expected.push_back(sample_count * probability *
                               (ring < rings / 2 ? 1.0 : 1.0 + planted));
        }
    }
    return {chi_square_p(observed, expected), integral};
}

Eigen::Matrix3d skewed() {
    Eigen::Matrix3d linear;
    linear << 2, 0.5, 0.1, -0.3, 0.2, 1, 0.7, -1, 0.4;
    return linear;
}

TEST(DiscLight, SamplesItsArea) {
    const Result result = check_disc(0.25 * Eigen::Matrix3d::Identity());
    EXPECT_GT(result.p, level);
    EXPECT_NEAR(result.integral, 1, 1e-6);
}

TEST(DiscLight, SamplesItsAreaUnderAnAffineMap) {
    const Result result = check_disc(skewed());
    EXPECT_GT(result.p, level);
    EXPECT_NEAR(result.integral, 1, 1e-6);
}

TEST(DiscLight, PlantedErrorOfTwoPercentIsRejected) {
    EXPECT_LT(check_disc(skewed(), 0.02).p, level);
}

// For spheres of any size and any point `from`, samples must be on the sphere. Samples by cone must
// be visible from `from`, and the estimate of the solid angle, cos / (d^2 pdf_a), must equal that
// of the cone for every sample.
TEST(SphereLight, EverySampleOfAConeCarriesItsSolidAngle) {
    Random random(9);
    int cones = 0;
    for (uint32_t i = 0; i < 200'000; ++i) {
        const double radius = log_uniform(random, -6, 6), distance = 1 + log_uniform(random, -5, 5);
        const Light light(Kind::sphere, radius * uniform_rotation(random),
                          radius * uniform(random, 0, 3) * uniform_direction(random));
        const float3 from = to_float3(light.centre + distance * radius * uniform_direction(random));
        const ShapeLightSample sample = light.sample(from, true, i);
        const Eigen::Vector3d n = to_double(sample.point.normal),
                              p = to_double(sample.point.position);
        const double r = light.linear.col(0).norm();
        ASSERT_LT((p - light.centre - r * n).norm(), 2e-6 * (r + light.centre.norm()));
        const Eigen::Vector3d axis = to_double(from) - light.centre;
        const double sin2 = r * r / axis.squaredNorm();
        const Eigen::Vector3d way = to_double(from) - p;
        const double projected = n.dot(way);
        const auto pdf_a = static_cast<double>(sample.pdf_a);
        ASSERT_TRUE(std::isfinite(pdf_a) && pdf_a >= 0);
        if (sin2 > 1 / 1.0003) {
            continue;  // sampled by area
        }
        ++cones;
        const double solid_angle = 2 * pi * sin2 / (1 + std::sqrt(1 - sin2));
        if (projected > 1e-3 * way.norm()) {
            ASSERT_NEAR(projected / (way.squaredNorm() * way.norm()) / pdf_a / solid_angle, 1, 1e-3)
                << distance;
        } else {
            ASSERT_GT(projected, -2e-3 * way.norm());  // above the horizon, up to rounding
        }
    }
    EXPECT_GT(cones, 150'000);
}

// Traces shadow rays like the stages, from up to 1e6 radii. A light must not hide its own points.
TEST(ShapeLights, DoNotShadowThemselves) {
    Random random(19);
    int rays = 0, hidden = 0;
    for (uint32_t i = 0; i < 600'000; ++i) {
        const double radius = log_uniform(random, -3, 3), distance = 1 + log_uniform(random, -2, 6);
        const double offset = i % 3 == 0   ? 0
                              : i % 3 == 1 ? radius
                                           : radius * distance;  // distance to the origin
        const Light light(i % 2 == 0 ? Kind::sphere : Kind::disc, radius * uniform_rotation(random),
                          offset * uniform_direction(random));
        const float3 from = to_float3(light.centre + distance * radius * uniform_direction(random));
        const ShapeLightSample sample = light.sample(from, i % 4 < 2, i);
        const float3 way = sample.point.position - from;
        if (dot(sample.point.normal, way) < 0.0f) {
            ++rays;
            hidden += any_shape(&light.shape, 1, from, offset_ray_origin(sample.point, -way) - from,
                                1.0f);
        }
    }
    EXPECT_EQ(hidden, 0);
    EXPECT_GT(rays, 200'000);
}

TEST(SphereLight, FromTheCentreAndTheSurfaceAreaIsSampled) {
    const Light light(Kind::sphere, Eigen::Matrix3d::Identity(), Eigen::Vector3d::Zero());
    for (const float3 from : {make_float3(0, 0, 0), make_float3(0, 0, 1),
                              make_float3(0.6f, 0.8f, 0), make_float3(0, 1.00005f, 0)}) {
        for (uint32_t i = 0; i < 1'000; ++i) {
            EXPECT_EQ(light.sample(from, true, i).pdf_a, 1.0f / light.light.area);
        }
    }
}

}  // namespace
}  // namespace rtrays::test
