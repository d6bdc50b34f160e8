// SPDX-License-Identifier: MIT
// The random words of a path, from the sampler that the settings select.
//
// Sobol samples alternate between SOBOL_SEQUENCES sequences with independent scramblings. The
// scatter of the sequences' means therefore shows the error of the image, whatever stratification
// gains. The scatter of single samples would exaggerate it.
//
// Only the first few events of a path have Sobol points. Later ones depend on so many numbers that
// stratification gains nothing, and independent numbers cost less.
#pragma once

#include "renderer/kernels/sampling/random.h"
#include "renderer/kernels/sampling/sobol.h"
#include "renderer/shared/integrator_settings.h"

/// Returns whether the words of a block are Sobol points: those of the camera or the emission, and
/// of the first events.
DEVICE bool is_sobol_block(uint block) {
    return block < BLOCK_LIGHT(SOBOL_EVENTS) || block >= BLOCK_EMISSION(0u);
}

/// Returns Sobol words of path `path` among the `paths` of each sample.
DEVICE uint4 sobol_words(uint seed, uint stream, uint pixel, ulong sample, uint paths, uint path,
                         uint block) {
    const ulong index = sample / SOBOL_SEQUENCES * paths + path;
    // A sequence has 2^32 points, after which the next sequence starts.
    const ulong sequence = (index >> 32) * SOBOL_SEQUENCES + sample % SOBOL_SEQUENCES;
    const uint4 seeds = seed_words(seed, stream, pixel, sequence, block);
    // A bijection of the sum, which is independent of any three of the seeds.
    const uint sum = (seeds.x + seeds.y + seeds.z + seeds.w) * 0x9e3779b1u;
    return sobol_point((uint)index, sum ^ (sum >> 16), seeds);
}

/// Returns regular words. They are the same in all pixels, whatever the seed.
DEVICE uint4 regular_words(uint stream, ulong sample, uint block) {
    const ulong sequence = (sample >> 32) << 1;
    const uint4 seeds = random_words(0u, stream, 0u, sequence, block);
    const uint order = random_words(0u, stream, 0u, sequence + 1u, block).x;
    return regular_point((uint)sample, order, seeds);
}

/// Returns the four words of block `block` of path `path` among the `paths` of each sample. Each is
/// uniform, and independent of those of all other blocks, pixels and streams. Successive samples
/// are either independent or points of stratified sequences. Regular samples are not random. A
/// pixel has the words that it has in the full picture.
DEVICE uint4 words_of_path(IntegratorSettings settings, uint stream, uint pixel, ulong sample,
                           uint paths, uint path, uint block) {
    if (FEATURE_crop && !FEATURE_from_light) {
        pixel = pixel / settings.film_width * settings.full_width + pixel % settings.film_width +
                settings.first_pixel;
    }
    if (FEATURE_sobol && settings.sampler == SAMPLER_SOBOL && is_sobol_block(block)) {
        return sobol_words(settings.seed, stream, pixel, sample, paths, path, block);
    }
    if (FEATURE_sobol && settings.sampler == SAMPLER_REGULAR) {
        return regular_words(stream, sample, block);
    }
    return random_words(settings.seed, stream, pixel, sample * paths + path, block);
}

/// Returns the four words of block `block` of a pixel's sample.
DEVICE uint4 sample_words(IntegratorSettings settings, uint stream, uint pixel, ulong sample,
                          uint block) {
    return words_of_path(settings, stream, pixel, sample, 1u, 0u, block);
}

/// Returns random words of a path. In a camera pass, `pixel` is the pixel. In a light pass, it is
/// the index of the light path within its sample, and all paths of a sample and of the later ones
/// share their sequence.
DEVICE uint4 path_sample(IntegratorSettings settings, uint pixel, ulong sample, uint block) {
    if (FEATURE_from_light) {
        return words_of_path(settings, STREAM_LIGHT_PATHS, 0u, sample, settings.light_paths, pixel,
                             block);
    }
    return sample_words(settings, STREAM_CAMERA, pixel, sample, block);
}
