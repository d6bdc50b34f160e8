// SPDX-License-Identifier: MIT
// Traces an array of rays on a device, for tests and benchmarks of the traversal functions.
//
// Reads: nodes, triangles, rays.
// Writes: hits (trace_nearest_rays) or flags (trace_any_rays). With TRAVERSAL_COUNTS,
// count_nearest_rays and count_any_rays write the traversal work.
#include "renderer/kernels/traversal/intersect_bvh.h"
#include "renderer/kernels/traversal/ray_record.h"

__kernel void trace_nearest_rays(GLOBAL const BVH_NODE *nodes,
                                 GLOBAL const BVH_TRIANGLES *triangles,
                                 GLOBAL const RayRecord *rays, uint ray_count, GLOBAL Hit *hits) {
    const uint i = (uint)get_global_id(0);
    if (i >= ray_count) {
        return;
    }
    const RayRecord ray = rays[i];
    hits[i] = trace_nearest(nodes, triangles, vload3(0, ray.origin), vload3(0, ray.direction),
                            ray.t_max, all_opaque());
}

__kernel void trace_any_rays(GLOBAL const BVH_NODE *nodes, GLOBAL const BVH_TRIANGLES *triangles,
                             GLOBAL const RayRecord *rays, uint ray_count, GLOBAL uint *occluded) {
    const uint i = (uint)get_global_id(0);
    if (i >= ray_count) {
        return;
    }
    const RayRecord ray = rays[i];
    const bool hit = trace_any(nodes, triangles, vload3(0, ray.origin), vload3(0, ray.direction),
                               ray.t_max, all_opaque());
    occluded[i] = hit ? 1u : 0u;
}

#if TRAVERSAL_COUNTS
__kernel void count_nearest_rays(GLOBAL const BVH_NODE *nodes,
                                 GLOBAL const BVH_TRIANGLES *triangles,
                                 GLOBAL const RayRecord *rays, uint ray_count,
                                 GLOBAL RayWork *work) {
    const uint i = (uint)get_global_id(0);
    if (i < ray_count) {
        const RayRecord ray = rays[i];
        const Hit hit = TRAVERSE_BVH(nodes, triangles, vload3(0, ray.origin),
                                     vload3(0, ray.direction), ray.t_max, false, all_opaque());
        work[i].nodes = hit.nodes;
        work[i].triangles = hit.triangles;
    }
}

__kernel void count_any_rays(GLOBAL const BVH_NODE *nodes, GLOBAL const BVH_TRIANGLES *triangles,
                             GLOBAL const RayRecord *rays, uint ray_count, GLOBAL RayWork *work) {
    const uint i = (uint)get_global_id(0);
    if (i < ray_count) {
        const RayRecord ray = rays[i];
        const Hit hit = TRAVERSE_BVH(nodes, triangles, vload3(0, ray.origin),
                                     vload3(0, ray.direction), ray.t_max, true, all_opaque());
        work[i].nodes = hit.nodes;
        work[i].triangles = hit.triangles;
    }
}
#endif
