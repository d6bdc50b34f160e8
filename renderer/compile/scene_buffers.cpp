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
    SHAPE_BUFFERS(ROW)
    SHADING_BUFFERS(ROW)
#undef ROW
}

// The lists are in the order of the parameters in kernels/scene_view.h.
StageArguments SceneBuffers::arguments(const Bvh &bvh) const {
    const FeatureMask features = features_;
    RTRAYS_FEATURES(FEATURE_VARIABLE)
    using Arguments = std::vector<KernelArgument>;
    Arguments hierarchy, shapes, shading;
#define ROW(list, feature, name)    \
    if (feature) {                  \
        list.emplace_back(name##_); \
    }
#define HIERARCHY_ROW(feature, type, name) ROW(hierarchy, feature, name)
#define SHAPE_ROW(feature, type, name) ROW(shapes, feature, name)
#define SHADING_ROW(feature, type, name) ROW(shading, feature, name)
    bvh.visit([&](const auto &bvh_nodes_, const auto &bvh_triangles_) {
        HIERARCHY_BUFFERS(HIERARCHY_ROW)
    });
    SHAPE_BUFFERS(SHAPE_ROW)
    SHADING_BUFFERS(SHADING_ROW)
#undef SHADING_ROW
#undef SHAPE_ROW
#undef HIERARCHY_ROW
#undef ROW
    const auto joined = [](std::initializer_list<Arguments> lists) {
        Arguments all;
        for (const Arguments &list : lists) {
            all.insert(all.end(), list.begin(), list.end());
        }
        return all;
    };
    const Arguments count = {shape_count_};
    const Arguments values = {shape_count_, lighting_};
    return {{StageInput::tracing, joined({hierarchy, shapes, count})},
            {StageInput::shading, joined({shapes, shading, values})},
            {StageInput::scene, joined({hierarchy, shapes, shading, values})}};
}

}  // namespace rtrays
