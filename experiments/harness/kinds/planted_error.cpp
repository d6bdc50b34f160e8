// SPDX-License-Identifier: MIT
#include "experiments/harness/kinds/planted_error.h"

#include <fmt/format.h>

#include <nlohmann/json.hpp>

#include "renderer/base/error.h"
#include "renderer/device/source.h"

namespace rtrays {

PlantedError read_planted_error(const Json &json) {
    return {json.at("name"),        parse_render_settings(json),
            json.at("file"),        json.at("search"),
            json.at("replacement"), json.value("caught_by", "agreement") == "slope"};
}

std::string plant(const PlantedError &error, const std::string &text) {
    const size_t at = text.find(error.search);
    if (at == std::string::npos || text.find(error.search, at + 1) != std::string::npos) {
        throw input_error(fmt::format("planted error '{}': {} must contain exactly once: {}",
                                      error.name, error.file, error.search));
    }
    std::string planted = text;
    planted.replace(at, error.search.size(), error.replacement);
    if (planted == text) {
        throw input_error(fmt::format("planted error '{}' changes nothing", error.name));
    }
    return planted;
}

void require_plantable(const std::vector<PlantedError> &errors) {
    for (const auto &error : errors) {
        plant(error, device_source(error.file));
    }
}

RenderSettings planted_settings(const PlantedError &error) {
    RenderSettings settings = error.settings;
    settings.source_overlays[error.file] = plant(error, device_source(error.file));
    return settings;
}

}  // namespace rtrays
