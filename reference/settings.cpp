// SPDX-License-Identifier: MIT
#include "reference/settings.h"

#include <fmt/format.h>

#include "renderer/base/error.h"

namespace rtrays {

std::string name_of(Strategies strategies) {
    for (const auto &[name, value] : strategies_names) {
        if (value == strategies) {
            return name;
        }
    }
    throw run_error("unknown strategies");
}

Strategies strategies_from_name(const std::string &name) {
    std::string alternatives;
    for (const auto &[known, value] : strategies_names) {
        if (name == known) {
            return value;
        }
        alternatives += fmt::format("{}{}", alternatives.empty() ? "" : ", ", known);
    }
    throw input_error(
        fmt::format("unknown strategies '{}'; strategies are: {}", name, alternatives));
}

}  // namespace rtrays
