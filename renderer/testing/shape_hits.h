// SPDX-License-Identifier: MIT
// Intersection of shapes on the host. Each call also tests that the bounding balls do not exclude a
// shape that is hit. The functions are static, like those of the kernels, because each file
// compiles only the types of shape that it tests.
#pragma once

#include <gtest/gtest.h>

#include <vector>

#include "renderer/compile/shapes.h"
#include "renderer/kernels/geometry/intersect_shapes.h"
#include "renderer/testing/shapes_double.h"

namespace rtrays::test {

/// Returns the record of a quadric, disc or plane. `light` is the index of its light.
inline ShapeRecord compile(const Shape &shape, uint32_t light = no_index) {
    ShapeArrays arrays;
    arrays.name = {"shape"};
    arrays.kind = {shape.kind};
    arrays.world_from_object = {shape.world_from_object};
    arrays.material = {0};
    arrays.light = {light};
    arrays.flare = {shape.flare};
    arrays.julia_constant = {Eigen::Vector4d::Zero()};
    arrays.julia_slice = {0};
    arrays.julia_iterations = {0};
    return compile_shapes(arrays).at(0);
}

DEVICE ShapeHit nearest_shape(const ShapeRecord *shapes, uint count, float3 origin,
                              float3 direction, float t_max) {
    const OpacityTest opaque = all_opaque();
    ShapeHit expected{t_max, NO_HIT, {0, 0, 0}};
    for (uint i = 0; i < count; ++i) {
        float t;
        float3 object_point;
        if (intersect_shape(shapes, i, origin, direction, expected.t, &opaque, &t, &object_point)) {
            expected = {t, i, object_point};
        }
    }
    const std::vector<ShapeBounds> bounds = bound_shapes({shapes, shapes + count});
    const ShapeHit hit =
        ::nearest_shape(shapes, bounds.data(), count, origin, direction, t_max, opaque);
    EXPECT_EQ(hit.shape, expected.shape);
    EXPECT_EQ(hit.t, expected.t);
    return hit;
}

DEVICE bool any_shape(const ShapeRecord *shapes, uint count, float3 origin, float3 direction,
                      float t_max) {
    const std::vector<ShapeBounds> bounds = bound_shapes({shapes, shapes + count});
    return ::any_shape(shapes, bounds.data(), count, origin, direction, t_max, all_opaque());
}

}  // namespace rtrays::test
