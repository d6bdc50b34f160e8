// SPDX-License-Identifier: MIT
// The compiled scene in device memory, as buffers and kernel arguments.
#pragma once

#include "renderer/bvh/bvh.h"
#include "renderer/compile/compile_scene.h"
#include "renderer/compile/stages.h"
#include "renderer/device/buffer.h"
#include "renderer/shared/scene_buffers.h"

namespace rtrays {

/// A compiled scene in device memory: one buffer for each row of shared/scene_buffers.h whose
/// feature is on.
class SceneBuffers {
  public:
    SceneBuffers() = default;
    SceneBuffers(DeviceContext &device, const CompiledScene &compiled, FeatureMask features);

    /// Returns the arguments of the stage inputs tracing, shading and scene. The BVH is read only
    /// if the scene has triangles.
    StageArguments arguments(const Bvh &bvh) const;

    /// Calls visit(buffer) for every buffer.
    template <typename Visit>
    void visit(const Visit &visit_buffer) const {
#define ROW(feature, type, name) visit_buffer(name##_);
        SHAPE_BUFFERS(ROW)
        SHADING_BUFFERS(ROW)
#undef ROW
    }

  private:
    FeatureMask features_;
    LightingRecord lighting_{};
    uint32_t shape_count_ = 0;
#define ROW(feature, type, name) Buffer<type> name##_;
    SHAPE_BUFFERS(ROW)
    SHADING_BUFFERS(ROW)
#undef ROW
};

}  // namespace rtrays
