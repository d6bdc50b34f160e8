// SPDX-License-Identifier: MIT
// The shadow ray of a path: the segment between its hit and the other end of a connection.
#pragma once

#include "renderer/kernels/path/trials.h"
#include "renderer/kernels/scene_view.h"
#include "renderer/kernels/traversal/shadow_ray.h"
#include "renderer/shared/path_state.h"

/// Sets the shadow ray of a path and the radiance that it adds unless it is blocked.
DEVICE void aim_shadow_ray(Path path, float3 origin, float3 target, float3 radiance) {
    if (FEATURE_shadow_origin) {
        set_shadow_origin(path, origin);
    } else {
        set_ray_origin(path, origin);
    }
    set_shadow_vector(path, target - origin);
    set_shadow_radiance(path, radiance);
}

/// Returns whether the shadow ray of a path is blocked.
DEVICE bool is_shadowed(Path path, PRIVATE const SceneView *scene) {
    const float3 origin = FEATURE_shadow_origin ? get_shadow_origin(path) : get_ray_origin(path);
    return is_blocked(scene, origin, get_shadow_vector(path));
}

/// Adds the shadow radiance of a camera path unless its shadow ray is blocked.
DEVICE void add_unblocked(Path path, PRIVATE const SceneView *scene) {
    if (!is_shadowed(path, scene)) {
        set_radiance(path, get_radiance(path) + get_shadow_radiance(path));
        if (FEATURE_light_path_trials) {
            add_light_sample_trials(path);
        }
    }
}
