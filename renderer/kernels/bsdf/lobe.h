// SPDX-License-Identifier: MIT
// The common interface of the BxDF models.
//
// A model uses local directions: unit vectors away from the surface, with z along the shading
// normal, x and y along its tangents, and wo.z > 0. The weight, texture and Fresnel term of thesis
// (3.52) are applied outside the model.
//
// The cosines of wi and wo are at least MIN_COSINE (bsdf.h), which bounds the quotients in the
// models. A direction closer to the horizon carries less than 1e-9 of the light that a surface may
// receive.
#pragma once

#include "renderer/shared/compat.h"

#define MIN_COSINE 1e-10f

/// The value of a BxDF for a pair of directions.
typedef struct Lobe {
    float f_cos;  ///< f |wi.z|, 1/sr
    /// Density per solid angle with which the model's own sampling gives wi; positive where f_cos
    /// is.
    float pdf_w;
    float cosine;  ///< cosine between wo and the normal at which a Fresnel term is evaluated
} Lobe;

DEVICE Lobe make_lobe(float f_cos, float pdf_w, float cosine) {
    Lobe lobe;
    lobe.f_cos = f_cos;
    lobe.pdf_w = pdf_w;
    lobe.cosine = cosine;
    return lobe;
}

/// Returns the value of a direction to which a model does not scatter.
DEVICE Lobe no_lobe(void) {
    return make_lobe(0.0f, 0.0f, 0.0f);
}

/// Returns wo mirrored about the unit vector h.
DEVICE float3 reflect_about(float3 wo, float3 h) {
    return (2.0f * dot(wo, h)) * h - wo;
}
