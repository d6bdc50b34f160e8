// SPDX-License-Identifier: MIT
// Branches of a path at ideal reflection and refraction (Whitted 1980, "An improved illumination
// model for shaded display").
//
// No direction is sampled: every ideal component of every vertex is followed. A path that ends
// returns to the last vertex that has components left. It thus traverses Whitted's tree depth
// first. The light of all branches adds up in one radiance. Departure: adaptive termination (Hall
// and Greenberg 1983) is a setting.
#pragma once

#include "renderer/kernels/bsdf/bsdf.h"
#include "renderer/kernels/bsdf/shading_frame.h"
#include "renderer/kernels/geometry/surface_hit.h"
#include "renderer/kernels/scene_view.h"
#include "renderer/shared/branch.h"
#include "renderer/shared/integrator_settings.h"
#include "renderer/shared/path_state.h"

/// Makes the hit of a path a vertex, with all components still to follow. Returns false if the path
/// cannot scatter there.
DEVICE bool branch_of_hit(Path path, IntegratorSettings settings, PRIVATE Branch *vertex) {
    vertex->hit_primitive = get_hit_primitive(path);
    vertex->depth = get_depth(path);
    vertex->component = 0u;
    if (vertex->hit_primitive == NO_HIT || vertex->depth >= settings.max_depth) {
        return false;
    }
    vertex->hit_u = get_hit_u(path);
    vertex->hit_v = get_hit_v(path);
    vertex->hit_w = get_hit_w(path);
    vertex->direction = get_ray_direction(path);
    vertex->throughput = get_throughput(path);
    return true;
}

/// Follows the next ideal component of the vertex with a nonzero contribution, and stores the
/// vertex if it has more components. Returns false if no component is left.
DEVICE bool follow(Path path, PRIVATE const SceneView *scene, GLOBAL uint *branch_words,
                   IntegratorSettings settings, Branch vertex) {
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
            const uint pending = get_pending(path);
            vertex.component = i + 1u;
            store_branch(record_place(branch_words, BRANCH_WORDS, path.capacity, settings.max_depth,
                                      path.slot, pending),
                         vertex);
            set_pending(path, pending + 1u);
        }
        set_ray_origin(path, offset_ray_origin(hit.point, sample.wi));
        set_ray_direction(path, sample.wi);
        set_throughput(path, throughput);
        set_depth(path, vertex.depth + 1u);
        set_pdf_w(path, sample.pdf_w);
        return true;
    }
    return false;
}

/// Continues the path from its hit or from a stored vertex. Returns false if its tree is finished.
DEVICE bool next_branch(Path path, PRIVATE const SceneView *scene, GLOBAL uint *branch_words,
                        IntegratorSettings settings) {
    Branch vertex;
    if (branch_of_hit(path, settings, &vertex) &&
        follow(path, scene, branch_words, settings, vertex)) {
        return true;
    }
    for (uint pending = get_pending(path); pending > 0u; --pending) {
        set_pending(path, pending - 1u);
        vertex = load_branch(record_place(branch_words, BRANCH_WORDS, path.capacity,
                                          settings.max_depth, path.slot, pending - 1u));
        if (follow(path, scene, branch_words, settings, vertex)) {
            return true;
        }
    }
    return false;
}
