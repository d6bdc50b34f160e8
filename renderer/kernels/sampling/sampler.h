// SPDX-License-Identifier: MIT
// The random words of a path, from the sampler that the settings select.
#pragma once

#include "renderer/kernels/sampling/random.h"
#include "renderer/kernels/sampling/sobol.h"
#include "renderer/shared/integrator_settings.h"

/// Returns the four words of block `block`. Each is uniform, and independent of those of all other
/// blocks, pixels and streams. Successive samples are either independent or points of a stratified
/// sequence. Regular samples are not random: they are the same in all pixels, whatever the seed. A
/// pixel has the words that it has in the full picture.
DEVICE uint4 sample_words(IntegratorSettings settings, uint stream, uint pixel, ulong sample,
                          uint block) {
    if (FEATURE_crop && !FEATURE_from_light) {
        pixel = pixel / settings.film_width * settings.full_width + pixel % settings.film_width +
                settings.first_pixel;
    }
    if (FEATURE_sobol && settings.sampler == SAMPLER_SOBOL) {
        // A sequence has 2^32 points, after which the next sequence starts.
        const ulong sequence = (sample >> 32) << 1;
        const uint4 seeds = random_words(settings.seed, stream, pixel, sequence, block);
        const uint order = random_words(settings.seed, stream, pixel, sequence + 1u, block).x;
        return sobol_point((uint)sample, order, seeds);
    }
    if (FEATURE_sobol && settings.sampler == SAMPLER_REGULAR) {
        const ulong sequence = (sample >> 32) << 1;
        const uint4 seeds = random_words(0u, stream, 0u, sequence, block);
        const uint order = random_words(0u, stream, 0u, sequence + 1u, block).x;
        return regular_point((uint)sample, order, seeds);
    }
    return random_words(settings.seed, stream, pixel, sample, block);
}

/// Returns random words of a path. In a camera pass, `pixel` is the pixel. In a light pass, it is
/// the index of the light path within its sample, and all paths of all samples share one sequence.
DEVICE uint4 path_sample(IntegratorSettings settings, uint pixel, ulong sample, uint block) {
    if (FEATURE_from_light) {
        return sample_words(settings, STREAM_LIGHT_PATHS, 0u, sample * settings.light_paths + pixel,
                            block);
    }
    return sample_words(settings, STREAM_CAMERA, pixel, sample, block);
}
