// SPDX-License-Identifier: MIT
#include "renderer/import/json/values.h"
#include "renderer/scene/scene.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>

namespace rtrays {

namespace {

/// Visitor that sets the alternative to the JSON value. Returns false if the types differ.
struct FromJson {
    const Json &json;

    bool operator()(bool &value) const { return json.is_boolean() && (json.get_to(value), true); }
    bool operator()(double &value) const { return json.is_number() && (json.get_to(value), true); }
    bool operator()(std::string &value) const {
        return json.is_string() && (json.get_to(value), true);
    }
    bool operator()(Eigen::Matrix4d &) const { return false; }  // unused by all tables
    template <int size>
    bool operator()(Eigen::Matrix<double, size, 1> &value) const {
        if (json.is_number()) {
            value.setConstant(json.get<double>());
            return size < 4;
        }
        const bool numbers = json.is_array() && json.size() == size &&
                             std::all_of(json.begin(), json.end(),
                                         [](const Json &item) { return item.is_number(); });
        for (int i = 0; numbers && i < size; ++i) {
            value[i] = json[static_cast<size_t>(i)].get<double>();
        }
        return numbers;
    }
};

bool contains(const std::vector<std::string> &names, const std::string &name) {
    return std::find(names.begin(), names.end(), name) != names.end();
}

[[noreturn]] void unknown_key(const std::string &key, const std::string &type,
                              std::vector<std::string> allowed) {
    std::sort(allowed.begin(), allowed.end());
    throw input_error(fmt::format("unknown key '{}' of the {}; allowed: {}", key, type,
                                  fmt::join(allowed, ", ")));
}

}  // namespace

void set_properties(Scene &scene, const Json &object, const std::string &pointer,
                    const SceneSource &source) {
    const Json set = object.contains("set") ? object.at("set") : Json::object();
    for (const auto &entry : set.items()) {
        const Json &value = entry.value();
        const std::string text = value.is_string() ? value.get<std::string>() : value.dump();
        source.located((Json::json_pointer(pointer + "/set") / entry.key()).to_string(),
                       [&] { scene.set_property(entry.key(), text); });
    }
}

Eigen::Vector3d vector3(const Json &value) {
    return {value[0].get<double>(), value[1].get<double>(), value[2].get<double>()};
}

PropertyValue parameter_value(const Json &value, const Parameter &parameter) {
    PropertyValue result = parameter.initial;
    if (!std::visit(FromJson{value}, result)) {
        throw input_error(fmt::format("{}: {} is not {} ({})", parameter.name, value.dump(),
                                      property_type(parameter.initial), parameter.help));
    }
    return result;
}

ParameterValues parameter_values(const Json &object, const std::string &type,
                                 const ParameterTable &table,
                                 const std::vector<std::string> &others, const SceneSource &source,
                                 const std::string &path) {
    ParameterValues values;
    for (const auto &member : object.items()) {
        const std::string &key = member.key();
        if (key == "type" || contains(others, key)) {
            continue;
        }
        source.located(path + "/" + key, [&] {
            const auto found =
                std::find_if(table.begin(), table.end(),
                             [&](const Parameter &parameter) { return parameter.name == key; });
            if (found == table.end()) {
                std::vector<std::string> allowed = others;
                for (const Parameter &parameter : table) {
                    allowed.push_back(parameter.name);
                }
                unknown_key(key, type, allowed);
            }
            const PropertyValue value = parameter_value(member.value(), *found);
            found->validate(value);
            values.emplace(key, value);
        });
    }
    return values;
}

void check_keys(const Json &object, const std::string &type,
                const std::vector<std::string> &required,
                const std::vector<std::string> &optional) {
    for (const std::string &key : required) {
        if (!object.contains(key)) {
            throw input_error(fmt::format("missing key '{}' of the {}", key, type));
        }
    }
    for (const auto &member : object.items()) {
        const std::string &key = member.key();
        if (key != "type" && !contains(required, key) && !contains(optional, key)) {
            std::vector<std::string> allowed = required;
            allowed.insert(allowed.end(), optional.begin(), optional.end());
            unknown_key(key, type, allowed);
        }
    }
}

}  // namespace rtrays
