// SPDX-License-Identifier: MIT
// What all models of BxDFs share. A model works in local directions, unit length, away from the
// surface: z along the shading normal, x and y along its tangents, wo.z > 0. Weight, texture and
// Fresnel term of thesis (3.52) are applied outside.
//
// Cosines of wi and wo are MIN_COSINE at least (bsdf.h): the quotients of the models are bounded by
// that. A direction closer to the horizon carries less than 1e-9 of the light that a surface may
// receive.
#pragma once

#include "renderer/shared/compat.h"

#define MIN_COSINE 1e-10f

/// A BxDF for a pair of directions.
typedef struct Lobe {
    float f_cos;   ///< f |wi.z|, 1/sr
    float pdf_w;   ///< density per solid angle with which the model's own sampling gives wi;
                   ///< positive where f_cos is
    float cosine;  ///< of wo and the normal at which a Fresnel term is evaluated
} Lobe;

DEVICE Lobe make_lobe(float f_cos, float pdf_w, float cosine) {
    Lobe lobe;
    lobe.f_cos = f_cos;
    lobe.pdf_w = pdf_w;
    lobe.cosine = cosine;
    return lobe;
}

DEVICE Lobe no_lobe(void) {
    return make_lobe(0.0f, 0.0f, 0.0f);
}

/// wo mirrored about the unit vector h.
DEVICE float3 reflect_about(float3 wo, float3 h) {
    return (2.0f * dot(wo, h)) * h - wo;
}
