// SPDX-License-Identifier: MIT
#pragma once

#include <string>
#include <vector>

#include "renderer/scene/cores/parameter_core.h"
#include "renderer/scene/stores.h"

namespace rtrays {

using FovAxis = CameraArrays::FovAxis;

/// "pinhole" and "thin_lens".
const std::vector<CoreType> &camera_types();

/// A perspective camera. Its pose is the transform of its node: it stands at the origin and looks
/// along -z, +y up, +x right. The lengths of a thin lens grow with the scale of its node.
class CameraCore : public ParameterCore {
  public:
    /// Parameters: fov (degrees), fov_axis, and of a thin lens aperture_radius and focus_distance.
    /// Throws `Error` (bad input) as `ParameterCore`, and listing the types when `type` is none of
    /// them.
    CameraCore(std::string name, const std::string &type, const ParameterValues &values);

    CoreRole role() const override { return CoreRole::camera; }
};

}  // namespace rtrays
