// SPDX-License-Identifier: MIT
#include "renderer/scene/stores/camera_store.h"

#include <fmt/format.h>

#include "renderer/base/angles.h"
#include "renderer/scene/cores/camera.h"
#include "renderer/scene/cores/transform.h"
#include "renderer/scene/stores/pose.h"

namespace rtrays {

void CameraStore::append(const Node &node) {
    arrays.name.push_back(node.name());
    arrays.world_from_camera.emplace_back();
    arrays.fov.emplace_back();
    arrays.fov_axis.emplace_back();
    arrays.view_size.push_back(0);
    arrays.aperture_radius.emplace_back();
    arrays.focus_distance.push_back(1);
}

void CameraStore::write(uint32_t slot, const Node &node, const AttributeSet &attributes) {
    const ParameterSet &camera =
        static_cast<const CameraCore &>(*node.core(CoreRole::camera)).parameters();
    Pose pose = pose_of(attributes.get<TransformAttribute>().world_from_object,
                        fmt::format("camera '{}'", node.name()));
    pose.rigid.topRightCorner<3, 1>() -= origin;
    arrays.world_from_camera[slot] = pose.rigid;
    const std::string type = node.core(CoreRole::camera)->type_name();
    const bool parallel = type == "orthographic", lens = type == "thin_lens";
    arrays.fov[slot] = parallel ? 0 : camera.number("fov") * degree;
    arrays.fov_axis[slot] = camera.choice<FovAxis>(parallel ? "size_axis" : "fov_axis");
    arrays.view_size[slot] = parallel ? pose.scale * camera.number("size") : 0;
    arrays.aperture_radius[slot] = lens ? pose.scale * camera.number("aperture_radius") : 0;
    arrays.focus_distance[slot] = lens ? pose.scale * camera.number("focus_distance") : 1;
}

void CameraStore::keep(const std::vector<uint32_t> &slots) {
    keep_elements(arrays.name, slots);
    keep_elements(arrays.world_from_camera, slots);
    keep_elements(arrays.fov, slots);
    keep_elements(arrays.fov_axis, slots);
    keep_elements(arrays.view_size, slots);
    keep_elements(arrays.aperture_radius, slots);
    keep_elements(arrays.focus_distance, slots);
}

}  // namespace rtrays
