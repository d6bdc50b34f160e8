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
/// feature has been required.
class SceneBuffers {
  public:
    /// Creates the buffers that `features` need and that do not exist.
    void require(DeviceContext &device, const CompiledScene &compiled, FeatureMask features);

    /// Copies the items of `parts` that differ from those of `former`, as `recompile` returned
    /// them. A buffer whose size changes is allocated again.
    void update(DeviceContext &device, const CompiledScene &former, const CompiledScene &compiled,
                SceneParts parts);

    /// Returns the arguments of the stage inputs tracing, shading and scene, for stages with these
    /// features. The BVH is read only if the scene has triangles. Without a guide, paths are not
    /// guided.
    StageArguments arguments(const CompiledScene &compiled, const Bvh &bvh, FeatureMask features,
                             const Buffer<uint32_t> &emission_guide = {},
                             const Buffer<uint32_t> &scatter_guide = {}) const;

    /// Calls visit(buffer) for every buffer.
    template <typename Visit>
    void visit(const Visit &visit_buffer) const {
#define ROW(feature, type, name) visit_buffer(name##_);
        OPACITY_BUFFERS(ROW)
        SHAPE_BUFFERS(ROW)
        SHADING_BUFFERS(ROW)
#undef ROW
    }

  private:
#define ROW(feature, type, name) Buffer<type> name##_;
    OPACITY_BUFFERS(ROW)
    SHAPE_BUFFERS(ROW)
    SHADING_BUFFERS(ROW)
#undef ROW
};

}  // namespace rtrays
