// SPDX-License-Identifier: MIT
#pragma once

#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "renderer/base/error.h"
#include "renderer/scene/core.h"
#include "renderer/scene/parameters.h"

namespace rtrays {

/// One row of a table of types: what scene files call it and what it is made from.
struct CoreType {
    std::string name;
    ParameterTable parameters;
    /// What the ranges of single parameters cannot say; throws `Error` (bad input). May be empty.
    std::function<void(const ParameterSet &)> check;
};

/// The type of that name; throws `Error` (bad input) listing those there are. `what` is "light",
/// "shape", ...
template <typename Type>
const Type &find_type(const std::vector<Type> &types, const std::string &name, const char *what) {
    std::string names;
    for (const Type &type : types) {
        if (type.name == name) {
            return type;
        }
        names += (names.empty() ? "" : ", ") + type.name;
    }
    throw input_error(std::string(what) + " type '" + name + "' is not one of: " + names);
}

/// A core that is a type and values of its parameters.
class ParameterCore : public Core {
  public:
    const char *type_name() const override { return type_->name.c_str(); }
    std::vector<Property> properties() override;

    const ParameterSet &parameters() const { return parameters_; }

    /// Throws `Error` (bad input), and changes nothing, when the value is illegal by itself or
    /// beside the others.
    void set(const std::string &name, const PropertyValue &value);

  protected:
    /// Throws `Error` (bad input) naming the parameter that is unknown, missing or illegal.
    ParameterCore(std::string name, std::shared_ptr<const CoreType> type,
                  const ParameterValues &values, const ParameterTextures &textures = {});

    const CoreType &type() const { return *type_; }

    /// What a change of that parameter outdates.
    virtual Dirty outdated_by(const std::string &) const { return Dirty::object; }

  private:
    std::shared_ptr<const CoreType> type_;
    ParameterSet parameters_;
};

/// A type of a table that lives as long as the program.
template <typename Type>
std::shared_ptr<const Type> static_type(const Type &type) {
    return {std::shared_ptr<const Type>(), &type};
}

}  // namespace rtrays
