// SPDX-License-Identifier: MIT
// Camera cores: pinholes and thin lenses.
#pragma once

#include <string>
#include <vector>

#include "renderer/scene/cores/parameter_core.h"
#include "renderer/scene/stores.h"

namespace rtrays {

using FovAxis = CameraArrays::FovAxis;

/// Returns the types "pinhole" and "thin_lens".
const std::vector<CoreType> &camera_types();

/// A perspective camera. The transform of its node is its pose: it is at the origin and looks along
/// -z, with +y up and +x right. The lengths of a thin lens scale with its node.
class CameraCore : public ParameterCore {
  public:
    /// Parameters: fov (degrees) and fov_axis; a thin lens also has aperture_radius and
    /// focus_distance. Throws `Error` (bad input) like `ParameterCore`, and for an unknown type,
    /// listing the types.
    CameraCore(std::string name, const std::string &type, const ParameterValues &values);

    CoreRole role() const override { return CoreRole::camera; }
};

}  // namespace rtrays
