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

/// The value as `Property::set_text` reads it.
std::string property_text(const PropertyValue &value);

/// "boolean", "number", "two numbers", ..., "4x4 matrix" or "text".
const char *property_type(const PropertyValue &value);

/// One parameter of one core. Values go through the core's own setter, which validates them and
/// marks the nodes concerned as dirty.
struct Property {
    std::string name;
    std::string help;                  ///< meaning and unit
    std::vector<std::string> choices;  ///< the legal values of a choice, else empty
    std::function<PropertyValue()> get;
    std::function<void(const PropertyValue &)> set;  ///< empty when the property can only be read

    /// As `property_type`; a choice lists its alternatives.
    std::string type() const;

    /// The value as `set_text` reads it.
    std::string text() const;

    /// Parses and sets: `true`; `1.5`; `1,2,3` or `[1, 2, 3]`; 16 numbers, row by row; plain text;
    /// one number where two are equal. Throws `Error` (bad input) when the text is of another type,
    /// the value is illegal or the property read-only.
    void set_text(const std::string &text) const;
};

/// A property by getter and setter of the value's own type `T`, one of the alternatives of
/// `PropertyValue`.
template <typename T, typename Get, typename Set>
Property make_property(std::string name, std::string help, Get get, Set set) {
    return {std::move(name),
            std::move(help),
            {},
            [get] { return PropertyValue(T(get())); },
            [set](const PropertyValue &value) { set(std::get<T>(value)); }};
}

/// A property that can only be read.
template <typename T, typename Get>
Property make_property(std::string name, std::string help, Get get) {
    return {std::move(name), std::move(help), {}, [get] { return PropertyValue(T(get())); }, {}};
}

}  // namespace rtrays
