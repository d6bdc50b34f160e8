// SPDX-License-Identifier: MIT
// Parameters declared by tables. One row defines a parameter for construction, validation,
// properties, scene files and messages.
#pragma once

#include <functional>
#include <limits>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "renderer/scene/property.h"

namespace rtrays {

class Texture;

/// The legal values of a number, or of each component of a vector or matrix.
struct Range {
    double min = -std::numeric_limits<double>::max();
    double max = std::numeric_limits<double>::max();
    bool with_min = true;
    bool with_max = true;

    bool contains(double value) const;  ///< returns false for NaN
    std::string text() const;           ///< returns text such as "[0, 1)"
};

namespace ranges {
inline constexpr double largest_float = std::numeric_limits<float>::max();
inline constexpr Range unit{0, 1, true, true};
inline constexpr Range positive{0, largest_float, false, true};
inline constexpr Range not_negative{0, largest_float, true, true};
inline constexpr Range any{-largest_float, largest_float, true, true};
}  // namespace ranges

/// A row of a table: one parameter.
struct Parameter {
    enum class Need {
        required,   ///< a value must be given
        defaulted,  ///< the default applies if no value is given
        optional,   ///< the parameter may have no value
    };

    std::string name;
    std::string help;       ///< meaning and unit
    PropertyValue initial;  ///< its alternative is the type; the default value if defaulted
    Need need = Need::defaulted;
    Range range = ranges::any;
    std::vector<std::string> choices{};  ///< the legal values if the parameter is a choice
    bool textured = false;               ///< a texture "NAME_texture" may scale it over the surface

    /// Throws `Error` (bad input) for an illegal value, naming the parameter, its range or choices
    /// and its meaning.
    void validate(const PropertyValue &value) const;
};

using ParameterTable = std::vector<Parameter>;
using ParameterValues = std::map<std::string, PropertyValue>;
/// Textures by the name of the parameter that they scale.
using ParameterTextures = std::map<std::string, std::shared_ptr<Texture>>;

/// Values of the parameters of a table, each within its range.
class ParameterSet {
  public:
    /// `type` is the name of the type in messages. Throws `Error` (bad input) for an unknown name,
    /// a value out of range or a missing value. `table` must outlive the set.
    ParameterSet(const std::string &type, const ParameterTable &table,
                 const ParameterValues &values, const ParameterTextures &textures = {});

    /// Sets one value. Throws `Error` (bad input) for an unknown name or an illegal value.
    void set(const std::string &name, const PropertyValue &value);

    bool has(const std::string &name) const { return at(name).has_value(); }

    /// Returns the value of a parameter that has one, as its type `T`.
    template <typename T>
    const T &get(const std::string &name) const {
        return std::get<T>(at(name).value());
    }
    double number(const std::string &name) const { return get<double>(name); }
    const Eigen::Vector3d &vector3(const std::string &name) const {
        return get<Eigen::Vector3d>(name);
    }
    const std::string &text(const std::string &name) const { return get<std::string>(name); }

    /// Returns the value of a choice. Its index in the list is the value of the enumerator.
    template <typename Enum>
    Enum choice(const std::string &name) const {
        return static_cast<Enum>(choice_index(name));
    }

    /// Returns the texture of a parameter, or nullptr.
    std::shared_ptr<Texture> texture(const std::string &name) const;
    const ParameterTextures &textures() const { return textures_; }

    /// Returns properties for the parameters that have a value. Setting one calls `setter(name,
    /// value)`. The properties refer to this set.
    std::vector<Property> properties(
        const std::function<void(const std::string &, const PropertyValue &)> &setter) const;

  private:
    size_t index(const std::string &name) const;
    size_t choice_index(const std::string &name) const;
    const std::optional<PropertyValue> &at(const std::string &name) const {
        return values_[index(name)];
    }

    std::string type_;
    const ParameterTable *table_;
    std::vector<std::optional<PropertyValue>> values_;
    ParameterTextures textures_;
};

}  // namespace rtrays
