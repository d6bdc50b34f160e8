// SPDX-License-Identifier: MIT
#pragma once

#include <Eigen/Core>

#include "renderer/scene/core.h"

namespace rtrays {

/// Constant radiance leaving the front of the geometry of the same node.
class DiffuseAreaLight : public Core {
  public:
    /// `radiance`: W / (sr m^2) per channel; throws `Error` (bad input) when negative, or beyond float.
    DiffuseAreaLight(std::string name, const Eigen::Vector3d &radiance);

    CoreRole role() const override { return CoreRole::light; }
    const char *type_name() const override { return "diffuse_area"; }
    std::vector<Property> properties() override;

    const Eigen::Vector3d &radiance() const { return radiance_; }
    void set_radiance(const Eigen::Vector3d &radiance);

  private:
    Eigen::Vector3d radiance_;
};

}  // namespace rtrays
