// SPDX-License-Identifier: MIT
// Properties: named, typed access to the parameters of cores, for files, command lines and editors
// (thesis 3.2.3).
#pragma once

#include <Eigen/Core>
#include <functional>
#include <string>
#include <utility>
#include <variant>
#include <vector>

namespace rtrays {

using PropertyValue = std::variant<bool, double, Eigen::Vector2d, Eigen::Vector3d, Eigen::Vector4d,
                                   Eigen::Matrix4d, std::string>;

/// Returns the value as text that `Property::set_text` can read.
std::string property_text(const PropertyValue &value);

/// Returns "boolean", "number", "two numbers", ..., "4x4 matrix" or "text".
const char *property_type(const PropertyValue &value);

/// One parameter of a core. Values are set through the core's own setter, which validates them and
/// marks the affected nodes as dirty.
struct Property {
    std::string name;
    std::string help;                  ///< meaning and unit
    std::vector<std::string> choices;  ///< the legal values if the property is a choice
    std::function<PropertyValue()> get;
    std::function<void(const PropertyValue &)> set;  ///< empty if the property is read-only

    /// Returns the type by `property_type`, or the alternatives of a choice.
    std::string type() const;

    /// Returns the value as text that `set_text` can read.
    std::string text() const;

    /// Parses text and sets the value. Accepts `true`; `1.5`; `1,2,3` or `[1, 2, 3]`; a matrix as
    /// 16 numbers, row by row; plain text. One number sets all components of a pair or triple.
    /// Throws `Error` (bad input) if the text has another type, the value is illegal or the
    /// property is read-only.
    void set_text(const std::string &text) const;
};

/// Makes a property from a getter and a setter of type `T`, which must be an alternative of
/// `PropertyValue`.
template <typename T, typename Get, typename Set>
Property make_property(std::string name, std::string help, Get get, Set set) {
    return {std::move(name),
            std::move(help),
            {},
            [get] { return PropertyValue(T(get())); },
            [set](const PropertyValue &value) { set(std::get<T>(value)); }};
}

/// Makes a read-only property.
template <typename T, typename Get>
Property make_property(std::string name, std::string help, Get get) {
    return {std::move(name), std::move(help), {}, [get] { return PropertyValue(T(get())); }, {}};
}

}  // namespace rtrays
