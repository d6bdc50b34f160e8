// SPDX-License-Identifier: MIT
// The stored vertices of the light path that shares a path's index (shared/light_vertex.h).
#pragma once

#include "renderer/kernels/bsdf/bsdf.h"
#include "renderer/kernels/geometry/surface_hit.h"
#include "renderer/kernels/scene_view.h"
#include "renderer/shared/integrator_settings.h"
#include "renderer/shared/light_vertex.h"
#include "renderer/shared/path_state.h"

/// Returns the location of vertex `i` of the light path with the index of `path`.
DEVICE WordPlace stored_vertex(Path path, GLOBAL uint *vertex_words, IntegratorSettings settings,
                               uint i) {
    const uint row =
        light_vertex_row(get_pixel(path), get_sample(path), settings.light_paths, path.capacity);
    return light_vertex_place(vertex_words, path.capacity, settings.light_vertices, row, i);
}

/// Marks all vertices of a light path as missing.
DEVICE void clear_vertices(Path path, GLOBAL uint *vertex_words, IntegratorSettings settings) {
    for (uint i = 0; FEATURE_vertex_connections && i < settings.light_vertices; ++i) {
        clear_light_vertex(stored_vertex(path, vertex_words, settings, i));
    }
}

/// Stores the hit of a light path as a light vertex, unless its material has only delta components.
DEVICE void store_hit(Path path, PRIVATE const SceneView *scene, GLOBAL uint *vertex_words,
                      IntegratorSettings settings) {
    const uint depth = get_depth(path);
    LightVertex vertex;
    vertex.hit_primitive = get_hit_primitive(path);
    if (depth >= settings.light_vertices || vertex.hit_primitive == NO_HIT) {
        return;
    }
    const float3 at = get_hit_at(path);
    if (FEATURE_delta) {
        const SurfaceHit hit = surface_hit(scene, vertex.hit_primitive, at);
        if (is_delta_material(scene->materials[hit.material])) {
            return;
        }
    }
    vertex.hit_u = at.x;
    vertex.hit_v = at.y;
    vertex.hit_w = at.z;
    vertex.direction = get_ray_direction(path);
    vertex.throughput = get_throughput(path);
    vertex.log_inverse_arrival = get_log_inverse_arrival(path);
    vertex.log_strategies = get_log_strategies(path);
    store_light_vertex(stored_vertex(path, vertex_words, settings, depth), vertex);
}
