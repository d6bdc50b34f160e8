// SPDX-License-Identifier: MIT
// Tests that grazing rays do not enter closed mirrors: the reflected ray must leave on the side of
// the incident ray. The code is compiled for a scene of shapes alone, in which shading normals
// equal geometric normals.
#define FEATURE_smooth_normals 0
#include "renderer/testing/bsdf_cases.h"

#include <gtest/gtest.h>

#include "renderer/kernels/geometry/intersect_shapes.h"
#include "renderer/kernels/geometry/shape_point.h"
#include "renderer/testing/shape_hits.h"
#include "renderer/testing/shapes_double.h"

namespace rtrays::test {
namespace {

/// Returns a ball of random size, within ten times its size from the origin.
Shape random_ball(Random &random) {
    Shape ball;
    ball.kind = Kind::sphere;
    const double size = log_uniform(random, -3, 3);
    ball.world_from_object.topLeftCorner<3, 3>() = size * uniform_rotation(random);
    ball.world_from_object.topRightCorner<3, 1>() =
        uniform(random, 0, 10) * size * uniform_direction(random);
    return ball;
}

TEST(Mirrors, KeepGrazingRaysOutside) {
    const TestMaterial mirror{"mirror", {component(BXDF_IDEAL_REFLECTION)}};
    Random random(1);
    size_t reflected = 0;
    for (int i = 0; i < 400000; ++i) {
        const ShapeRecord ball = compile(random_ball(random));
        const SurfacePoint point = shape_point(&ball, to_float3(uniform_direction(random)));
        const Eigen::Vector3d n = to_double(point.normal);
        const Eigen::Vector3d across = uniform_direction(random).cross(n).normalized();
        const float3 wo = to_float3(across + n * log_uniform(random, -9, -4));
        if (!(dot(point.normal, wo) > 0.0f)) {
            continue;  // rounding moved the origin inside
        }
        const SurfaceFrame frame = make_surface_frame(
            point.normal, point.normal, make_float3(0.0f, 0.0f, 0.0f), make_float2(0.0f, 0.0f), wo);
        const BsdfSample sample = mirror.sample(frame, 0.5f, 0.5f, 0.5f);
        if (!(sample.pdf_w > 0.0f)) {
            continue;
        }
        ++reflected;
        ASSERT_EQ(
            nearest_shape(&ball, 1, offset_ray_origin(point, sample.wi), sample.wi, INFINITY).shape,
            NO_HIT)
            << "cosine " << dot(point.normal, wo);
    }
    EXPECT_GT(reflected, 100000u);
}

}  // namespace
}  // namespace rtrays::test
