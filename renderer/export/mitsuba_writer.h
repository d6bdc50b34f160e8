// SPDX-License-Identifier: MIT
// XML elements that all parts of the Mitsuba exporter write.
#pragma once

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <Eigen/Core>
#include <pugixml.hpp>
#include <string>

namespace rtrays::mitsuba {

/// Appends <TAG name="NAME" value="VALUE"/>. Numbers have as many digits as are needed to read the
/// same value back.
inline void add_property(pugi::xml_node parent, const char *tag, const char *name,
                         const std::string &value) {
    pugi::xml_node node = parent.append_child(tag);
    node.append_attribute("name") = name;
    node.append_attribute("value") = value.c_str();
}

inline void add_number(pugi::xml_node parent, const char *name, double value) {
    add_property(parent, "float", name, fmt::format("{}", value));
}

inline void add_boolean(pugi::xml_node parent, const char *name, bool value) {
    add_property(parent, "boolean", name, value ? "true" : "false");
}

/// Appends an RGB colour. A component that is exactly a float has the shorter digits of a float.
template <typename Vector>
void add_colour(pugi::xml_node parent, const char *name, const Vector &rgb) {
    const auto text = [](double value) {
        const auto rounded = static_cast<float>(value);
        return static_cast<double>(rounded) == value ? fmt::format("{}", rounded)
                                                     : fmt::format("{}", value);
    };
    add_property(parent, "rgb", name,
                 fmt::format("{}, {}, {}", text(rgb[0]), text(rgb[1]), text(rgb[2])));
}

inline pugi::xml_node add_object(pugi::xml_node parent, const char *tag, const std::string &type,
                                 const std::string &id = {}) {
    pugi::xml_node node = parent.append_child(tag);
    node.append_attribute("type") = type.c_str();
    if (!id.empty()) {
        node.append_attribute("id") = id.c_str();
    }
    return node;
}

inline void add_transform(pugi::xml_node parent, const Eigen::Matrix4d &to_world) {
    pugi::xml_node node = parent.append_child("transform");
    node.append_attribute("name") = "to_world";
    const Eigen::Matrix4d by_rows = to_world.transpose();
    node.append_child("matrix").append_attribute("value") =
        fmt::format("{}", fmt::join(by_rows.data(), by_rows.data() + 16, " ")).c_str();
}

}  // namespace rtrays::mitsuba
