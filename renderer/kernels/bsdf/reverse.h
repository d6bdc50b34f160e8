// SPDX-License-Identifier: MIT
// Scattering events in reverse: the densities with which light paths and camera paths sample the
// same event (Veach 1997, section 10.2; thesis (2.74)-(2.79)), and the weight of importance (Veach
// 1997, section 5.3).
//
// The ratios are of densities per PROJECTED solid angle, with geometric cosines: p_wp = p_w /
// |cos(ng, w)|.
#pragma once

#include "renderer/kernels/bsdf/bsdf.h"
#include "renderer/kernels/bsdf/shading_frame.h"
#include "renderer/kernels/math/logarithm.h"

/// A scattering event in both directions: from wo, where the path came from, to wi, where it
/// continues.
typedef struct TwoWay {
    float log_forward;  ///< log2 of p_wp(wo -> wi); 0 for a delta event
    /// log2 of p_wp(wi -> wo) / p_wp(wo -> wi); -INFINITY if the reverse event is impossible.
    float log_ratio;
    /// Weight of a light path along these directions: f |cos(ng, wi)| / p_w(wi), where f is that of
    /// radiance from wo to wi.
    float3 importance;
} TwoWay;

/// Returns an event whose reverse is impossible.
DEVICE TwoWay one_way(void) {
    TwoWay both;
    both.log_forward = 0.0f;
    both.log_ratio = -INFINITY;
    both.importance = make_float3(0.0f, 0.0f, 0.0f);
    return both;
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
            component_share(other, eta, wo, component_colour(scene, other, frame.uv));
        shares += share;
        own = i == component ? share : own;
    }
    return shares > 0.0f ? own / shares : 0.0f;
}

/// Returns both directions of `sample`, which was sampled in `frame` at `hit`.
DEVICE TwoWay look_back(PRIVATE const SceneView *scene, SurfaceHit hit, SurfaceFrame frame,
                        BsdfSample sample) {
    const SurfaceFrame back = shading_frame(scene, hit, sample.wi);
    const float cos_wo = fabs(dot(frame.ng, frame.wo));
    const float cos_wi = fabs(dot(frame.ng, sample.wi));
    TwoWay both = one_way();
    // A hit in the plane of the surface does not exist in exact arithmetic.
    if (!(cos_wo > 0.0f && cos_wi > 0.0f)) {
        return both;
    }
    if (FEATURE_delta && !(sample.pdf_w < INFINITY)) {
        float bend = 1.0f;
        if (FEATURE_smooth_normals) {
            // If one direction is below the horizon of the shading normal, its frame uses the
            // geometric normal. The two frames then differ, and the reverse event is impossible.
            const float3 sum = frame.ns + back.ns, difference = frame.ns - back.ns;
            if (dot(sum, sum) > 0.0f && dot(difference, difference) > 0.0f) {
                return both;
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
        both.log_ratio =
            log2_quotient(probability, sample.probability) + log2_of(bend) + log2_of(sample.scale);
        if (probability > 0.0f) {
            both.importance = sample.weight / sample.scale * bend;
        }
        return both;
    }
    const BsdfValue value = bsdf_evaluate(scene, hit.material, back, frame.wo);
    both.log_forward = log2_quotient(sample.pdf_w, cos_wi);
    both.log_ratio = log2_quotient(value.pdf_w, cos_wo) - both.log_forward;
    both.importance = value.f_cos * (cos_wi / cos_wo / sample.pdf_w);
    return both;
}
