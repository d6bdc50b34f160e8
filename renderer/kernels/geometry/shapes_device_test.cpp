// SPDX-License-Identifier: MIT
// Tests shapes on the OpenCL device: the hits are those of the host, and hit points are robust
// origins of rays.
#define FEATURE_shapes 1
#define FEATURE_quadrics 1
#define FEATURE_julia 1
#include "testing/other_features.h"

#include <gtest/gtest.h>

#include "renderer/compile/shapes.h"
#include "renderer/device/kernel.h"
#include "renderer/kernels/geometry/intersect_shapes.h"
#include "renderer/kernels/geometry/shape_point.h"
#include "renderer/testing/shape_hits.h"
#include "renderer/testing/shapes_double.h"

namespace rtrays::test {
namespace {

// The input has 9 floats per ray: origin, direction, direction of the ray that leaves the hit. The
// output is t, shape, shape that `any` finds, whether the ray left to the front, t and shape of the
// next hit. Shapes are floats, -1 for a miss.
const char *const kernel_source = R"(
#include "renderer/kernels/geometry/intersect_shapes.h"
#include "renderer/kernels/geometry/shape_point.h"

__kernel void trace(__global const ShapeRecord *shapes, __global const ShapeBounds *bounds,
                    __global const ShapeBounds *single_bounds, uint shape_count, __global const float *rays,
                    __global float *hits, uint ray_count) {
    const uint i = get_global_id(0);
    if (i >= ray_count) {
        return;
    }
    __global const float *r = rays + 9u * i;
    __global float *out = hits + 6u * i;
    const float3 origin = make_float3(r[0], r[1], r[2]);
    const float3 direction = make_float3(r[3], r[4], r[5]);
    const float3 away = make_float3(r[6], r[7], r[8]);
    const ShapeHit hit = nearest_shape(shapes, bounds, shape_count, origin, direction, INFINITY,
                                       all_opaque());
    out[0] = hit.t;
    out[1] = hit.shape == NO_HIT ? -1.0f : (float)hit.shape;
    out[2] = any_shape(shapes, bounds, shape_count, origin, direction, INFINITY, all_opaque())
                 ? 1.0f : 0.0f;
    out[3] = 0.0f;
    out[4] = 0.0f;
    out[5] = -1.0f;
    if (hit.shape != NO_HIT) {
        const SurfacePoint point = shape_point(shapes + hit.shape, hit.object_point);
        const ShapeHit next = nearest_shape(shapes + hit.shape, single_bounds + hit.shape, 1u,
                                            offset_ray_origin(point, away), away, INFINITY,
                                            all_opaque());
        out[3] = dot(point.normal, away) < 0.0f ? 0.0f : 1.0f;
        out[4] = next.t;
        out[5] = next.shape == NO_HIT ? -1.0f : 1.0f;
    }
}
)";

TEST(ShapesOnDevice, HitsAndDeparturesAreThoseOfTheHost) {
    ShapeArrays arrays;
    Random random(31);
    for (int i = 0; i < 8; ++i) {
        Eigen::Matrix4d world_from_object = Eigen::Matrix4d::Identity();
        world_from_object.topLeftCorner<3, 3>() =
            uniform_rotation(random) * Eigen::Vector3d(1, 0.7, 0.4).asDiagonal();
        world_from_object.topRightCorner<3, 1>() = 3 * uniform_direction(random);
        arrays.name.push_back("shape");
        arrays.kind.push_back(static_cast<Kind>(i));  // one shape of each type
        arrays.world_from_object.push_back(world_from_object);
        arrays.material.push_back(0);
        arrays.light.push_back(no_index);
        arrays.flare.push_back(0.5);
        arrays.julia_constant.emplace_back(-0.45, -0.447, 0.181, 0.306);
        arrays.julia_slice.push_back(0);
        arrays.julia_iterations.push_back(8);
    }
    const std::vector<ShapeRecord> shapes = compile_shapes(arrays);
    constexpr uint32_t count = 100'000;
    std::vector<float> rays;
    for (uint32_t i = 0; i < count; ++i) {
        const Eigen::Vector3d origin = 6 * uniform_direction(random);
        const Eigen::Vector3d direction = arrays.world_from_object[i % 8].topRightCorner<3, 1>() +
                                          uniform_direction(random) - origin;
        for (const Eigen::Vector3d &v : {origin, direction, uniform_direction(random)}) {
            rays.insert(rays.end(), {static_cast<float>(v.x()), static_cast<float>(v.y()),
                                     static_cast<float>(v.z())});
        }
    }

    DeviceContext device;
    const Program program(device, {"kernels/trace_shapes.cl"}, shape_features(arrays).defines(),
                          {{"kernels/trace_shapes.cl", kernel_source}});
    Kernel kernel(program, "trace", 64);
    std::vector<ShapeBounds> single_bounds;
    for (const ShapeRecord &shape : shapes) {
        single_bounds.push_back(bound_shapes({shape}).front());
    }
    const Buffer<ShapeRecord> shape_buffer(device, "shapes", shapes);
    const Buffer<ShapeBounds> bounds_buffer(device, "bounds", bound_shapes(shapes)),
        single_buffer(device, "single", single_bounds);
    const Buffer<float> ray_buffer(device, "rays", rays), hit_buffer(device, "hits", 6 * count);
    kernel.bind({shape_buffer, bounds_buffer, single_buffer, 8u, ray_buffer, hit_buffer, count});
    kernel.enqueue(count);
    const std::vector<float> hits = hit_buffer.read();

    uint32_t found = 0, different = 0, closed = 0;
    for (uint32_t i = 0; i < count; ++i) {
        const float *r = &rays[9 * i], *out = &hits[6 * i];
        const ShapeHit expected = nearest_shape(shapes.data(), 8, make_float3(r[0], r[1], r[2]),
                                                make_float3(r[3], r[4], r[5]), INFINITY);
        const bool hit = out[1] >= 0.0f;
        ASSERT_EQ(out[2] > 0.0f, hit);
        // Built-in functions of the device may round differently, so grazing rays may hit or miss.
        different += hit ? out[1] != static_cast<float>(expected.shape) ||
                               std::abs(out[0] - expected.t) > 1e-5f * expected.t
                         : expected.shape != NO_HIT;
        found += hit;
        const Kind kind = hit ? static_cast<Kind>(static_cast<int>(out[1])) : Kind::plane;
        if (kind == Kind::sphere) {  // closed and convex: hit again exactly if left inwards
            ASSERT_EQ(out[5] >= 0.0f, out[3] == 0.0f) << i;
            ++closed;
        } else if (hit && kind == Kind::julia && out[3] == 0.0f) {  // closed
            ASSERT_GE(out[5], 0.0f) << i;
            ++closed;
        } else if (hit && (kind == Kind::plane || kind == Kind::disc)) {
            ASSERT_LT(out[5], 0.0f) << i;
        }
    }
    EXPECT_GT(found, count / 2);
    EXPECT_GT(closed, count / 20);
    EXPECT_LT(different, count / 1000);  // 0 on PoCL
}

}  // namespace
}  // namespace rtrays::test
