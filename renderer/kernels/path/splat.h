// SPDX-License-Identifier: MIT
// Splats: contributions of light paths to the pixels that see them.
#pragma once

#include "renderer/kernels/film/add_sample.h"
#include "renderer/kernels/path/shadow_ray.h"
#include "renderer/kernels/path/trials.h"
#include "renderer/kernels/scene_view.h"
#include "renderer/shared/path_state.h"

/// Adds the shadow radiance of a light path to the film unless its shadow ray is blocked.
DEVICE void splat(Path path, PRIVATE const SceneView *scene, FilmView film) {
    const uint pixel = get_splat_pixel(path);
    const float3 radiance = get_shadow_radiance(path);
    prefetch_pixel(film, pixel, path, radiance);
    if (is_shadowed(path, scene)) {
        return;
    }
    if (FEATURE_light_path_trials) {
        add_splat_trials(path);
    } else {
        add_to_pixel(film, pixel, path, radiance);
    }
}
