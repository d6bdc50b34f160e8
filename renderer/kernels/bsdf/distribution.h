// SPDX-License-Identifier: MIT
// Distributions of microfacet normals, GGX and Beckmann, with sampling of visible normals.
//
// Local directions are those of lobe.h. Normals m are unit vectors with m.z > 0. Roughness is in
// [1e-4, 1] along x and y.
//
// Sources:
// - B. Walter, S. Marschner, H. Li, K. Torrance, "Microfacet Models for Refraction through Rough
//   Surfaces", 2007: D and G1.
// - E. Heitz, "Understanding the Masking-Shadowing Function in Microfacet-Based BRDFs", 2014:
//   anisotropic forms.
// - J. Dupuy, A. Benyoub, "Sampling Visible GGX Normals with Spherical Caps", 2023: sampling of
//   GGX.
// - W. Jakob, "An Improved Visible Normal Sampling Routine for the Beckmann Distribution", 2014:
//   sampling of Beckmann.
//
// Departures:
// - G1 of Beckmann is exact. Walter's rational fit has an error of 0.4 %, which would enter the
//   sampling density.
// - The slope equation is multiplied by the sine instead of divided by the cosine, so that it is
//   valid from normal to grazing incidence.
#pragma once

#include "renderer/kernels/math/circle.h"
#include "renderer/shared/compat.h"

/// Roughness and type of a distribution.
typedef struct Roughness {
    float alpha_x, alpha_y;
    uint beckmann;  ///< nonzero for Beckmann, 0 for GGX
} Roughness;

/// Returns the squared length of w's projection onto the surface, stretched by the roughness.
DEVICE float stretched_sine2(float3 w, Roughness r) {
    const float x = r.alpha_x * w.x, y = r.alpha_y * w.y;
    return x * x + y * y;
}

/// Returns D(m) of GGX. m.x and m.y keep their relative precision near the pole, where m.z rounds
/// to 1.
DEVICE float ggx_density(float3 m, Roughness r) {
    const float x = m.x / r.alpha_x, y = m.y / r.alpha_y;
    const float s = x * x + y * y + m.z * m.z;
    return INV_PI / (r.alpha_x * r.alpha_y * s * s);
}

/// Returns G1(w) / |w.z| = 2 / (|w.z| + sqrt(w.z^2 + (alpha w)^2)) of GGX, which does not cancel.
DEVICE float ggx_shadowing(float3 w, Roughness r) {
    return 2.0f / (fabs(w.z) + sqrt(w.z * w.z + stretched_sine2(w, r)));
}

/// Samples a visible normal of GGX. A uniform point on the cap of the unit sphere above -w.z, plus
/// w, is normal to the stretched ellipsoid of normals. With t = 1 - u its height is t (1 + w.z) -
/// w.z. The height of the sum is t (1 + w.z) > 0, and 1 - z^2 is a product of two sums of positive
/// terms.
DEVICE float3 ggx_visible_normal(float3 wo, Roughness r, float u, float v) {
    const float3 w = normalize(make_float3(r.alpha_x * wo.x, r.alpha_y * wo.y, wo.z));
    const float t = 1.0f - u;
    const float one_plus = 1.0f + w.z;
    const float one_minus = (w.x * w.x + w.y * w.y) / one_plus;
    const float radius = sqrt(u * one_plus * (t * one_plus + one_minus));
    const float2 around = point_on_circle(v);
    const float3 sum = make_float3(w.x + radius * around.x, w.y + radius * around.y, t * one_plus);
    return normalize(make_float3(r.alpha_x * sum.x, r.alpha_y * sum.y, sum.z));
}

#define INV_SQRT_PI 0.564189583547756f

/// Returns D(m) of Beckmann.
DEVICE float beckmann_density(float3 m, Roughness r) {
    const float x = m.x / m.z / r.alpha_x, y = m.y / m.z / r.alpha_y;
    const float power = exp(-(x * x + y * y));
    // m.z > 0.09 if the exponential is not 0, since alpha <= 1.
    const float z2 = m.z * m.z;
    return power > 0.0f ? INV_PI * power / (r.alpha_x * r.alpha_y * z2 * z2) : 0.0f;
}

/// Returns G1(w) / |w.z| = 1 / (|w.z| (1 + Lambda)) of Beckmann, with Lambda = (exp(-a^2) / (a
/// sqrt(pi)) - erfc(a)) / 2 and a = |w.z| / |alpha w|. The terms of Lambda cancel for large a only,
/// where Lambda vanishes against 1.
DEVICE float beckmann_shadowing(float3 w, Roughness r) {
    const float z = fabs(w.z);
    const float sine = sqrt(stretched_sine2(w, r));
    const float a = sine > 0.0f ? z / sine : INFINITY;
    if (a > 5.0f) {
        return 1.0f / z;  // Lambda < 1e-13
    }
    // |w.z| / a is the sine.
    return 2.0f / (z * (2.0f - erfc(a)) + sine * INV_SQRT_PI * exp(-a * a));
}

/// Samples the slope along the azimuth of a direction with cosine c and sine s, on a surface of
/// unit roughness. Its density is proportional to max(c - x s, 0) exp(-x^2). In terms of w = 1 +
/// erf(x), its distribution function is P(w) = c w + s exp(-x^2) / sqrt(pi) up to a factor. dP/dw =
/// c - s x is positive up to the largest visible slope c / s. Newton's method in w is kept in a
/// bracket by bisection. Towards u = 1 the root becomes double, and each step halves the distance.
DEVICE float beckmann_visible_slope(float c, float s, float u) {
    const float largest = s > 0.0f ? c / s : INFINITY;
    // 1.9999999 corresponds to x = 3.7.
    float upper = largest < 4.0f ? min(1.0f + erf(largest), 1.9999999f) : 1.9999999f;
    const float tail = largest < 4.0f ? exp(-largest * largest) : 0.0f;
    const float target = u * (c * upper + s * INV_SQRT_PI * tail);
    // Jakob's starting point, with theta the angle of incidence.
    const float theta = acos(min(c, 1.0f));
    const float fit = 1.0f + theta * (-0.876f + theta * (0.4265f - 0.0594f * theta));
    float lower = 0.0f;
    float w = upper * (1.0f - pow(1.0f - u, fit));
    float x = 0.0f;
    for (uint i = 0u; i < 12u; ++i) {
        if (!(w > lower && w < upper)) {
            w = 0.5f * (lower + upper);
        }
        x = inverse_erf_plus_one(w);
        const float excess = c * w + s * INV_SQRT_PI * exp(-x * x) - target;
        if (fabs(excess) < 1e-5f * target) {
            break;
        }
        if (excess > 0.0f) {
            upper = w;
        } else {
            lower = w;
        }
        // Where the slope is 0, the bracket catches the result.
        w -= excess / (c - s * x);
    }
    return x;
}

/// Samples a visible normal of Beckmann.
DEVICE float3 beckmann_visible_normal(float3 wo, Roughness r, float u, float v) {
    const float3 w = normalize(make_float3(r.alpha_x * wo.x, r.alpha_y * wo.y, wo.z));
    const float sine = sqrt(w.x * w.x + w.y * w.y);
    const float slope_x = beckmann_visible_slope(w.z, sine, max(u, 0x1p-25f));
    const float slope_y = inverse_erf_plus_one(max(2.0f * v, 0x1p-24f));
    // Rotates the slopes to wo's azimuth. The slope of a normal is opposite to its x and y.
    const float cos_phi = sine > 0.0f ? w.x / sine : 1.0f;
    const float sin_phi = sine > 0.0f ? w.y / sine : 0.0f;
    const float x = cos_phi * slope_x - sin_phi * slope_y;
    const float y = sin_phi * slope_x + cos_phi * slope_y;
    return normalize(make_float3(-r.alpha_x * x, -r.alpha_y * y, 1.0f));
}

/// Returns whether the distribution is Beckmann's.
DEVICE bool is_beckmann(Roughness r) {
    return FEATURE_beckmann && (!FEATURE_ggx || r.beckmann != 0u);
}

/// Returns D(m), in 1/sr: the area of the microfacets facing m, per solid angle and area of
/// surface.
DEVICE float normal_density(float3 m, Roughness r) {
    return is_beckmann(r) ? beckmann_density(m, r) : ggx_density(m, r);
}

/// Returns Smith's G1(w) / |w.z|. It is bounded by 1 / |w.z| and does not become 0 / 0 towards the
/// horizon.
DEVICE float shadowing(float3 w, Roughness r) {
    return is_beckmann(r) ? beckmann_shadowing(w, r) : ggx_shadowing(w, r);
}

/// Samples a normal visible from wo, from u, v in [0, 1). Density per solid angle: max(wo.m, 0)
/// D(m) G1(wo) / wo.z.
DEVICE float3 visible_normal(float3 wo, Roughness r, float u, float v) {
    return is_beckmann(r) ? beckmann_visible_normal(wo, r, u, v) : ggx_visible_normal(wo, r, u, v);
}
