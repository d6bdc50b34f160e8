// SPDX-License-Identifier: MIT
#pragma once

#include <string>
#include <utility>
#include <vector>

#include "renderer/scene/property.h"

namespace rtrays {

/// Anything with a name, a type and properties: what listings and `set_property` work upon.
class PropertyHolder {
  public:
    explicit PropertyHolder(std::string name) : name_(std::move(name)) {}
    virtual ~PropertyHolder() = default;
    PropertyHolder(const PropertyHolder &) = delete;
    PropertyHolder &operator=(const PropertyHolder &) = delete;

    const std::string &name() const { return name_; }

    /// The type as scene files call it.
    virtual const char *type_name() const = 0;

    virtual std::vector<Property> properties() = 0;

  private:
    std::string name_;
};

}  // namespace rtrays
