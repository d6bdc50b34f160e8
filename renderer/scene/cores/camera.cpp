// SPDX-License-Identifier: MIT
#include "renderer/scene/cores/camera.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <utility>

#include "renderer/base/error.h"

namespace rtrays {

const std::vector<std::string> &fov_axis_names() {
    static const std::vector<std::string> names = {"x", "y", "smaller", "larger"};
    return names;
}

FovAxis parse_fov_axis(const std::string &name) {
    const std::vector<std::string> &names = fov_axis_names();
    const auto found = std::find(names.begin(), names.end(), name);
    if (found == names.end()) {
        throw input_error(fmt::format("fov_axis: '{}' is not one of: {}", name, fmt::join(names, ", ")));
    }
    return static_cast<FovAxis>(found - names.begin());
}

PinholeCamera::PinholeCamera(std::string name, double fov_degrees, FovAxis axis)
    : Core(std::move(name)), fov_axis_(axis) {
    set_fov_degrees(fov_degrees);
}

void PinholeCamera::set_fov_degrees(double fov_degrees) {
    if (!(fov_degrees > 0 && fov_degrees < 180)) {
        throw input_error(fmt::format("fov: {} is not between 0 and 180 degrees", fov_degrees));
    }
    fov_degrees_ = fov_degrees;
    changed();
}

void PinholeCamera::set_fov_axis(FovAxis axis) {
    fov_axis_ = axis;
    changed();
}

std::vector<Property> PinholeCamera::properties() {
    Property axis = make_property<std::string>(
        "fov_axis", "image axis of the angle of view",
        [this] { return fov_axis_names()[static_cast<size_t>(fov_axis_)]; },
        [this](const std::string &value) { set_fov_axis(parse_fov_axis(value)); });
    axis.choices = fov_axis_names();
    return {make_property<double>(
                "fov", "full angle of view along fov_axis, degrees", [this] { return fov_degrees_; },
                [this](double value) { set_fov_degrees(value); }),
            axis};
}

}  // namespace rtrays
