// SPDX-License-Identifier: MIT
// The dielectric coat over a Lambert reflector: renderer/scene/stores.h has the model. Local
// directions are those of lobe.h.
#pragma once

#include "renderer/kernels/bsdf/fresnel.h"
#include "renderer/kernels/scene_view.h"
#include "renderer/shared/compat.h"
#include "renderer/shared/scene_records.h"

/// Returns the share of light along `w` that the coat transmits.
///
/// That of a rough coat is interpolated between nodes that are equidistant in the root of the
/// cosine, since it bends near the horizon. The error is below 5e-4 for an index from 1.1 to 3, and
/// below 1.5e-3 for one from 1.01 on. A path's contribution has the product of two such factors.
DEVICE float coat_transmittance(PRIVATE const SceneView *scene, GLOBAL const BxdfRecord *component,
                                float3 w) {
    const float cosine = min(fabs(w.z), 1.0f);
    if (!(component->alpha_x > 0.0f)) {
        return 1.0f - fresnel_dielectric(cosine, squared_sine(w), component->eta[0]);
    }
    const float at = sqrt(cosine) * (float)(COAT_NODES - 1u);
    const uint node = min((uint)at, COAT_NODES - 2u);
    GLOBAL const float *table = scene->coat_transmittances + component->coat_or_roughness;
    return table[node] + (table[node + 1u] - table[node]) * (at - (float)node);
}

/// Returns the colour of a base below the coat, relative to the light that passes the coat in both
/// directions. `colour` is within [0, 1] and the share of light reflected back is below 1.
DEVICE float3 colour_below_coat(GLOBAL const BxdfRecord *component, float3 colour) {
    const float inner = component->parameter;
    return component->k[0] * make_float3(colour.x / (1.0f - inner * colour.x),
                                         colour.y / (1.0f - inner * colour.y),
                                         colour.z / (1.0f - inner * colour.z));
}
