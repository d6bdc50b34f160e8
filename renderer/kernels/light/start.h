// SPDX-License-Identifier: MIT
// The start of a light path, which two stages derive from its random words.
#pragma once

#include "renderer/kernels/light/emission.h"
#include "renderer/kernels/sampling/sampler.h"
#include "renderer/kernels/scene_view.h"
#include "renderer/shared/integrator_settings.h"

/// Returns the start of light path `index` of sample `sample`. It is the same on every call.
DEVICE EmissionSample light_path_start(PRIVATE const SceneView *scene, IntegratorSettings settings,
                                       uint index, ulong sample) {
    return sample_emission(scene, path_sample(settings, index, sample, BLOCK_EMISSION(0u)),
                           path_sample(settings, index, sample, BLOCK_EMISSION(1u)));
}
