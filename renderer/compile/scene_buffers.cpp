// SPDX-License-Identifier: MIT
#include "renderer/compile/scene_buffers.h"

namespace rtrays {

// The tables name features FEATURE_x, as in kernels. Here these names are variables.
#define FEATURE_VARIABLE(name, text) \
    [[maybe_unused]] const bool FEATURE_##name = features.has(Feature::name);

SceneBuffers::SceneBuffers(DeviceContext &device, const CompiledScene &compiled,
                           FeatureMask features)
    : features_(features),
      lighting_(compiled.lighting),
      shape_count_(static_cast<uint32_t>(compiled.shapes.size())) {
    RTRAYS_FEATURES(FEATURE_VARIABLE)
#define ROW(feature, type, name)                              \
    if (feature) {                                            \
        name##_ = Buffer<type>(device, #name, compiled.name); \
    }
    BOUNDS_BUFFERS(ROW)
    SURFACE_BUFFERS(ROW)
    MATERIAL_BUFFERS(ROW)
    LIGHT_BUFFERS(ROW)
#undef ROW
}

StageArguments SceneBuffers::arguments(const Bvh &bvh) const {
    const FeatureMask features = features_;
    RTRAYS_FEATURES(FEATURE_VARIABLE)
    StageArguments arguments;
#define ROW(feature, type, name)     \
    if (feature) {                   \
        list->emplace_back(name##_); \
    }
    std::vector<KernelArgument> *list = &arguments[StageInput::geometry];
    bvh.visit([&](const auto &bvh_nodes_, const auto &bvh_triangles_) { GEOMETRY_BUFFERS(ROW) });
    arguments[StageInput::traversal] = *list;
    ROW(FEATURE_shapes, ShapeRecord, shapes)
    for (const StageInput input : {StageInput::geometry, StageInput::traversal}) {
        list = &arguments[input];
        BOUNDS_BUFFERS(ROW)
        if (FEATURE_shapes) {
            list->emplace_back(shape_count_);
        }
    }
    list = &arguments[StageInput::surfaces];
    SURFACE_BUFFERS(ROW)
    list = &arguments[StageInput::materials];
    MATERIAL_BUFFERS(ROW)
    list = &arguments[StageInput::lights];
    LIGHT_BUFFERS(ROW)
    list->emplace_back(lighting_);
#undef ROW
    return arguments;
}

}  // namespace rtrays
