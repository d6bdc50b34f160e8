// SPDX-License-Identifier: MIT
// Stage follow_branches: continues each active path by ideal reflection or refraction.
//
// No direction is sampled: every ideal component of every vertex is followed. A path that ends
// returns to the last vertex that has components left. It thus traverses the tree of Whitted 1980,
// "An improved illumination model for shaded display", depth first. The light of all branches adds
// up in one radiance. Departure: adaptive termination (Hall and Greenberg 1983) is a setting.
//
// Reads: hit, ray_direction, throughput, depth, pending, active queue, branches.
// Writes: ray_origin, ray_direction, throughput, pdf_w, depth, pending, branches; film.
// Enqueues: active queue of the next round, or free queue.

#include "renderer/kernels/bsdf/bsdf.h"
#include "renderer/kernels/bsdf/shading_frame.h"
#include "renderer/kernels/film/add_sample.h"
#include "renderer/kernels/geometry/surface_hit.h"
#include "renderer/kernels/scene_view.h"
#include "renderer/kernels/stream.h"
#include "renderer/kernels/traversal/intersect_triangle.h"
#include "renderer/shared/branch.h"
#include "renderer/shared/integrator_settings.h"
#include "renderer/shared/path_state.h"

/// Makes the hit of a path a vertex, with all components still to follow. Returns false if the path
/// cannot scatter there.
DEVICE bool branch_of_hit(PathStates paths, uint slot, IntegratorSettings settings,
                          PRIVATE Branch *vertex) {
    vertex->hit_primitive = get_hit_primitive(paths, slot);
    vertex->depth = get_depth(paths, slot);
    vertex->component = 0u;
    if (vertex->hit_primitive == NO_HIT || vertex->depth >= settings.max_depth) {
        return false;
    }
    vertex->hit_u = get_hit_u(paths, slot);
    vertex->hit_v = get_hit_v(paths, slot);
    vertex->hit_w = get_hit_w(paths, slot);
    vertex->direction = get_ray_direction(paths, slot);
    vertex->throughput = get_throughput(paths, slot);
    return true;
}

/// Follows the next ideal component of the vertex with a nonzero contribution, and stores the
/// vertex if it has more components. Returns false if no component is left.
DEVICE bool follow(PathStates paths, uint slot, PRIVATE const SceneView *scene,
                   GLOBAL uint *branch_words, IntegratorSettings settings, Branch vertex) {
    const float3 at = make_float3(vertex.hit_u, vertex.hit_v, vertex.hit_w);
    const SurfaceHit hit = surface_hit(scene, vertex.hit_primitive, at);
    const SurfaceFrame frame = shading_frame(scene, hit, -vertex.direction);
    const MaterialRecord material = scene->materials[hit.material];
    for (uint i = vertex.component; i < material.component_count; ++i) {
        const BsdfSample sample = bsdf_delta(scene, material, frame, material.first_component + i);
        const float3 throughput = vertex.throughput * sample.weight;
        const float largest = max(throughput.x, max(throughput.y, throughput.z));
        if (!(sample.pdf_w > 0.0f && largest > 0.0f)) {
            continue;
        }
        if (FEATURE_adaptive && settings.termination == TERMINATION_ADAPTIVE &&
            largest < settings.adaptive_threshold) {
            continue;
        }
        if (FEATURE_branches && i + 1u < material.component_count) {
            // Depths increase along the stack, so it holds at most one vertex per depth below the
            // limit.
            const uint pending = get_pending(paths, slot);
            vertex.component = i + 1u;
            store_branch(record_place(branch_words, BRANCH_WORDS, paths.capacity,
                                      settings.max_depth, slot, pending),
                         vertex);
            set_pending(paths, slot, pending + 1u);
        }
        set_ray_origin(paths, slot, offset_ray_origin(hit.point, sample.wi));
        set_ray_direction(paths, slot, sample.wi);
        set_throughput(paths, slot, throughput);
        set_depth(paths, slot, vertex.depth + 1u);
        set_pdf_w(paths, slot, sample.pdf_w);
        return true;
    }
    return false;
}

/// Continues the path from its hit or from a stored vertex. Returns false if its tree is finished.
DEVICE bool next_branch(PathStates paths, uint slot, PRIVATE const SceneView *scene,
                        GLOBAL uint *branch_words, IntegratorSettings settings) {
    Branch vertex;
    if (branch_of_hit(paths, slot, settings, &vertex) &&
        follow(paths, slot, scene, branch_words, settings, vertex)) {
        return true;
    }
    for (uint pending = get_pending(paths, slot); pending > 0u; --pending) {
        set_pending(paths, slot, pending - 1u);
        vertex = load_branch(record_place(branch_words, BRANCH_WORDS, paths.capacity,
                                          settings.max_depth, slot, pending - 1u));
        if (follow(paths, slot, scene, branch_words, settings, vertex)) {
            return true;
        }
    }
    return false;
}

__kernel void follow_branches(SHADING_PARAMETERS, GLOBAL long *film_words,
                              GLOBAL long *half_film_words, IntegratorSettings settings,
                              GLOBAL uint *branch_words, STREAM_PARAMETERS) {
    const SceneView scene = SHADING_VIEW;
    const PathStates paths = {path_words, capacity};
    const FilmView film = {film_words, half_film_words, counters};
    PushBuffer extended, ended;
    extended.count = 0u;
    ended.count = 0u;
    FOR_EACH_ENTRY(i, active_count(counters)) {
        const uint slot = path_at(paths, active_queue(queues, counters, capacity), i, i_end);
        if (next_branch(paths, slot, &scene, branch_words, settings)) {
            push_slot(&extended, slot);
        } else {
            add_path(paths, slot, film);
            push_slot(&ended, slot);
        }
    }
    append_active(queues, counters, capacity, 1u - counters->parity, &extended);
    append_slots(queues, QUEUE_FREE, capacity, &counters->free_slots, counters, &ended);
}
