// SPDX-License-Identifier: MIT
// The view through which device functions read a compiled scene, for tests on the host.
#pragma once

#include "renderer/compile/compile_scene.h"
#include "renderer/kernels/scene_view.h"

namespace rtrays {

/// Returns the view of a scene, which must outlive it. The hierarchy is not part of it.
inline SceneView view_of(const CompiledScene &scene) {
    SceneView view{};
#define X(feature, type, name) view.name = scene.name.data();
    SHAPE_BUFFERS(X)
    SHADING_BUFFERS(X)
#undef X
    view.shape_count = static_cast<uint32_t>(scene.shapes.size());
    view.lighting = scene.lighting;
    return view;
}

}  // namespace rtrays
