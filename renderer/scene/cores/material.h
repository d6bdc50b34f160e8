// SPDX-License-Identifier: MIT
#pragma once

#include <Eigen/Core>

#include "renderer/scene/core.h"

namespace rtrays {

class MaterialCore;

/// The material of the geometry below: that of the nearest node that has one.
struct MaterialAttribute : AttributeOf<MaterialAttribute> {
    const MaterialCore *material = nullptr;

    void combine(const MaterialAttribute &own) { material = own.material; }
};

/// How a surface scatters light.
class MaterialCore : public Core {
  public:
    explicit MaterialCore(std::string name) : Core(std::move(name)) { attribute_.material = this; }

    CoreRole role() const override { return CoreRole::material; }
    const Attribute *attribute() const override { return &attribute_; }

  private:
    MaterialAttribute attribute_;
};

/// Lambert reflection from both sides: f = reflectance / pi (thesis (3.31)).
class LambertMaterial : public MaterialCore {
  public:
    /// `reflectance`: albedo per channel; throws `Error` (bad input) outside [0, 1].
    LambertMaterial(std::string name, const Eigen::Vector3d &reflectance);

    const char *type_name() const override { return "lambert"; }
    std::vector<Property> properties() override;

    const Eigen::Vector3d &reflectance() const { return reflectance_; }
    void set_reflectance(const Eigen::Vector3d &reflectance);

  private:
    Eigen::Vector3d reflectance_;
};

}  // namespace rtrays
