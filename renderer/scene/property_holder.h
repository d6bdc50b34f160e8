// SPDX-License-Identifier: MIT
// The base of cores and textures: objects with properties.
#pragma once

#include <string>
#include <utility>
#include <vector>

#include "renderer/scene/property.h"

namespace rtrays {

/// An object with a name, a type and properties, for listings and `set_property`.
class PropertyHolder {
  public:
    explicit PropertyHolder(std::string name) : name_(std::move(name)) {}
    virtual ~PropertyHolder() = default;
    PropertyHolder(const PropertyHolder &) = delete;
    PropertyHolder &operator=(const PropertyHolder &) = delete;

    const std::string &name() const { return name_; }

    /// Returns the name of the type in scene files.
    virtual const char *type_name() const = 0;

    virtual std::vector<Property> properties() = 0;

  private:
    std::string name_;
};

}  // namespace rtrays
