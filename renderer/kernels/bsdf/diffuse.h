// SPDX-License-Identifier: MIT
// Lambert and Oren-Nayar reflection. Local directions have z along the shading normal and wo.z > 0.
//
// Both are sampled by the cosine, with density wi.z / pi per solid angle: thesis (3.32).
#pragma once

#include "renderer/kernels/bsdf/lobe.h"
#include "renderer/kernels/sampling/hemisphere.h"
#include "renderer/shared/compat.h"

/// Evaluates Lambert reflection, thesis (3.31).
DEVICE Lobe lambert_evaluate(float3 wo, float3 wi) {
    return wi.z > 0.0f ? make_lobe(wi.z * INV_PI, wi.z * INV_PI, wo.z) : no_lobe();
}

/// Evaluates Oren-Nayar reflection, thesis (3.33)-(3.35), with `sigma` in [0, pi/2].
///
/// cos(phi_i - phi_o) sin(alpha) tan(beta) equals (wi.x wo.x + wi.y wo.y) / max(wi.z, wo.z). The
/// sines of the larger and the smaller angle cancel those that normalise the azimuths, and the
/// smaller angle has the larger cosine. The product with wi.z follows the division, whose result is
/// at most 1.
DEVICE Lobe oren_nayar_evaluate(float3 wo, float3 wi, float sigma) {
    if (!(wi.z > 0.0f)) {
        return no_lobe();
    }
    const float sigma2 = sigma * sigma;
    const float a = 1.0f - 0.5f * sigma2 / (sigma2 + 0.33f);
    const float b = 0.45f * sigma2 / (sigma2 + 0.09f);
    const float s = max(wi.x * wo.x + wi.y * wo.y, 0.0f) * (wi.z / max(wi.z, wo.z));
    return make_lobe((a * wi.z + b * s) * INV_PI, wi.z * INV_PI, wo.z);
}
