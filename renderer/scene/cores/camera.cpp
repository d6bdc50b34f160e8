// SPDX-License-Identifier: MIT
#include "renderer/scene/cores/camera.h"

#include <utility>

namespace rtrays {

const std::vector<CoreType> &camera_types() {
    using Need = Parameter::Need;
    static const ParameterTable pinhole = {
        {"fov",
         "full angle of view along fov_axis, degrees",
         0.0,
         Need::required,
         {0, 180, false, false}},
        {"fov_axis",
         "image axis of the angle of view",
         std::string("x"),
         Need::defaulted,
         ranges::any,
         {"x", "y", "smaller", "larger"}},
    };
    static const ParameterTable thin_lens = [] {
        ParameterTable table = pinhole;
        table.push_back({"aperture_radius", "radius of the lens, scene units; 0 for a pinhole", 0.0,
                         Need::required, ranges::not_negative});
        table.push_back({"focus_distance",
                         "distance of the plane in focus from the lens, scene units", 0.0,
                         Need::required, ranges::positive});
        return table;
    }();
    static const ParameterTable orthographic = {
        {"size", "extent of the view along size_axis, scene units", 0.0, Need::required,
         ranges::positive},
        {"size_axis",
         "image axis of the extent",
         std::string("x"),
         Need::defaulted,
         ranges::any,
         {"x", "y", "smaller", "larger"}},
    };
    static const std::vector<CoreType> types = {
        {"pinhole", pinhole, {}}, {"thin_lens", thin_lens, {}}, {"orthographic", orthographic, {}}};
    return types;
}

CameraCore::CameraCore(std::string name, const std::string &type, const ParameterValues &values)
    : ParameterCore(std::move(name), static_type(find_type(camera_types(), type, "camera")),
                    values) {}

}  // namespace rtrays
