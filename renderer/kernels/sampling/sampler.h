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

/// Where the words of a path come from: path `path` among the `paths` of sample `sample` of a
/// pixel.
typedef struct WordSource {
    uint stream, pixel;
    ulong sample;
    uint paths, path;
} WordSource;

/// Returns the source of a camera path's words. A pixel has the words that it has in the full
/// picture.
DEVICE_LANE WordSource camera_source(IntegratorSettings settings, uint stream, uint pixel,
                                     ulong sample) {
    if (FEATURE_crop) {
        pixel = pixel / settings.film_width * settings.full_width + pixel % settings.film_width +
                settings.first_pixel;
    }
    const WordSource source = {stream, pixel, sample, 1u, 0u};
    return source;
}

/// Returns the source of a path's words. In a light pass, `pixel` is the index of the light path
/// within its sample, and `stream` is not read. All light paths share one sequence.
DEVICE_LANE WordSource path_source(IntegratorSettings settings, uint stream, uint pixel,
                                   ulong sample) {
    if (FEATURE_from_light) {
        const WordSource source = {STREAM_LIGHT_PATHS, 0u, sample, settings.light_paths, pixel};
        return source;
    }
    return camera_source(settings, stream, pixel, sample);
}

/// Returns independent words.
DEVICE_LANE uint4 independent_words(uint seed, WordSource source, uint block) {
    return random_words(seed, source.stream, source.pixel,
                        source.sample * source.paths + source.path, block);
}

/// Returns Sobol words.
DEVICE_LANE uint4 sobol_words(uint seed, WordSource source, uint block) {
    const ulong index = source.sample / SOBOL_SEQUENCES * source.paths + source.path;
    // A sequence has 2^32 points, after which the next sequence starts.
    const ulong sequence = (index >> 32) * SOBOL_SEQUENCES + source.sample % SOBOL_SEQUENCES;
    const uint4 seeds = seed_words(seed, source.stream, source.pixel, sequence, block);
    // A bijection of the sum, which is independent of any three of the seeds.
    const uint sum = (seeds.x + seeds.y + seeds.z + seeds.w) * 0x9e3779b1u;
    return sobol_point((uint)index, sum ^ (sum >> 16), seeds);
}

/// Returns regular words. They are the same in all pixels, whatever the seed.
DEVICE uint4 regular_words(WordSource source, uint block) {
    const ulong sequence = (source.sample >> 32) << 1;
    const uint4 seeds = random_words(0u, source.stream, 0u, sequence, block);
    const uint order = random_words(0u, source.stream, 0u, sequence + 1u, block).x;
    return regular_point((uint)source.sample, order, seeds);
}

/// Returns whether the words of a block are Sobol points: those of the camera or the emission, and
/// of the first events.
DEVICE_LANE bool is_sobol_block(IntegratorSettings settings, uint block) {
    return FEATURE_sobol && settings.sampler == SAMPLER_SOBOL &&
           (block < BLOCK_LIGHT(SOBOL_EVENTS) || block >= BLOCK_EMISSION(0u));
}

DEVICE bool has_regular_words(IntegratorSettings settings) {
    return FEATURE_sobol && settings.sampler == SAMPLER_REGULAR;
}

/// Returns the four words of a block. Each is uniform, and independent of those of all other
/// blocks, pixels and streams. Successive samples are either independent or points of stratified
/// sequences. Regular samples are not random.
DEVICE uint4 words_of(IntegratorSettings settings, WordSource source, uint block) {
    if (has_regular_words(settings)) {
        return regular_words(source, block);
    }
    return is_sobol_block(settings, block) ? sobol_words(settings.seed, source, block)
                                           : independent_words(settings.seed, source, block);
}

/// Returns the words of a block of a path, by path_source.
DEVICE uint4 path_sample(IntegratorSettings settings, uint pixel, ulong sample, uint block) {
    return words_of(settings, path_source(settings, STREAM_CAMERA, pixel, sample), block);
}
