// SPDX-License-Identifier: MIT
// Torrance-Sparrow reflection with Blinn's distribution of normals: thesis (3.44-3.47), exponent e.
// Local directions as in lobe.h.
//
// The density of directions is (e + 1) cos^e(theta_h) / (8 pi wo.h): (3.48) lacks 1 / (2 pi).
//
// cos^e is taken from tan^2(theta_h) = (h.x^2 + h.y^2) / h.z^2, cos^e = exp(-e/2 log(1 + tan^2)):
// next to the pole one ulp of the cosine is a factor 0.55 at exponent 1e7, while tan^2 has full
// precision.
#pragma once

#include "renderer/kernels/bsdf/lobe.h"
#include "renderer/kernels/math/circle.h"
#include "renderer/shared/compat.h"

#if FEATURE_blinn

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
    // G / wo.z: thesis (3.46), the division taken into each argument of the minima.
    const float shadowing = min(min(1.0f, 2.0f * cos_h * wi.z / wo_h) / wo.z, 2.0f * cos_h / wo_h);
    const float f_cos = (exponent + 2.0f) * INV_PI * 0.125f * power * shadowing;
    const float pdf_w = (exponent + 1.0f) * INV_PI * 0.125f * power / wo_h;
    return make_lobe(f_cos, pdf_w, wo_h);
}

/// Half vectors with density (e + 1) / (2 pi) cos^e; u, v in [0, 1). A direction below the horizon
/// is none.
DEVICE float3 blinn_direction(float3 wo, float exponent, float u, float v) {
    // cos = (1 - u)^(1 / (e + 1)), hence tan^2 = cos^-2 - 1 = expm1(...); its argument is at
    // most 34.
    const float slope = sqrt(expm1(-2.0f * log1p(-u) / (exponent + 1.0f)));
    const float2 around = point_on_circle(v);
    const float3 h = normalize(make_float3(slope * around.x, slope * around.y, 1.0f));
    return reflect_about(wo, h);
}

#endif
