// SPDX-License-Identifier: MIT
// Cores that are defined by a type and its table of parameters.
#pragma once

#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "renderer/base/error.h"
#include "renderer/scene/core.h"
#include "renderer/scene/parameters.h"

namespace rtrays {

/// A row of a table of types: the name in scene files and the parameters.
struct CoreType {
    std::string name;
    ParameterTable parameters;
    /// Checks conditions that the ranges of single parameters cannot express; throws `Error` (bad
    /// input). May be empty.
    std::function<void(const ParameterSet &)> check;
};

/// Returns the type of that name. Throws `Error` (bad input) listing the types if it is unknown.
/// `what` is "light", "shape", ...
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

/// A core that consists of a type and the values of its parameters.
class ParameterCore : public Core {
  public:
    const char *type_name() const override { return type_->name.c_str(); }
    std::vector<Property> properties() override;

    const ParameterSet &parameters() const { return parameters_; }

    /// Sets one parameter. Throws `Error` (bad input), and changes nothing, if the value is illegal
    /// by itself or in combination with the others.
    void set(const std::string &name, const PropertyValue &value);

  protected:
    /// Throws `Error` (bad input) naming the parameter that is unknown, missing or illegal.
    ParameterCore(std::string name, std::shared_ptr<const CoreType> type,
                  const ParameterValues &values, const ParameterTextures &textures = {});

    const CoreType &type() const { return *type_; }

    /// Returns the records that a change of that parameter makes outdated.
    virtual Dirty outdated_by(const std::string &) const { return Dirty::object; }

  private:
    std::shared_ptr<const CoreType> type_;
    ParameterSet parameters_;
};

/// Returns a pointer, without ownership, to a type of a table that lives as long as the program.
template <typename Type>
std::shared_ptr<const Type> static_type(const Type &type) {
    return {std::shared_ptr<const Type>(), &type};
}

}  // namespace rtrays
