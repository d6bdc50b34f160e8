// SPDX-License-Identifier: MIT
// Connections of a camera path's hits to the stored vertices of the light path with the same index.
#pragma once

#include "renderer/kernels/bsdf/bsdf.h"
#include "renderer/kernels/bsdf/shading_frame.h"
#include "renderer/kernels/math/logarithm.h"
#include "renderer/kernels/mis/bidirectional.h"
#include "renderer/kernels/path/shadow_ray.h"
#include "renderer/kernels/path/stored_vertex.h"
#include "renderer/kernels/scene_view.h"
#include "renderer/shared/integrator_settings.h"
#include "renderer/shared/light_vertex.h"
#include "renderer/shared/path_state.h"

/// One end of a connection: its BSDF and its densities.
typedef struct ConnectionEnd {
    /// f |cos(ns)| for radiance towards the camera, with the cosine of the direction towards the
    /// light.
    float3 f_cos;
    /// Density per solid angle with which a path from this end continues to the other end.
    float pdf_w;
    /// log2 of the bracket of MIS (21) at this end, to the power 1 / beta.
    float log_strategies_before;
} ConnectionEnd;

/// Returns the end of a connection at `hit`. The path came from direction `before` and is connected
/// along direction `other`; both are unit vectors away from the surface. `log_s` and `log_a` are
/// log2 of S at the vertex before and of A at this one.
DEVICE ConnectionEnd connection_end(PRIVATE const SceneView *scene, SurfaceHit hit, float3 before,
                                    float3 other, bool from_camera, float log_s, float log_a,
                                    float beta) {
    const float3 to_camera = from_camera ? before : other, to_light = from_camera ? other : before;
    const BsdfValue value =
        bsdf_evaluate(scene, hit.material, shading_frame(scene, hit, to_camera), to_light);
    const float pdf_to_camera =
        light_path_pdf_w(scene, hit.material, shading_frame(scene, hit, to_light), to_camera);
    ConnectionEnd end;
    end.f_cos = value.f_cos;
    end.pdf_w = from_camera ? value.pdf_w : pdf_to_camera;
    // b_m on a camera path, f_{m+1} on a light path, per projected solid angle.
    const float log_reverse = log2_quotient(from_camera ? pdf_to_camera : value.pdf_w,
                                            fabs(dot(hit.point.normal, before)));
    end.log_strategies_before = strategies_before(log_s, log_a, log_reverse, beta);
    return end;
}

/// Connects a hit to vertex `vertex_index` of the light path and prepares the shadow ray. Returns
/// false if the connection contributes nothing.
DEVICE bool connect_to_vertex(Path path, PRIVATE const SceneView *scene, GLOBAL uint *vertex_words,
                              IntegratorSettings settings, uint vertex_index) {
    const uint primitive = get_hit_primitive(path);
    const uint events = get_depth(path) + vertex_index + 2u;
    if (primitive == NO_HIT || !all_strategies(settings, events) ||
        (FEATURE_depth_limit && events > settings.max_depth)) {
        return false;
    }
    const WordPlace place = stored_vertex(path, vertex_words, settings, vertex_index);
    if (!has_light_vertex(place)) {
        return false;
    }
    const SurfaceHit hit = surface_hit(scene, primitive, get_hit_at(path));
    if (is_delta_material(scene->materials[hit.material])) {
        return false;
    }
    const LightVertex vertex = load_light_vertex(place);
    const float3 lit_at = make_float3(vertex.hit_u, vertex.hit_v, vertex.hit_w);
    const SurfaceHit lit = surface_hit(scene, vertex.hit_primitive, lit_at);
    const float3 to_vertex = lit.point.position - hit.point.position;
    const float squared = dot(to_vertex, to_vertex);
    const float3 wi = to_vertex / sqrt(squared);
    const float3 wo = -get_ray_direction(path), from_light = -vertex.direction;
    const float cos_here = fabs(dot(hit.point.normal, wi)),
                cos_there = fabs(dot(lit.point.normal, wi));
    const float cos_arrived = fabs(dot(lit.point.normal, from_light));
    // Two coinciding points are no connection, nor is a hit in the plane of its surface. The
    // comparisons also fail for NaN.
    if (!(squared > 0.0f && cos_here > 0.0f && cos_there > 0.0f && cos_arrived > 0.0f &&
          fabs(dot(hit.point.normal, wo)) > 0.0f)) {
        return false;
    }
    const ConnectionEnd here = connection_end(scene, hit, wo, wi, true, get_log_strategies(path),
                                              get_log_inverse_arrival(path), settings.beta);
    if (is_black(here.f_cos)) {
        return false;
    }
    const ConnectionEnd there =
        connection_end(scene, lit, from_light, -wi, false, vertex.log_strategies,
                       vertex.log_inverse_arrival, settings.beta);
    if (is_black(there.f_cos)) {
        return false;
    }
    // log2 of the densities per area with which a path from either end arrives at the other:
    // b_{m+1} G_m here and f_m G_m there. One cosine of G_m is part of each density per solid
    // angle.
    const float log_arrival_here = log2_quotient(there.pdf_w, squared) + log2_of(cos_here);
    const float log_arrival_there = log2_quotient(here.pdf_w, squared) + log2_of(cos_there);
    const float weight = connection_weight(log_arrival_here + here.log_strategies_before,
                                           log_arrival_there + there.log_strategies_before,
                                           settings.beta);  // MIS (21)
    // At the light vertex f_cos contains the cosine with the shading normal. The area measure of
    // the light path has the cosine with the geometric normal instead (Veach 1997, section 5.3).
    // The weight comes before the quotient by d^2: on short connections it falls with d^(2 beta).
    const float3 light =
        vertex.throughput * there.f_cos * (weight * cos_there / cos_arrived / squared);
    aim_shadow_ray(path, offset_ray_origin(hit.point, wi), offset_ray_origin(lit.point, -wi),
                   get_throughput(path) * here.f_cos * light);
    return true;
}
