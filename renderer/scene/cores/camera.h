// SPDX-License-Identifier: MIT
// Camera cores: pinholes, thin lenses and orthographic cameras.
#pragma once

#include <string>
#include <vector>

#include "renderer/scene/cores/parameter_core.h"
#include "renderer/scene/stores.h"

namespace rtrays {

using FovAxis = CameraArrays::FovAxis;

/// Returns the types "pinhole", "thin_lens" and "orthographic".
const std::vector<CoreType> &camera_types();

/// A camera. The transform of its node is its pose: it is at the origin and looks along -z, with +y
/// up and +x right. Its lengths scale with its node.
class CameraCore : public ParameterCore {
  public:
    /// Parameters: fov (degrees) and fov_axis; a thin lens also has aperture_radius and
    /// focus_distance. An orthographic camera has size and size_axis instead. Throws `Error` (bad
    /// input) like `ParameterCore`, and for an unknown type, listing the types.
    CameraCore(std::string name, const std::string &type, const ParameterValues &values);

    CoreRole role() const override { return CoreRole::camera; }
};

}  // namespace rtrays
