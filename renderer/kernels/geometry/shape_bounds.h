// SPDX-License-Identifier: MIT
// Bounding balls of the shapes of a scene, tested in groups of eight.
//
// They tell which shapes a ray may hit. Most rays miss most shapes, and a shape's own test would
// first transform the ray.
#pragma once

#include "renderer/shared/compat.h"
#include "renderer/shared/scene_records.h"

/// Returns the bits of the shapes that intersect_shape may find at 0 < t < t_max, among the first
/// `count` of eight shapes, or among all eight if `count` is larger.
///
/// Let p be the ray's origin relative to the centre, and d its direction of any length. The line
/// passes the centre at distance |p x d| / |d|, nearest at t = -p.d / d.d. Let the ray miss a ball
/// of radius R by e = 16 u k |p|, as in misses_bound (shape_space.h). Then the shape's own test
/// finds no hit, because its hits are in the ball up to a rounding error below e; so is the
/// rounding error here. bound2 + error2 p.p is at least (R + e)^2. Where products underflow, a test
/// with the smallest difference excludes nothing. NaN and infinity keep the shape.
DEVICE uint shapes_in_reach(GLOBAL const ShapeBounds *bounds, uint count, float3 origin,
                            float3 direction, float t_max) {
    const float8 px = splat_float8(origin.x) - vload8(0, bounds->centre[0]);
    const float8 py = splat_float8(origin.y) - vload8(0, bounds->centre[1]);
    const float8 pz = splat_float8(origin.z) - vload8(0, bounds->centre[2]);
    const float8 squared = px * px + py * py + pz * pz;
    const float8 reach2 = vload8(0, bounds->bound2) + vload8(0, bounds->error2) * squared;
    const float8 mx = py * direction.z - pz * direction.y;
    const float8 my = pz * direction.x - px * direction.z;
    const float8 mz = px * direction.y - py * direction.x;
    const float direction2 = dot(direction, direction);
    const float8 bound = reach2 * direction2 + 1e-36f;
    const float8 towards = -(px * direction.x + py * direction.y + pz * direction.z);
    const float8 short_by = towards - t_max * direction2;
    const uint missed = lane_bits(mx * mx + my * my + mz * mz > bound) |
                        lane_bits((short_by > 0.0f) & (short_by * short_by > bound)) |
                        lane_bits((towards <= 0.0f) & (squared > reach2 + 1e-36f));
    return ~missed & (count < SHAPE_LANES ? (1u << count) - 1u : 0xffu);
}
