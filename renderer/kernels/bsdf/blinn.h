// SPDX-License-Identifier: MIT
// Torrance-Sparrow reflection with Blinn's distribution of normals, exponent e: thesis
// (3.44)-(3.47). Local directions are those of lobe.h.
//
// The density of directions is (e + 1) cos^e(theta_h) / (8 pi wo.h); thesis (3.48) lacks the factor
// 1 / (2 pi).
//
// cos^e follows from tan^2(theta_h) = (h.x^2 + h.y^2) / h.z^2 as exp(-e/2 log(1 + tan^2)), which
// has full precision. Near the pole, by contrast, one ulp of the cosine is a factor of 0.55 at
// exponent 1e7.
#pragma once

#include "renderer/kernels/bsdf/lobe.h"
#include "renderer/kernels/math/circle.h"
#include "renderer/shared/compat.h"

/// Evaluates the model with exponent `exponent`.
DEVICE Lobe blinn_evaluate(float3 wo, float3 wi, float exponent) {
    if (!(wi.z > 0.0f)) {
        return no_lobe();
    }
    // Not normalised. |h| >= h.z >= 2 MIN_COSINE, so its square is a normal float.
    const float3 h = wo + wi;
    const float h_length = sqrt(dot(h, h));
    const float cos_h = h.z / h_length;
    const float wo_h = 0.5f * h_length;  // |wo + wi| = 2 wo.h
    const float tan_x = h.x / h.z, tan_y = h.y / h.z;
    const float power = exp(-0.5f * exponent * log1p(tan_x * tan_x + tan_y * tan_y));
    // G / wo.z of thesis (3.46), with the division moved into each argument of the minima.
    const float shadowing = min(min(1.0f, 2.0f * cos_h * wi.z / wo_h) / wo.z, 2.0f * cos_h / wo_h);
    const float f_cos = (exponent + 2.0f) * INV_PI * 0.125f * power * shadowing;
    const float pdf_w = (exponent + 1.0f) * INV_PI * 0.125f * power / wo_h;
    return make_lobe(f_cos, pdf_w, wo_h);
}

/// Samples a direction by half vectors of density (e + 1) / (2 pi) cos^e, from u, v in [0, 1). A
/// direction below the horizon is invalid.
DEVICE float3 blinn_direction(float3 wo, float exponent, float u, float v) {
    // cos = (1 - u)^(1 / (e + 1)), hence tan^2 = cos^-2 - 1 = expm1(...), whose argument is at most
    // 34.
    const float slope = sqrt(expm1(-2.0f * log1p(-u) / (exponent + 1.0f)));
    const float2 around = point_on_circle(v);
    const float3 h = normalize(make_float3(slope * around.x, slope * around.y, 1.0f));
    return reflect_about(wo, h);
}
