// SPDX-License-Identifier: MIT
#include "renderer/scene/parameters.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>

#include "renderer/base/error.h"
#include "renderer/scene/cores/texture.h"

namespace rtrays {

namespace {

struct IsWithin {
    const Range &range;

    bool operator()(bool) const { return true; }
    bool operator()(const std::string &) const { return true; }
    bool operator()(double value) const { return range.contains(value); }
    template <typename Derived>
    bool operator()(const Eigen::MatrixBase<Derived> &values) const {
        return values.unaryExpr([this](double v) { return range.contains(v) ? 1.0 : 0.0; })
                   .minCoeff() > 0;
    }
};

}  // namespace

bool Range::contains(double value) const {
    return (with_min ? value >= min : value > min) && (with_max ? value <= max : value < max);
}

std::string Range::text() const {
    return fmt::format("{}{:.7g}, {:.7g}{}", with_min ? '[' : '(', min, max, with_max ? ']' : ')');
}

void Parameter::validate(const PropertyValue &value) const {
    if (value.index() != initial.index()) {
        throw input_error(fmt::format("{}: {} is not a value of type {}", name,
                                      property_text(value), property_type(initial)));
    }
    if (!choices.empty() &&
        std::find(choices.begin(), choices.end(), std::get<std::string>(value)) == choices.end()) {
        throw input_error(fmt::format("{}: '{}' is not one of: {}", name,
                                      std::get<std::string>(value), fmt::join(choices, ", ")));
    }
    if (!std::visit(IsWithin{range}, value)) {
        throw input_error(fmt::format("{}: {} is not within {} ({})", name, property_text(value),
                                      range.text(), help));
    }
}

ParameterSet::ParameterSet(const std::string &type, const ParameterTable &table,
                           const ParameterValues &values, const ParameterTextures &textures)
    : type_(type), table_(&table), values_(table.size()), textures_(textures) {
    for (size_t i = 0; i < table.size(); ++i) {
        if (table[i].need == Parameter::Need::defaulted) {
            values_[i] = table[i].initial;
        }
    }
    for (const auto &[name, value] : values) {
        set(name, value);
    }
    for (size_t i = 0; i < table.size(); ++i) {
        if (table[i].need == Parameter::Need::required && !values_[i]) {
            throw input_error(
                fmt::format("missing key '{}' of the {}: {}", table[i].name, type_, table[i].help));
        }
    }
    for (const auto &named : textures_) {
        if (!table[index(named.first)].textured || named.second == nullptr) {
            throw input_error(fmt::format("{}: this parameter of {} does not support a texture",
                                          named.first, type_));
        }
    }
}

size_t ParameterSet::index(const std::string &name) const {
    const auto found =
        std::find_if(table_->begin(), table_->end(),
                     [&](const Parameter &parameter) { return parameter.name == name; });
    if (found == table_->end()) {
        std::vector<std::string> names;
        for (const Parameter &parameter : *table_) {
            names.push_back(parameter.name);
        }
        throw input_error(fmt::format("{}: unknown parameter '{}'; parameters are: {}", type_, name,
                                      fmt::join(names, ", ")));
    }
    return static_cast<size_t>(found - table_->begin());
}

size_t ParameterSet::choice_index(const std::string &name) const {
    const std::vector<std::string> &choices = (*table_)[index(name)].choices;
    return static_cast<size_t>(std::find(choices.begin(), choices.end(), text(name)) -
                               choices.begin());
}

void ParameterSet::set(const std::string &name, const PropertyValue &value) {
    const size_t i = index(name);
    (*table_)[i].validate(value);
    values_[i] = value;
}

std::shared_ptr<Texture> ParameterSet::texture(const std::string &name) const {
    const auto found = textures_.find(name);
    return found == textures_.end() ? nullptr : found->second;
}

std::vector<Property> ParameterSet::properties(
    const std::function<void(const std::string &, const PropertyValue &)> &setter) const {
    std::vector<Property> all;
    for (size_t i = 0; i < table_->size(); ++i) {
        if (values_[i]) {
            const Parameter &parameter = (*table_)[i];
            all.push_back({parameter.name, parameter.help, parameter.choices,
                           [this, i] { return values_[i].value(); },
                           [setter, &name = parameter.name](const PropertyValue &value) {
                               setter(name, value);
                           }});
        }
    }
    for (const auto &[name, texture] : textures_) {
        all.push_back(make_property<std::string>(
            name + "_texture", "texture that scales the value over the surface",
            [texture_name = texture->name()] { return texture_name; }));
    }
    return all;
}

}  // namespace rtrays
