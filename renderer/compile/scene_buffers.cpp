// SPDX-License-Identifier: MIT
#include "renderer/compile/scene_buffers.h"

#include <cstring>

namespace rtrays {

namespace {

// The tables name features FEATURE_x, as in kernels. Here these names are variables.
#define FEATURE_VARIABLE(name, text) \
    [[maybe_unused]] const bool FEATURE_##name = features.has(Feature::name);

/// The part of the compiled scene to which each buffer belongs.
namespace part_of {
constexpr auto surface_triangles = &SceneParts::triangles;
constexpr auto triangle_normals = &SceneParts::triangles;
constexpr auto triangle_uvs = &SceneParts::triangles;
constexpr auto triangle_colours = &SceneParts::triangles;
constexpr auto shapes = &SceneParts::shapes;
constexpr auto shape_bounds = &SceneParts::shapes;
constexpr auto materials = &SceneParts::materials;
constexpr auto components = &SceneParts::materials;
constexpr auto mixes = &SceneParts::materials;
constexpr auto coat_transmittances = &SceneParts::materials;
constexpr auto textures = &SceneParts::textures;
constexpr auto texels = &SceneParts::textures;
constexpr auto normal_maps = &SceneParts::materials;
constexpr auto triangle_masks = &SceneParts::opacity;
constexpr auto masked_triangles = &SceneParts::opacity;
constexpr auto opacities = &SceneParts::opacity;
constexpr auto opacity_texels = &SceneParts::opacity;
constexpr auto lights = &SceneParts::lights;
constexpr auto emitter_triangles = &SceneParts::lights;
constexpr auto environment_texels = &SceneParts::environment;
constexpr auto environment_ends = &SceneParts::environment;
}  // namespace part_of

template <typename T>
bool exists(const Buffer<T> &buffer) {
    return !buffer.name().empty();
}

/// Copies the range of items that differ, or all if the sizes do.
template <typename T>
void write_changes(DeviceContext &device, const std::vector<T> &former, const std::vector<T> &now,
                   Buffer<T> &buffer) {
    if (now.size() != buffer.size()) {
        buffer = Buffer<T>(device, buffer.name(), now);
        return;
    }
    size_t first = 0, end = now.size();
    if (former.size() == now.size()) {
        const auto same = [&](size_t i) {
            return std::memcmp(&former[i], &now[i], sizeof(T)) == 0;
        };
        while (first < end && same(first)) {
            ++first;
        }
        while (first < end && same(end - 1)) {
            --end;
        }
    }
    buffer.write(first, now.data() + first, end - first);
}

}  // namespace

void SceneBuffers::require(DeviceContext &device, const CompiledScene &compiled,
                           FeatureMask features) {
    RTRAYS_FEATURES(FEATURE_VARIABLE)
#define ROW(feature, type, name)                              \
    if (feature && !exists(name##_)) {                        \
        name##_ = Buffer<type>(device, #name, compiled.name); \
    }
    OPACITY_BUFFERS(ROW)
    SHAPE_BUFFERS(ROW)
    SHADING_BUFFERS(ROW)
#undef ROW
}

void SceneBuffers::update(DeviceContext &device, const CompiledScene &former,
                          const CompiledScene &compiled, SceneParts parts) {
#define ROW(feature, type, name)                                    \
    if (parts.*part_of::name && exists(name##_)) {                  \
        write_changes(device, former.name, compiled.name, name##_); \
    }
    OPACITY_BUFFERS(ROW)
    SHAPE_BUFFERS(ROW)
    SHADING_BUFFERS(ROW)
#undef ROW
}

// The lists are in the order of the parameters in kernels/scene_view.h.
StageArguments SceneBuffers::arguments(const CompiledScene &compiled, const Bvh &bvh,
                                       FeatureMask features,
                                       const Buffer<uint32_t> &emission_guide_,
                                       const Buffer<uint32_t> &scatter_guide_) const {
    RTRAYS_FEATURES(FEATURE_VARIABLE)
    using Arguments = std::vector<KernelArgument>;
    Arguments hierarchy, opacity, shapes, shading;
#define ROW(list, feature, name)    \
    if (feature) {                  \
        list.emplace_back(name##_); \
    }
#define HIERARCHY_ROW(feature, type, name) ROW(hierarchy, feature, name)
#define OPACITY_ROW(feature, type, name) ROW(opacity, feature, name)
#define SHAPE_ROW(feature, type, name) ROW(shapes, feature, name)
#define SHADING_ROW(feature, type, name) ROW(shading, feature, name)
    bvh.visit([&](const auto &bvh_nodes_, const auto &bvh_triangles_) {
        HIERARCHY_BUFFERS(HIERARCHY_ROW)
    });
    OPACITY_BUFFERS(OPACITY_ROW)
    SHAPE_BUFFERS(SHAPE_ROW)
    SHADING_BUFFERS(SHADING_ROW)
    GUIDE_BUFFERS(SHADING_ROW)
#undef SHADING_ROW
#undef SHAPE_ROW
#undef OPACITY_ROW
#undef HIERARCHY_ROW
#undef ROW
    const auto joined = [](std::initializer_list<Arguments> lists) {
        Arguments all;
        for (const Arguments &list : lists) {
            all.insert(all.end(), list.begin(), list.end());
        }
        return all;
    };
    const auto shape_count = static_cast<uint32_t>(compiled.shapes.size());
    const Arguments count = {shape_count};
    const Arguments values = {shape_count, compiled.lighting};
    return {{StageInput::tracing, joined({hierarchy, opacity, shapes, count})},
            {StageInput::shading, joined({shapes, shading, values})},
            {StageInput::scene, joined({hierarchy, opacity, shapes, shading, values})}};
}

}  // namespace rtrays
