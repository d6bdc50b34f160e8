// SPDX-License-Identifier: MIT
// Traces an array of rays: the tests' view of the traversal functions, and the ray-rate benchmark.
// Reads nodes, triangles, rays; writes hits (trace_nearest_rays) or flags (trace_any_rays).
#include "renderer/kernels/traversal/intersect_bvh.h"
#include "renderer/kernels/traversal/trace_records.h"
#include "renderer/shared/compat.h"

__kernel void trace_nearest_rays(GLOBAL const BvhNode *nodes, GLOBAL const LeafTriangle *triangles,
                                 GLOBAL const RayRecord *rays, uint ray_count, GLOBAL HitRecord *hits) {
    const uint i = (uint)get_global_id(0);
    if (i >= ray_count) {
        return;
    }
    const RayRecord ray = rays[i];
    const Hit hit =
        trace_nearest(nodes, triangles, make_float3(ray.origin[0], ray.origin[1], ray.origin[2]),
                      make_float3(ray.direction[0], ray.direction[1], ray.direction[2]), ray.t_max);
    HitRecord record;
    record.t = hit.t;
    record.u = hit.u;
    record.v = hit.v;
    record.triangle = hit.triangle;
    hits[i] = record;
}

__kernel void trace_any_rays(GLOBAL const BvhNode *nodes, GLOBAL const LeafTriangle *triangles,
                             GLOBAL const RayRecord *rays, uint ray_count, GLOBAL uint *occluded) {
    const uint i = (uint)get_global_id(0);
    if (i >= ray_count) {
        return;
    }
    const RayRecord ray = rays[i];
    occluded[i] = trace_any(nodes, triangles, make_float3(ray.origin[0], ray.origin[1], ray.origin[2]),
                            make_float3(ray.direction[0], ray.direction[1], ray.direction[2]), ray.t_max)
                      ? 1u
                      : 0u;
}
