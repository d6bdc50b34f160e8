// SPDX-License-Identifier: MIT
// The table of settings, from which parsing, printing, --help and messages derive.
#pragma once

#include <functional>
#include <map>
#include <string>
#include <variant>
#include <vector>

#include "renderer/session/settings.h"

namespace rtrays {

/// A setting whose values have names.
struct ChoiceSetting {
    std::vector<std::string> names;
    /// Returns the name of the value.
    std::function<std::string(const RenderSettings &)> print;
    /// Sets the value of that name. Returns false if there is none.
    std::function<bool(RenderSettings &, const std::string &)> choose;
};

/// A setting that is a whole number. Special values have names.
struct CountSetting {
    uint32_t RenderSettings::*field;
    uint32_t largest;
    std::map<std::string, uint32_t> names = {};
};

/// A setting that is a number between two bounds, which are excluded.
struct NumberSetting {
    float RenderSettings::*field;
    float above;
    float below;
    bool or_zero = false;  ///< 0 is allowed in addition and turns a feature off
};

/// A row of the table.
struct Setting {
    std::string name;
    std::variant<ChoiceSetting, CountSetting, NumberSetting> kind;
    std::string meaning;
};

/// Returns the settings that decide the image, "integrator.*".
const std::vector<Setting> &image_setting_table();

/// Returns the settings that do not decide the image, "device.*".
const std::vector<Setting> &device_setting_table();

/// Returns the value of a setting as text.
std::string value_text(const RenderSettings &settings, const Setting &setting);

/// Sets a setting from text. Throws `Error` (bad usage) that names the alternatives.
void set_value(RenderSettings &settings, const Setting &setting, const std::string &value);

}  // namespace rtrays
