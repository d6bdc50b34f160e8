// SPDX-License-Identifier: MIT
// Ideal reflection and refraction: delta distributions, thesis (3.36)-(3.43). They have only
// directions and coefficients. Local directions are those of lobe.h.
#pragma once

#include "renderer/kernels/bsdf/fresnel.h"
#include "renderer/shared/compat.h"

/// Returns the factor, besides the Fresnel term, by which radiance changes on arrival through a
/// boundary: thesis (3.40), the squared ratio of the index on wo's side to that on wi's side. `eta`
/// is the index on wi's side over that on wo's side. This is the only place where radiance and
/// importance differ: the factor for importance, which light paths carry, is 1 (Veach 1997, section
/// 5.2).
DEVICE float refraction_scale(float eta) {
    return 1.0f / (eta * eta);
}

/// Returns the mirror direction, thesis (3.37).
DEVICE float3 ideal_reflection_direction(float3 wo) {
    return make_float3(-wo.x, -wo.y, wo.z);
}

/// Returns the refracted direction, thesis (3.41); z is 0 at total internal reflection.
DEVICE float3 ideal_refraction_direction(float3 wo, float eta) {
    const float cosine = refracted_cosine(wo.z, squared_sine(wo), eta);
    return cosine > 0.0f ? make_float3(-wo.x / eta, -wo.y / eta, -cosine)
                         : make_float3(0.0f, 0.0f, 0.0f);
}
