// SPDX-License-Identifier: MIT
// A scattering event seen from its other end: the densities that light paths and camera paths have
// for the same path (Veach 1997, 10.2; thesis 2.74-2.79), and what light paths carry (his 5.3).
//
// Densities in the ratios are per PROJECTED solid angle, with geometric cosines: p_wp = p_w /
// |cos(ng, w)|.
#pragma once

#include "renderer/kernels/bsdf/bsdf.h"
#include "renderer/kernels/bsdf/shading_frame.h"
#include "renderer/kernels/math/logarithm.h"

#if FEATURE_light_strategy || FEATURE_from_light

/// From the direction wo, where the path came from, to wi, where it goes.
typedef struct TwoWay {
    float log_forward;  ///< log2 of p_wp(wo -> wi); of a delta: 0
    float log_ratio;    ///< log2 of p_wp(wi -> wo) / p_wp(wo -> wi); -INFINITY where the way back
                        ///< does not exist
    float3 importance;  ///< weight of a light path that goes this way: f |cos(ng, wi)| / p_w(wi), f
                        ///< being that of radiance from wo to wi
} TwoWay;

#if FEATURE_delta

/// The probability with which a delta component is drawn when it is met from frame.wo; 0 when it
/// scatters nothing.
DEVICE float delta_probability(MATERIAL_PARAMETERS uint material, SurfaceFrame frame,
                               uint component) {
    const MaterialRecord record = materials[material];
    const float3 wo = to_local(frame, frame.wo);
    if (!side_scatters(record, frame, wo.z)) {
        return 0.0f;
    }
#if FEATURE_composite
    float shares = 0.0f, own = 0.0f;
    for (uint i = record.first_component; i < record.first_component + record.component_count;
         ++i) {
        GLOBAL const BxdfRecord *other = components + i;
        const float eta = component_eta(other, record.flags, frame.front);
        const float share =
            component_share(other, eta, wo, component_colour(MATERIAL_ARGUMENTS other, frame.uv));
        shares += share;
        own = i == component ? share : own;
    }
    return record.component_count == 1u ? 1.0f : shares > 0.0f ? own / shares : 0.0f;
#else
    (void)component;
    return 1.0f;
#endif
}

#endif

/// Looks at `sample`, drawn in `frame` at `hit`, from its other end.
DEVICE TwoWay look_back(MATERIAL_PARAMETERS SurfaceHit hit, SurfaceFrame frame, BsdfSample sample) {
    const SurfaceFrame back = shading_frame(MATERIAL_ARGUMENTS hit, sample.wi);
    const float cos_wo = fabs(dot(frame.ng, frame.wo));
    const float cos_wi = fabs(dot(frame.ng, sample.wi));
    TwoWay both;
    both.log_forward = 0.0f;
    both.log_ratio = -INFINITY;
    both.importance = make_float3(0.0f, 0.0f, 0.0f);
    // A hit in the plane of the surface is none in exact arithmetic.
    if (!(cos_wo > 0.0f && cos_wi > 0.0f)) {
        return both;
    }
#if FEATURE_delta
    if (!(sample.pdf_w < INFINITY)) {
        float bend = 1.0f;
#if FEATURE_smooth_normals
        // Where one end looks from below the horizon of the shading normal, its frame is that of
        // the geometric one: then there is no way back.
        const float3 sum = frame.ns + back.ns, difference = frame.ns - back.ns;
        if (dot(sum, sum) > 0.0f && dot(difference, difference) > 0.0f) {
            return both;
        }
        // Solid angles are mapped by cosines with the shading normal, projected by those with the
        // geometric one. The former are not 0: bsdf_sample leaves out what is closer to the horizon
        // than MIN_COSINE.
        const float ns_wo = fabs(dot(frame.ns, frame.wo)), ns_wi = fabs(dot(frame.ns, sample.wi));
        bend = (ns_wo / cos_wo) * (cos_wi / ns_wi);
#endif
        const float probability =
            delta_probability(MATERIAL_ARGUMENTS hit.material, back, sample.component);
        // n^2 |cos| dw is the same on both sides of a boundary.
        both.log_ratio =
            log2_quotient(probability, sample.probability) + log2_of(bend) + log2_of(sample.scale);
        if (probability > 0.0f) {
            both.importance = sample.weight / sample.scale * bend;
        }
        return both;
    }
#endif
    const BsdfValue value = bsdf_evaluate(MATERIAL_ARGUMENTS hit.material, back, frame.wo);
    both.log_forward = log2_quotient(sample.pdf_w, cos_wi);
    both.log_ratio = log2_quotient(value.pdf_w, cos_wo) - both.log_forward;
    both.importance = value.f_cos * (cos_wi / cos_wo / sample.pdf_w);
    return both;
}

#endif
