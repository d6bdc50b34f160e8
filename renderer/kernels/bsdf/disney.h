// SPDX-License-Identifier: MIT
// Diffuse reflection, sheen and clear coat of the Disney BSDF. Local directions are those of
// lobe.h.
//
// Sources: B. Burley, "Physically Based Shading at Disney", 2012; B. Burley, "Extending the Disney
// BRDF to a BSDF with Integrated Subsurface Scattering", 2015, for the flat diffuse reflection. The
// clear coat is that of Mitsuba 3, without 1 / (4 wi.z wo.z).
//
// For unit vectors, the cosine between wo and the half vector is |wo + wi| / 2.
#pragma once

#include "renderer/kernels/bsdf/distribution.h"
#include "renderer/kernels/bsdf/fresnel.h"
#include "renderer/kernels/bsdf/lobe.h"
#include "renderer/shared/compat.h"

/// Evaluates the diffuse reflection. The flat term has the factor wi.z / (wi.z + wo.z), which is
/// below 1.
DEVICE Lobe disney_diffuse_evaluate(float3 wo, float3 wi, float roughness, float flatness) {
    if (!(wi.z > 0.0f)) {
        return no_lobe();
    }
    const float3 h = wo + wi;
    const float retro = 0.5f * roughness * dot(h, h);
    const float i = fresnel_schlick(wi.z, 0.0f), o = fresnel_schlick(wo.z, 0.0f);
    const float round =
        ((1.0f - 0.5f * i) * (1.0f - 0.5f * o) + retro * (i + o + i * o * (retro - 1.0f))) * wi.z;
    const float bend = 0.5f * retro - 1.0f;
    const float shape = (1.0f + bend * i) * (1.0f + bend * o);
    const float flat = 1.25f * (shape * (wi.z / (wi.z + wo.z) - 0.5f * wi.z) + 0.5f * wi.z);
    return make_lobe((round + (flat - round) * flatness) * INV_PI, wi.z * INV_PI, wo.z);
}

/// Evaluates the sheen. With the cosine c to the half vector, 1 - c is (1 - c^2) / (1 + c), which
/// does not cancel: 1 - c^2 is |wo - wi|^2 / 4.
DEVICE Lobe disney_sheen_evaluate(float3 wo, float3 wi) {
    if (!(wi.z > 0.0f)) {
        return no_lobe();
    }
    const float3 h = wo + wi, d = wo - wi;
    const float m = min(0.25f * dot(d, d) / (1.0f + 0.5f * sqrt(dot(h, h))), 1.0f);
    const float m2 = m * m;
    return make_lobe(m2 * m2 * m * wi.z, wi.z * INV_PI, wo.z);
}

/// Evaluates the clear coat. The density is D(m) m.z / (4 wo.m).
DEVICE Lobe disney_clearcoat_evaluate(float3 wo, float3 wi, float alpha) {
    if (!(wi.z > 0.0f)) {
        return no_lobe();
    }
    const float3 h = wo + wi;
    const float h_length = sqrt(dot(h, h));
    const float3 m = h / h_length;
    const float a2 = alpha * alpha;
    const float d = (a2 - 1.0f) * INV_PI / (log(a2) * (squared_sine(m) + a2 * m.z * m.z));
    Roughness masking;
    masking.alpha_x = masking.alpha_y = 0.25f;
    masking.beckmann = 0u;
    const float g = ggx_shadowing(wo, masking) * wo.z * ggx_shadowing(wi, masking) * wi.z;
    return make_lobe(0.25f * d * g * wi.z, 0.5f * d * m.z / h_length, 0.5f * h_length);
}

/// Samples a direction of the clear coat from u, v in [0, 1). A direction below the horizon is
/// invalid.
DEVICE float3 disney_clearcoat_direction(float3 wo, float alpha, float u, float v) {
    const float a2 = alpha * alpha;
    const float p = pow(a2, 1.0f - u);
    const float cosine = sqrt(max((1.0f - p) / (1.0f - a2), 0.0f));
    const float sine = sqrt(max((p - a2) / (1.0f - a2), 0.0f));
    const float2 around = point_on_circle(v);
    return reflect_about(wo, normalize(make_float3(sine * around.x, sine * around.y, cosine)));
}
