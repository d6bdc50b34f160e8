// SPDX-License-Identifier: MIT
#pragma once

#include <string>
#include <vector>

#include "renderer/scene/core.h"
#include "renderer/scene/stores.h"

namespace rtrays {

using FovAxis = CameraArrays::FovAxis;

/// Names of the axes as in scene files, in the order of `FovAxis`.
const std::vector<std::string> &fov_axis_names();

/// Throws `Error` (bad input) listing the names when `name` is none of them.
FovAxis parse_fov_axis(const std::string &name);

/// A perspective camera with a point aperture. Its pose is the transform of its node: it stands at the origin
/// and looks along -z, +y up, +x right.
class PinholeCamera : public Core {
  public:
    /// `fov_degrees`: full angle of view along `axis`; throws `Error` (bad input) outside (0, 180).
    PinholeCamera(std::string name, double fov_degrees, FovAxis axis);

    CoreRole role() const override { return CoreRole::camera; }
    const char *type_name() const override { return "pinhole"; }
    std::vector<Property> properties() override;

    double fov_degrees() const { return fov_degrees_; }
    FovAxis fov_axis() const { return fov_axis_; }
    void set_fov_degrees(double fov_degrees);
    void set_fov_axis(FovAxis axis);

  private:
    double fov_degrees_;
    FovAxis fov_axis_;
};

}  // namespace rtrays
