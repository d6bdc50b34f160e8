// SPDX-License-Identifier: MIT
#pragma once

#include "renderer/kernels/light/emission.h"
#include "renderer/kernels/sampling/sampler.h"
#include "renderer/shared/integrator_settings.h"
#include "renderer/shared/scene_buffers.h"

/// Where light path number `path` of a sample starts: the same whenever it is asked for.
DEVICE EmissionSample path_start(SURFACE_PARAMETERS LIGHT_PARAMETERS IntegratorSettings settings,
                                 uint path, ulong sample) {
    return sample_emission(
        SURFACE_ARGUMENTS LIGHT_ARGUMENTS path_sample(settings, path, sample, BLOCK_EMISSION(0u)),
        path_sample(settings, path, sample, BLOCK_EMISSION(1u)));
}
