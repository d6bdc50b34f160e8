// SPDX-License-Identifier: MIT
// Settings as text: assignments, documents and help.
#include "renderer/session/settings.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <nlohmann/json.hpp>
#include <sstream>

#include "renderer/base/error.h"
#include "renderer/base/suggestion.h"
#include "renderer/session/setting_table.h"

namespace rtrays {

namespace {

const std::vector<Setting> &all_settings() {
    static const std::vector<Setting> all = [] {
        std::vector<Setting> list = image_setting_table();
        const std::vector<Setting> &device = device_setting_table();
        list.insert(list.end(), device.begin(), device.end());
        return list;
    }();
    return all;
}

/// Breaks a help text into indented lines of at most 100 columns.
std::string wrapped(const std::string &text) {
    constexpr size_t width = 100;
    const std::string indent(6, ' ');
    std::istringstream words(text);
    std::string lines, line = indent, word;
    while (words >> word) {
        if (line.size() > indent.size() && line.size() + 1 + word.size() > width) {
            lines += line + "\n";
            line = indent;
        }
        line += (line.size() > indent.size() ? " " : "") + word;
    }
    return lines + line + "\n";
}

}  // namespace

void apply_setting(RenderSettings &settings, const std::string &assignment) {
    const size_t equals = assignment.find('=');
    const bool is_assignment = equals != std::string::npos;
    const std::string name = assignment.substr(0, equals);
    std::vector<std::string> names;
    for (const Setting &setting : all_settings()) {
        if (is_assignment && setting.name == name) {
            return set_value(settings, setting, assignment.substr(equals + 1));
        }
        names.push_back(setting.name);
    }
    throw input_error(fmt::format("{} '{}'; {}settings are: {}",
                                  is_assignment ? "unknown setting" : "expected NAME=VALUE, got",
                                  name, suggestion(name, names), fmt::join(names, ", ")));
}

nlohmann::json image_settings(const RenderSettings &requested) {
    const RenderSettings settings = with_fixed_choices(requested);
    nlohmann::json document = {{"algorithm", settings.algorithm->name}};
    for (const Setting &setting : image_setting_table()) {
        document[setting.name] = value_text(settings, setting);
    }
    for (const auto &[path, text] : settings.source_overlays) {
        document["overlays"][path] = text;
    }
    return document;
}

std::vector<std::string> changed_settings(const RenderSettings &settings) {
    const RenderSettings defaults;
    std::vector<std::string> changed;
    for (const Setting &setting : image_setting_table()) {
        const std::string value = value_text(settings, setting);
        if (value != value_text(defaults, setting)) {
            changed.push_back(setting.name + "=" + value);
        }
    }
    return changed;
}

std::string describe_settings(const RenderSettings &defaults) {
    std::string description;
    for (const Setting &setting : all_settings()) {
        const auto *named = std::get_if<ChoiceSetting>(&setting.kind);
        description += fmt::format(
            "  {} = {}{}\n{}", setting.name, value_text(defaults, setting),
            named == nullptr ? "" : fmt::format("  ({})", fmt::join(named->names, " | ")),
            wrapped(setting.meaning));
    }
    return description;
}

}  // namespace rtrays
