// SPDX-License-Identifier: MIT
// Scattering events in reverse: the densities with which light paths and camera paths sample the
// same event (Veach 1997, section 10.2; thesis (2.74)-(2.79)), and the weight of importance (Veach
// 1997, section 5.3).
//
// All densities of this file are per PROJECTED solid angle: the density per solid angle over
// |cos(ng, w)|, with the geometric normal. `forward` is in the direction in which the path travels,
// `reverse` against it. On a camera path forward is f_i and reverse is b_i of MIS (2)-(5); on a
// light path forward is b_i and reverse is f_i (docs/mis-weights.md).
#pragma once

#include "renderer/kernels/bsdf/bsdf.h"
#include "renderer/kernels/bsdf/shading_frame.h"
#include "renderer/kernels/math/logarithm.h"

/// A scattering event in both directions: from wo, where the path came from, to wi, where it
/// continues.
typedef struct ScatterEvent {
    /// log2 of the forward density, from wo to wi; 0 for a delta event.
    float log_forward;
    /// log2 of the reverse density, from wi to wo, over the forward density; -INFINITY if the
    /// reverse event is impossible. For a delta event both are probabilities of the event.
    float log_reverse_ratio;
    /// Weight of a light path along these directions: f |cos(ng, wi)| / p_w(wi), where f is that of
    /// radiance from wo to wi. 0 on a camera path unless the event is a delta event.
    float3 importance;
} ScatterEvent;

/// Returns an event whose reverse is impossible.
DEVICE ScatterEvent irreversible_event(void) {
    ScatterEvent event;
    event.log_forward = 0.0f;
    event.log_reverse_ratio = -INFINITY;
    event.importance = make_float3(0.0f, 0.0f, 0.0f);
    return event;
}

/// Returns the probability with which a delta component is selected for frame.wo; 0 if the material
/// scatters nothing.
DEVICE float delta_probability(PRIVATE const SceneView *scene, uint material, SurfaceFrame frame,
                               uint component) {
    const MaterialRecord record = scene->materials[material];
    const float3 wo = to_local(frame, frame.wo);
    if (!side_scatters(record, frame, wo.z)) {
        return 0.0f;
    }
    if (!FEATURE_composite || record.component_count == 1u) {
        return 1.0f;
    }
    float shares = 0.0f, own = 0.0f;
    for (uint i = record.first_component; i < record.first_component + record.component_count;
         ++i) {
        GLOBAL const BxdfRecord *other = scene->components + i;
        const float eta = component_eta(other, record.flags, frame.front);
        const float share =
            component_share(scene, other, eta, frame.uv, wo, component_colour(scene, other, frame));
        shares += share;
        own = i == component ? share : own;
    }
    return shares > 0.0f ? own / shares : 0.0f;
}

/// log2 of 1 / pi.
#define LOG2_INV_PI (-1.6514961f)

/// Returns whether a hit reflects by Lambert's law about the geometric normal. The density of a
/// direction per projected solid angle is then 1 / pi, whatever the other direction. Importance has
/// the weight of radiance.
DEVICE bool is_lambertian(PRIVATE const SceneView *scene, SurfaceHit hit) {
    const float3 ns = hit.normal, ng = hit.point.normal;
    return FEATURE_lambert && (scene->materials[hit.material].flags & MATERIAL_LAMBERT) != 0u &&
           (!FEATURE_smooth_normals || (ns.x == ng.x && ns.y == ng.y && ns.z == ng.z));
}

/// Returns the event of `sample`, which was sampled in `frame` at `hit`, in both directions.
DEVICE ScatterEvent scatter_event(PRIVATE const SceneView *scene, SurfaceHit hit,
                                  SurfaceFrame frame, BsdfSample sample) {
    const float cos_wo = fabs(dot(frame.ng, frame.wo));
    const float cos_wi = fabs(dot(frame.ng, sample.wi));
    ScatterEvent event = irreversible_event();
    // A hit in the plane of the surface does not exist in exact arithmetic.
    if (!(cos_wo > 0.0f && cos_wi > 0.0f)) {
        return event;
    }
    if (is_lambertian(scene, hit)) {
        event.log_forward = LOG2_INV_PI;
        event.log_reverse_ratio = 0.0f;
        event.importance = sample.weight;
        return event;
    }
    const SurfaceFrame back = shading_frame(scene, hit, sample.wi);
    if (FEATURE_delta && !(sample.pdf_w < INFINITY)) {
        float bend = 1.0f;
        if (FEATURE_smooth_normals) {
            // If one direction is below the horizon of the shading normal, its frame uses the
            // geometric normal. The two frames then differ, and the reverse event is impossible.
            const float3 sum = frame.ns + back.ns, difference = frame.ns - back.ns;
            if (dot(sum, sum) > 0.0f && dot(difference, difference) > 0.0f) {
                return event;
            }
            // Cosines with the shading normal map solid angles; cosines with the geometric normal
            // map projected solid angles. The former are not 0, as bsdf_sample rejects directions
            // closer to the horizon than MIN_COSINE.
            const float ns_wo = fabs(dot(frame.ns, frame.wo));
            const float ns_wi = fabs(dot(frame.ns, sample.wi));
            bend = (ns_wo / cos_wo) * (cos_wi / ns_wi);
        }
        const float probability = delta_probability(scene, hit.material, back, sample.component);
        // n^2 |cos| dw is equal on both sides of a boundary.
        event.log_reverse_ratio =
            log2_quotient(probability, sample.probability) + log2_of(bend) + log2_of(sample.scale);
        if (probability > 0.0f) {
            event.importance = sample.weight / sample.scale * bend;
            if (FEATURE_normal_maps && FEATURE_from_light) {
                event.importance *= map_shadowing(back, to_local(back, frame.wo));
            }
        }
        return event;
    }
    event.log_forward = log2_quotient(sample.pdf_w, cos_wi);
    if (FEATURE_from_light) {
        const BsdfValue value = bsdf_evaluate(scene, hit.material, back, frame.wo);
        event.log_reverse_ratio = log2_quotient(value.pdf_w, cos_wo) - event.log_forward;
        event.importance = value.f_cos * (cos_wi / cos_wo / sample.pdf_w);
    } else {
        event.log_reverse_ratio =
            log2_quotient(light_path_pdf_w(scene, hit.material, back, frame.wo), cos_wo) -
            event.log_forward;
    }
    return event;
}
