// SPDX-License-Identifier: MIT
// Traces an array of rays: the tests' view of the traversal functions on a device.
// Reads nodes, triangles, rays; writes hits (trace_nearest_rays) or flags (trace_any_rays).
#include "renderer/kernels/traversal/intersect_bvh.h"
#include "renderer/kernels/traversal/ray_record.h"

__kernel void trace_nearest_rays(GLOBAL const BvhNode *nodes, GLOBAL const LeafTriangle *triangles,
                                 GLOBAL const RayRecord *rays, uint ray_count, GLOBAL Hit *hits) {
    const uint i = (uint)get_global_id(0);
    if (i >= ray_count) {
        return;
    }
    const RayRecord ray = rays[i];
    hits[i] = trace_nearest(nodes, triangles, vload3(0, ray.origin), vload3(0, ray.direction), ray.t_max);
}

__kernel void trace_any_rays(GLOBAL const BvhNode *nodes, GLOBAL const LeafTriangle *triangles,
                             GLOBAL const RayRecord *rays, uint ray_count, GLOBAL uint *occluded) {
    const uint i = (uint)get_global_id(0);
    if (i >= ray_count) {
        return;
    }
    const RayRecord ray = rays[i];
    const bool hit = trace_any(nodes, triangles, vload3(0, ray.origin), vload3(0, ray.direction), ray.t_max);
    occluded[i] = hit ? 1u : 0u;
}
