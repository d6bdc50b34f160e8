// SPDX-License-Identifier: MIT
#include "renderer/shared/features.h"

#include <array>
#include <utility>

#include "renderer/shared/path_state.h"

namespace rtrays {

namespace {

constexpr std::array<std::pair<Feature, const char *>, static_cast<size_t>(Feature::count)> feature_table = {{
#define ROW(name, text) {Feature::name, #name},
    RTRAYS_FEATURES(ROW)
#undef ROW
}};

/// What a feature's code is built upon.
constexpr std::pair<Feature, Feature> requirements[] = {
    {Feature::scattering, Feature::triangles},       {Feature::lights, Feature::triangles},
    {Feature::lambert, Feature::scattering},         {Feature::roulette, Feature::scattering},
    {Feature::adaptive, Feature::scattering},        {Feature::depth_limit, Feature::scattering},
    {Feature::implicit_light, Feature::lights},      {Feature::implicit_light, Feature::scattering},
    {Feature::explicit_light, Feature::lights},      {Feature::explicit_light, Feature::scattering},
    {Feature::many_lights, Feature::explicit_light}, {Feature::light_triangles, Feature::explicit_light},
    {Feature::area_lights, Feature::lights},
};

}  // namespace

std::vector<std::string> FeatureMask::names() const {
    std::vector<std::string> names;
    for (const auto &[feature, name] : feature_table) {
        if (has(feature)) {
            names.emplace_back(name);
        }
    }
    return names;
}

std::map<std::string, std::string> FeatureMask::defines() const {
    std::map<std::string, std::string> defines;
    for (const auto &[feature, name] : feature_table) {
        defines[std::string("FEATURE_") + name] = has(feature) ? "1" : "0";
    }
    return defines;
}

FeatureMask FeatureMask::closed() const {
    FeatureMask mask = *this;
    for (const auto &[feature, needed] : requirements) {  // ordered: a requirement stands before its dependents
        mask = mask.with(feature, mask.has(feature) && mask.has(needed));
    }
    return mask;
}

std::vector<PathStateField> path_state_fields(FeatureMask mask) {
    std::vector<PathStateField> fields;
    const auto add = [&](bool present, const char *type, const char *name) {
        if (present) {
            fields.push_back({name, std::string(type) == "float3" ? 3u : 1u});
        }
    };
    const bool FEATURE_scattering = mask.has(Feature::scattering);
    const bool FEATURE_implicit_light = mask.has(Feature::implicit_light);
    const bool FEATURE_explicit_light = mask.has(Feature::explicit_light);
#define ROW(feature, type, name) add(feature, #type, #name);
    PATH_STATE_FIELDS(ROW)
#undef ROW
    return fields;
}

uint32_t path_state_words(FeatureMask mask) {
    uint32_t words = 0;
    for (const PathStateField &field : path_state_fields(mask)) {
        words += field.words;
    }
    return words;
}

}  // namespace rtrays
