// SPDX-License-Identifier: MIT
// Stage store_vertex: stores the hit of each light path if camera paths can be connected to it.
//
// Reads: hit, ray_direction, throughput, depth, pixel, sample, log_arrival, log_strategies, active
// queue.
// Writes: light vertices.

#include "renderer/kernels/bsdf/bsdf.h"
#include "renderer/kernels/geometry/prefetch_hit.h"
#include "renderer/kernels/geometry/surface_hit.h"
#include "renderer/kernels/scene_view.h"
#include "renderer/kernels/stream.h"
#include "renderer/kernels/traversal/intersect_triangle.h"
#include "renderer/shared/integrator_settings.h"
#include "renderer/shared/light_vertex.h"
#include "renderer/shared/path_state.h"
#include "renderer/shared/scene_records.h"

/// Stores the hit of a light path as a light vertex, unless its material has only delta components.
DEVICE void keep_hit(PathStates paths, uint slot, PRIVATE const SceneView *scene,
                     GLOBAL uint *vertex_words, IntegratorSettings settings) {
    const uint depth = get_depth(paths, slot);
    LightVertex vertex;
    vertex.hit_primitive = get_hit_primitive(paths, slot);
    if (depth >= settings.light_vertices || vertex.hit_primitive == NO_HIT) {
        return;
    }
    const float3 at = get_hit_at(paths, slot);
    if (FEATURE_delta) {
        const SurfaceHit hit = surface_hit(scene, vertex.hit_primitive, at);
        if (is_delta_material(scene->materials[hit.material])) {
            return;
        }
    }
    vertex.hit_u = at.x;
    vertex.hit_v = at.y;
    vertex.hit_w = at.z;
    vertex.direction = get_ray_direction(paths, slot);
    vertex.throughput = get_throughput(paths, slot);
    vertex.log_arrival = get_log_arrival(paths, slot);
    vertex.log_strategies = get_log_strategies(paths, slot);
    const uint row = light_vertex_row(get_pixel(paths, slot), get_sample(paths, slot),
                                      settings.light_paths, paths.capacity);
    store_light_vertex(
        light_vertex_place(vertex_words, paths.capacity, settings.light_vertices, row, depth),
        vertex);
}

__kernel void store_vertex(SHADING_PARAMETERS, IntegratorSettings settings,
                           GLOBAL uint *vertex_words, STREAM_PARAMETERS) {
    const SceneView scene = SHADING_VIEW;
    const PathStates paths = {path_words, capacity};
    FOR_EACH_ENTRY(i, active_count(counters)) {
        const uint slot =
            hit_path_at(&scene, paths, active_queue(queues, counters, capacity), i, i_end);
        keep_hit(paths, slot, &scene, vertex_words, settings);
    }
}
