// SPDX-License-Identifier: MIT
// Parameters that a table declares: one row serves construction, validation, properties, scene
// files and messages.
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

/// The legal values of a number, or of each of several.
struct Range {
    double min = -std::numeric_limits<double>::max();
    double max = std::numeric_limits<double>::max();
    bool with_min = true;
    bool with_max = true;

    bool contains(double value) const;  ///< false for NaN
    std::string text() const;           ///< "[0, 1)"
};

namespace ranges {
inline constexpr double largest_float = std::numeric_limits<float>::max();
inline constexpr Range unit{0, 1, true, true};
inline constexpr Range positive{0, largest_float, false, true};
inline constexpr Range not_negative{0, largest_float, true, true};
inline constexpr Range any{-largest_float, largest_float, true, true};
}  // namespace ranges

/// One row of a table.
struct Parameter {
    enum class Need {
        required,  ///< without a value the object cannot be
        defaulted,
        optional,  ///< may have none
    };

    std::string name;
    std::string help;       ///< meaning and unit
    PropertyValue initial;  ///< its alternative is the type; the default where there is one
    Need need = Need::defaulted;
    Range range = ranges::any;
    std::vector<std::string> choices{};  ///< the legal values of a choice, else empty
    bool textured = false;               ///< "NAME_texture" may scale it over the surface

    /// Throws `Error` (bad input) naming the parameter, its range or choices and its meaning.
    void validate(const PropertyValue &value) const;
};

using ParameterTable = std::vector<Parameter>;
using ParameterValues = std::map<std::string, PropertyValue>;
using ParameterTextures =
    std::map<std::string, std::shared_ptr<Texture>>;  ///< by name of the parameter

/// The values of a table's parameters, each within its range.
class ParameterSet {
  public:
    /// `type` stands in messages. Throws `Error` (bad input) for an unknown name, a value out of
    /// range or a missing one. `table` must outlive the set.
    ParameterSet(const std::string &type, const ParameterTable &table,
                 const ParameterValues &values, const ParameterTextures &textures = {});

    /// Throws `Error` (bad input) as above.
    void set(const std::string &name, const PropertyValue &value);

    bool has(const std::string &name) const { return at(name).has_value(); }

    /// The value of a parameter that has one, of its type `T`.
    template <typename T>
    const T &get(const std::string &name) const {
        return std::get<T>(at(name).value());
    }
    double number(const std::string &name) const { return get<double>(name); }
    const Eigen::Vector3d &vector3(const std::string &name) const {
        return get<Eigen::Vector3d>(name);
    }
    const std::string &text(const std::string &name) const { return get<std::string>(name); }

    /// The value of a choice as its place in the list, which is that of the enumerator.
    template <typename Enum>
    Enum choice(const std::string &name) const {
        return static_cast<Enum>(choice_index(name));
    }

    /// nullptr where there is none.
    std::shared_ptr<Texture> texture(const std::string &name) const;
    const ParameterTextures &textures() const { return textures_; }

    /// The parameters that have a value as properties that end in `setter(name, value)`. They refer
    /// to this set.
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
