// SPDX-License-Identifier: MIT
// Reflection and refraction by rough boundaries.
//
// Source: Walter et al. 2007, equations 20 and 21, with separable shadowing G = G1(wi) G1(wo),
// equation 23. Local directions are those of lobe.h. Fresnel terms at wo.m are applied outside.
#pragma once

#include "renderer/kernels/bsdf/distribution.h"
#include "renderer/kernels/bsdf/fresnel.h"
#include "renderer/kernels/bsdf/ideal.h"
#include "renderer/kernels/bsdf/lobe.h"
#include "renderer/shared/compat.h"

/// Evaluates rough reflection.
DEVICE Lobe microfacet_reflection_evaluate(float3 wo, float3 wi, Roughness r) {
    if (!(wi.z > 0.0f)) {
        return no_lobe();
    }
    const float3 h = wo + wi;  // |h| >= h.z >= 2 MIN_COSINE
    const float h_length = sqrt(dot(h, h));
    // Density of visible normals times dw_m / dw_i = 1 / (4 wo.m).
    const float pdf_w = 0.25f * normal_density(h / h_length, r) * shadowing(wo, r);
    return make_lobe(pdf_w * (shadowing(wi, r) * wi.z), pdf_w, 0.5f * h_length);
}

/// Samples a reflected direction from u, v in [0, 1). A direction below the horizon is invalid.
DEVICE float3 microfacet_reflection_direction(float3 wo, Roughness r, float u, float v) {
    return reflect_about(wo, visible_normal(wo, r, u, v));
}

/// Evaluates rough refraction. `eta` is the index on wi's side over that on wo's side. It is not 1,
/// since there would be no boundary. Radiance is scaled by refraction_scale, which is the factor
/// eta_o^2 in equation 21.
DEVICE Lobe microfacet_refraction_evaluate(float3 wo, float3 wi, Roughness r, float eta) {
    if (!(wi.z < 0.0f)) {
        return no_lobe();
    }
    // Equation 16: along the normal of the microfacet that refracts wo to wi.
    float3 m = wo + eta * wi;
    const float m2 = dot(m, m);
    // m2 is 0 if wi = -wo and eta is 1 up to rounding; no microfacet refracts so.
    if (!(m2 > 1e-14f)) {
        return no_lobe();
    }
    m = m / sqrt(m2);
    m = m.z < 0.0f ? -m : m;
    const float wo_m = dot(wo, m), wi_m = dot(wi, m);
    if (!(m.z > 0.0f && wo_m > 0.0f && wi_m < 0.0f)) {
        return no_lobe();
    }
    // Equation 17: dw_m / dw_i = eta^2 |wi.m| / (wo.m + eta wi.m)^2, whose denominator is |wo + eta
    // wi|^2.
    const float pdf_w = normal_density(m, r) * shadowing(wo, r) * wo_m * (eta * eta * -wi_m / m2);
    return make_lobe(pdf_w * (shadowing(wi, r) * -wi.z) * refraction_scale(eta), pdf_w, wo_m);
}

/// Samples a refracted direction from u, v in [0, 1). z is 0 at total internal reflection. A
/// direction above the horizon is invalid.
DEVICE float3 microfacet_refraction_direction(float3 wo, Roughness r, float eta, float u, float v) {
    const float3 m = visible_normal(wo, r, u, v);
    const float wo_m = dot(wo, m);
    const float cosine = refracted_cosine(wo_m, squared_sine_of(wo_m), eta);
    if (!(wo_m > 0.0f && cosine > 0.0f)) {
        return make_float3(0.0f, 0.0f, 0.0f);
    }
    return (wo_m / eta - cosine) * m - wo / eta;
}
