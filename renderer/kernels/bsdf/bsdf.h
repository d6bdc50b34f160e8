// SPDX-License-Identifier: MIT
// Reflection at a surface. Directions wi and wo are unit vectors pointing away from the surface; wo leads to where
// the path came from. Densities are per solid angle. Each model's sample, evaluate and pdf stand together.
#pragma once

#include "renderer/kernels/sampling/hemisphere.h"
#include "renderer/shared/compat.h"
#include "renderer/shared/scene_records.h"

/// A sampled direction. `weight` is f |cos| / pdf_w; pdf_w is 0 when nothing was sampled.
typedef struct BsdfSample {
    float3 wi;
    float3 weight;
    float pdf_w;
} BsdfSample;

#if FEATURE_lambert

// Lambert reflector, thesis (3.31): f = reflectance / pi on wo's side of the surface. The normal `n` is on that
// side.

DEVICE float3 lambert_evaluate(BxdfRecord component, float3 n, float3 wi) {
    const float3 reflectance = make_float3(component.weight[0], component.weight[1], component.weight[2]);
    return dot(n, wi) > 0.0f ? reflectance * INV_PI : make_float3(0.0f, 0.0f, 0.0f);
}

DEVICE float lambert_pdf(float3 n, float3 wi) { return max(dot(n, wi), 0.0f) * INV_PI; }

DEVICE BsdfSample lambert_sample(BxdfRecord component, float3 n, float u, float v) {
    const float3 tangent_wi = sample_cosine_hemisphere(u, v);
    BsdfSample sample;
    sample.wi = normalize(to_world(frame_from_z(n), tangent_wi));
    sample.weight = make_float3(component.weight[0], component.weight[1], component.weight[2]);
    sample.pdf_w = tangent_wi.z * INV_PI;
    return sample;
}

#endif

/// f(wi, wo), 1/sr; `n` is the geometric normal on wo's side.
DEVICE float3 bsdf_evaluate(BxdfRecord component, float3 n, float3 wi) {
#if FEATURE_lambert
    return lambert_evaluate(component, n, wi);
#else
    return make_float3(0.0f, 0.0f, 0.0f);
#endif
}

DEVICE float bsdf_pdf(float3 n, float3 wi) {
#if FEATURE_lambert
    return lambert_pdf(n, wi);
#else
    return 0.0f;
#endif
}

DEVICE BsdfSample bsdf_sample(BxdfRecord component, float3 n, float u, float v) {
#if FEATURE_lambert
    return lambert_sample(component, n, u, v);
#else
    BsdfSample nothing;
    nothing.wi = n;
    nothing.weight = make_float3(0.0f, 0.0f, 0.0f);
    nothing.pdf_w = 0.0f;
    return nothing;
#endif
}
