// SPDX-License-Identifier: MIT
// Which camera paths are guided where they scatter (kernels/bsdf/guided_scattering.h).
#pragma once

#include "renderer/kernels/bsdf/guided_scattering.h"
#include "renderer/kernels/geometry/surface_hit.h"
#include "renderer/kernels/scene_view.h"
#include "renderer/shared/integrator_settings.h"
#include "renderer/shared/path_state.h"

/// Returns the table by which a camera path scatters at its hit, where `ng` is the geometric normal
/// on its side; NO_GUIDE_TABLE if it is not guided.
DEVICE uint scatter_table(Path path, PRIVATE const SceneView *scene, IntegratorSettings settings,
                          SurfaceHit hit, float3 ng) {
    if (!FEATURE_guided_scattering || FEATURE_from_light || !scene->scatter_guide ||
        (settings.strategies & STRATEGY_LIGHT) == 0u || get_log_running_ratio(path) > -INFINITY ||
        (scene->materials[hit.material].flags & MATERIAL_GUIDED) == 0u) {
        return NO_GUIDE_TABLE;
    }
    return guide_cell(scene->scatter_guide, hit.point.position, guide_side(ng));
}
