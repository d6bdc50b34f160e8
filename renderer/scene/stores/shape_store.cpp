// SPDX-License-Identifier: MIT
#include "renderer/scene/stores/shape_store.h"

#include <fmt/format.h>

#include "renderer/base/error.h"
#include "renderer/scene/cores/material.h"
#include "renderer/scene/cores/shape.h"
#include "renderer/scene/cores/transform.h"
#include "renderer/scene/cores/visibility.h"
#include "renderer/scene/stores/geometry_record.h"
#include "renderer/scene/stores/light_store.h"

namespace rtrays {

bool ShapeStore::holds(const Core &core) const {
    return dynamic_cast<const ShapeCore *>(&core) != nullptr;
}

bool ShapeStore::concerns(const Node &node) const {
    return node.core_of<ShapeCore>(CoreRole::geometry) != nullptr;
}

bool ShapeStore::wants_record(const Node &, const AttributeSet &attributes) const {
    return attributes.get<VisibilityAttribute>().visible;
}

void ShapeStore::append(const Node &node) {
    arrays.name.push_back(node.name());
    arrays.kind.emplace_back();
    arrays.world_from_object.push_back(Eigen::Matrix4d::Identity());
    arrays.material.push_back(no_index);
    arrays.light.push_back(no_index);
    arrays.flare.push_back(0);
    arrays.julia_constant.push_back(Eigen::Vector4d::Zero());
    arrays.julia_slice.push_back(0);
    arrays.julia_iterations.push_back(0);
}

void ShapeStore::write(uint32_t slot, const Node &node, const AttributeSet &attributes) {
    const auto &shape = static_cast<const ShapeCore &>(*node.core(CoreRole::geometry));
    arrays.material[slot] = material_slot(materials_, attributes, shape.type_name(), node.name());
    arrays.light[slot] = lights_.area_light_slot(node, attributes);
    arrays.kind[slot] = shape.kind();
    const MaterialCore &material = *attributes.get<MaterialAttribute>().material;
    if (shape.kind() == ShapeArrays::Kind::julia && !material.is_opaque()) {
        throw input_error(
            fmt::format("{} '{}': material '{}' has an opacity, but a Julia set must be opaque",
                        shape.type_name(), node.name(), material.name()));
    }
    if (material.normal_map_texture() != nullptr) {
        throw input_error(fmt::format(
            "{} '{}': material '{}' has a normal or bump map, but only triangles support these; "
            "use a mesh",
            shape.type_name(), node.name(), material.name()));
    }

    Eigen::Matrix4d world =
        attributes.get<TransformAttribute>().world_from_object * shape.object_from_canonical();
    world.topRightCorner<3, 1>() -= origin;
    // Size and position must both be floats, because the renderer inverts the transform.
    const Eigen::Vector3f sizes =
        world.topLeftCorner<3, 3>().colwise().stableNorm().transpose().cast<float>();
    if (!world.cast<float>().allFinite() || !sizes.allFinite() ||
        sizes.minCoeff() < std::numeric_limits<float>::min()) {
        throw input_error(fmt::format("{} '{}' is beyond the range of float in world space",
                                      shape.type_name(), node.name()));
    }
    arrays.world_from_object[slot] = world;

    const ParameterSet &p = shape.parameters();
    const bool is_julia = shape.kind() == ShapeArrays::Kind::julia;
    arrays.flare[slot] = shape.kind() == ShapeArrays::Kind::hyperboloid ? p.number("flare") : 0;
    arrays.julia_constant[slot] = Eigen::Vector4d::Zero();
    if (is_julia) {
        arrays.julia_constant[slot] = p.get<Eigen::Vector4d>("constant");
    }
    arrays.julia_slice[slot] = is_julia ? p.number("slice") : 0;
    arrays.julia_iterations[slot] = is_julia ? static_cast<uint32_t>(p.number("iterations")) : 0;
}

void ShapeStore::keep(const std::vector<uint32_t> &slots) {
    keep_elements(arrays.name, slots);
    keep_elements(arrays.kind, slots);
    keep_elements(arrays.world_from_object, slots);
    keep_elements(arrays.material, slots);
    keep_elements(arrays.light, slots);
    keep_elements(arrays.flare, slots);
    keep_elements(arrays.julia_constant, slots);
    keep_elements(arrays.julia_slice, slots);
    keep_elements(arrays.julia_iterations, slots);
}

}  // namespace rtrays
