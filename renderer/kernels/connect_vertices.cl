// SPDX-License-Identifier: MIT
// Stage connect_vertices: connects the hit of each camera path to vertex `chosen` of the light path
// with the same index.
//
// Reads: hit, ray_direction, throughput, depth, pixel, sample, log_arrival, log_strategies, light
// vertices, active queue.
// Writes: ray_origin (now that of the shadow ray), shadow_vector, shadow_radiance.
// Enqueues: shadow queue.

#include "renderer/kernels/bsdf/bsdf.h"
#include "renderer/kernels/bsdf/shading_frame.h"
#include "renderer/kernels/geometry/prefetch_hit.h"
#include "renderer/kernels/light/mis.h"
#include "renderer/kernels/math/logarithm.h"
#include "renderer/kernels/scene_view.h"
#include "renderer/kernels/stream.h"
#include "renderer/kernels/traversal/intersect_triangle.h"
#include "renderer/shared/integrator_settings.h"
#include "renderer/shared/light_vertex.h"
#include "renderer/shared/path_state.h"

/// One end of a connection: its BSDF and its densities.
typedef struct JoinEnd {
    /// f |cos(ns)| for radiance towards the camera, with the cosine of the direction towards the
    /// light.
    float3 f_cos;
    /// Density per solid angle with which a path from this end continues to the other end.
    float pdf_w;
    /// log2 of this side's contribution to p_others / p_own, without the factor p_arrive
    /// (light/mis.h).
    float log_strategies;
} JoinEnd;

/// Returns the end of a connection at `hit`. The path came from direction `before` and is connected
/// along direction `other`; both are unit vectors away from the surface.
DEVICE JoinEnd join_end(PRIVATE const SceneView *scene, SurfaceHit hit, float3 before, float3 other,
                        bool from_camera, float log_arrival, float log_strategies, float beta) {
    const BsdfValue onwards =
        bsdf_evaluate(scene, hit.material, shading_frame(scene, hit, before), other);
    const BsdfValue back =
        bsdf_evaluate(scene, hit.material, shading_frame(scene, hit, other), before);
    JoinEnd end;
    end.f_cos = from_camera ? onwards.f_cos : back.f_cos;
    end.pdf_w = onwards.pdf_w;
    const float log_back = log2_quotient(back.pdf_w, fabs(dot(hit.point.normal, before)));
    end.log_strategies = strategies_before(log_strategies, log_arrival, log_back, beta);
    return end;
}

DEVICE bool is_black(float3 value) {
    return !(value.x > 0.0f || value.y > 0.0f || value.z > 0.0f);
}

/// Connects a hit to a light vertex and prepares the shadow ray. Returns false if the connection
/// contributes nothing.
DEVICE bool join_to_vertex(PathStates paths, uint slot, PRIVATE const SceneView *scene,
                           GLOBAL uint *vertex_words, IntegratorSettings settings, uint chosen) {
    const uint primitive = get_hit_primitive(paths, slot);
    const uint events = get_depth(paths, slot) + chosen + 2u;
    if (primitive == NO_HIT || !all_strategies(settings, events)) {
        return false;
    }
    if (FEATURE_depth_limit && events > settings.max_depth) {
        return false;
    }
    const uint row = light_vertex_row(get_pixel(paths, slot), get_sample(paths, slot),
                                      settings.light_paths, paths.capacity);
    const WordPlace place =
        light_vertex_place(vertex_words, paths.capacity, settings.light_vertices, row, chosen);
    if (!has_light_vertex(place)) {
        return false;
    }
    const SurfaceHit hit = surface_hit(scene, primitive, get_hit_at(paths, slot));
    if (is_delta_material(scene->materials[hit.material])) {
        return false;
    }
    const LightVertex vertex = load_light_vertex(place);
    const float3 lit_at = make_float3(vertex.hit_u, vertex.hit_v, vertex.hit_w);
    const SurfaceHit lit = surface_hit(scene, vertex.hit_primitive, lit_at);
    const float3 way = lit.point.position - hit.point.position;
    const float squared = dot(way, way);
    const float3 wi = way / sqrt(squared);
    const float3 wo = -get_ray_direction(paths, slot), from_light = -vertex.direction;
    const float cos_here = fabs(dot(hit.point.normal, wi)),
                cos_there = fabs(dot(lit.point.normal, wi));
    const float cos_arrived = fabs(dot(lit.point.normal, from_light));
    // Two coinciding points are no connection, nor is a hit in the plane of its surface. The
    // comparisons also fail for NaN.
    if (!(squared > 0.0f && cos_here > 0.0f && cos_there > 0.0f && cos_arrived > 0.0f &&
          fabs(dot(hit.point.normal, wo)) > 0.0f)) {
        return false;
    }
    const JoinEnd here = join_end(scene, hit, wo, wi, true, get_log_arrival(paths, slot),
                                  get_log_strategies(paths, slot), settings.beta);
    if (is_black(here.f_cos)) {
        return false;
    }
    const JoinEnd there = join_end(scene, lit, from_light, -wi, false, vertex.log_arrival,
                                   vertex.log_strategies, settings.beta);
    if (is_black(there.f_cos)) {
        return false;
    }
    // log2 of the densities per area with which a path from either end arrives at the other.
    const float log_here = log2_quotient(there.pdf_w, squared) + log2_of(cos_here);
    const float log_there = log2_quotient(here.pdf_w, squared) + log2_of(cos_there);
    const float weight = join_weight(log_here + here.log_strategies,
                                     log_there + there.log_strategies, settings.beta);
    // At the light vertex f_cos contains the cosine with the shading normal. The area measure of
    // the light path has the cosine with the geometric normal instead (Veach 1997, section 5.3).
    // The weight comes before the quotient by d^2: on short connections it falls with d^(2 beta).
    const float3 light =
        vertex.throughput * there.f_cos * (weight * cos_there / cos_arrived / squared);
    const float3 origin = offset_ray_origin(hit.point, wi);
    set_ray_origin(paths, slot, origin);
    set_shadow_vector(paths, slot, offset_ray_origin(lit.point, -wi) - origin);
    set_shadow_radiance(paths, slot, get_throughput(paths, slot) * here.f_cos * light);
    return true;
}

__kernel void connect_vertices(SHADING_PARAMETERS, IntegratorSettings settings, uint chosen,
                               GLOBAL uint *vertex_words, STREAM_PARAMETERS) {
    const SceneView scene = SHADING_VIEW;
    const PathStates paths = {path_words, capacity};
    PushBuffer shadow;
    shadow.count = 0u;
    GLOBAL const uint *queue = active_queue(queues, counters, capacity);
    FOR_EACH_ENTRY(i, active_count(counters)) {
        const uint slot = shaded_path_at(&scene, paths, queue, i, i_end);
        if (join_to_vertex(paths, slot, &scene, vertex_words, settings, chosen)) {
            push_slot(&shadow, slot);
        }
    }
    append_slots(queues, QUEUE_SHADOW, capacity, &counters->shadow, counters, &shadow);
}
