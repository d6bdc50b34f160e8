// SPDX-License-Identifier: MIT
#include "experiments/harness/kinds/stability_cases.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <set>

#include "experiments/harness/core/expression.h"
#include "renderer/base/error.h"
#include "renderer/import/load_scene.h"

namespace rtrays {

namespace {

/// Parameters of one case: the values of the sweep, and the formulas of "where", which may refer to
/// each other.
class Parameters {
  public:
    Parameters(std::map<std::string, double> swept, const Json &formulas)
        : swept_(std::move(swept)), formulas_(formulas) {}

    /// Returns a number unchanged, and the value of a text as a formula.
    double value(const Json &json) const {
        return json.is_string() ? evaluate(json.get<std::string>(),
                                           [this](const std::string &name) { return named(name); })
                                : json.get<double>();
    }

    bool is_swept(const std::string &name) const { return swept_.count(name) > 0; }

    /// Returns the text of a property: a boolean, a number or formula, or a list of them. The text
    /// of `{"text": ...}` is returned unchanged.
    std::string text(const Json &json) const {
        if (json.is_object()) {
            return json.at("text").get<std::string>();
        }
        if (json.is_boolean()) {
            return json.dump();
        }
        std::vector<std::string> numbers;
        for (const Json &item : json.is_array() ? json : Json::array({json})) {
            numbers.push_back(fmt::format("{:.17g}", value(item)));
        }
        return fmt::format("{}", fmt::join(numbers, ","));
    }

  private:
    double named(const std::string &name) const {
        if (const auto found = swept_.find(name); found != swept_.end()) {
            return found->second;
        }
        if (!formulas_.contains(name) || depth_ > 16) {
            throw input_error(fmt::format("parameter '{}' {}", name,
                                          depth_ > 16
                                              ? "is defined by itself in \"where\""
                                              : "is unknown; define it in \"each\" or \"where\""));
        }
        ++depth_;
        const double result = value(formulas_.at(name));
        --depth_;
        return result;
    }

    std::map<std::string, double> swept_;
    const Json &formulas_;
    mutable int depth_ = 0;
};

/// Returns all combinations of the values of "each". The last name varies fastest.
std::vector<std::map<std::string, double>> combinations(const Json &each) {
    std::vector<std::map<std::string, double>> all = {{}};
    for (const auto &[name, values] : each.items()) {
        std::vector<std::map<std::string, double>> longer;
        for (const auto &one : all) {
            for (const Json &value : values) {
                longer.push_back(one);
                longer.back()[name] = value.get<double>();
            }
        }
        all = std::move(longer);
    }
    return all;
}

SceneVariant read_variant(const DescriptionFile &file, const Json &json, const std::string &scene,
                          const Parameters &parameters) {
    const std::string path = scene + ".json";
    SceneVariant variant{file.resolve(file.json.at("folder")) / path, {}};
    const Json set = json.value("set", Json::object());
    for (const auto &[address, value] : set.items()) {
        variant.properties.emplace_back(address, parameters.text(value));
    }
    return variant;
}

void read_expectation(const DescriptionFile &file, const Json &json, const Parameters &parameters,
                      StabilityCase &result) {
    if (json.contains("reference_spp")) {
        result.expectation = Expectation::reference;
        json.at("reference_spp").get_to(result.reference_spp);
    } else if (json.contains("like")) {
        const Json &like = json.at("like");
        result.expectation = Expectation::like;
        result.other = read_variant(
            file, like, like.value("scene", json.at("scene").get<std::string>()), parameters);
        result.channels = like.value("channels", std::array<size_t, 3>{0, 1, 2});
    } else if (json.contains("expected")) {
        const Json &expected = json.at("expected");
        for (size_t c = 0; c < 3; ++c) {
            result.expected[c] = parameters.value(expected.is_array() ? expected.at(c) : expected);
            if (!std::isfinite(result.expected[c]) || result.expected[c] < 0) {
                throw input_error(fmt::format(
                    "\"expected\" must be finite and not negative, got {}", result.expected[c]));
            }
        }
    } else {
        result.expectation = Expectation::saturates;
    }
}

StabilityCase read_case(const DescriptionFile &file, const Json &json,
                        std::map<std::string, double> swept, const Json &profile) {
    const Json &defaults = file.json.at("defaults");
    const auto setting = [&](const char *key) { return json.value(key, defaults.at(key)); };
    StabilityCase result;
    json.at("name").get_to(result.group);
    result.name = result.group;
    for (const auto &[name, value] : swept) {
        result.stiffness = name == json.value("stiffness", "") ? value : result.stiffness;
        result.name += fmt::format(" {}={}", name, value);
    }
    const Json where = json.value("where", Json::object());
    const Parameters parameters(std::move(swept), where);
    json.at("title").get_to(result.title);
    result.scene = read_variant(file, json, json.at("scene"), parameters);
    read_expectation(file, json, parameters, result);
    result.bound = parameters.value(setting("bound"));
    result.reason = json.value("reason", "");
    const double factor = profile.at("samples");
    result.within = parameters.value(setting("within")) / std::sqrt(factor);
    result.spp = static_cast<uint64_t>(std::max(factor * setting("spp").get<double>(), 32.0));
    result.reference_spp =
        static_cast<uint64_t>(factor * static_cast<double>(result.reference_spp));
    result.first_sample = json.value("first_sample", uint64_t{0});
    result.unseen = json.value("unseen", result.unseen);
    Json chosen = json.value("settings", Json::object());
    for (Json &value : chosen) {
        if (value.is_string() && parameters.is_swept(value.get<std::string>())) {
            value = parameters.text(value);
        }
    }
    for (const Json &choice : setting("algorithms")) {
        const std::string algorithm = choice.is_string() ? choice : choice.at("algorithm");
        const Json own = choice.is_string() ? Json::object() : choice.at("settings");
        if (result.unseen.count(algorithm) > 0) {
            continue;
        }
        Json all = chosen;
        std::string name = algorithm;
        for (const auto &[key, value] : own.items()) {
            all[key] = value;
            name += fmt::format(" {}", value.is_string() ? value.get<std::string>() : value.dump());
        }
        RenderSettings settings =
            parse_render_settings({{"algorithm", algorithm}, {"settings", all}});
        settings.width = settings.height = setting("size");
        settings.variance = false;
        apply_setting(settings, "device.features=" + profile.at("features").get<std::string>());
        // The stream is no larger than a batch: empty queue entries cost time in every round. The
        // image does not depend on the capacity.
        const double paths =
            static_cast<double>(result.spp) / 32 * settings.width * settings.height;
        settings.stream_capacity = static_cast<uint32_t>(std::clamp(paths, 256.0, 16384.0));
        result.runs.push_back({name, settings});
    }
    return result;
}

}  // namespace

Scene SceneVariant::load() const {
    Scene scene = load_scene(path.string());
    for (const auto &[address, text] : properties) {
        scene.set_property(address, text);
    }
    if (!properties.empty()) {
        scene.update(0);
    }
    return scene;
}

StabilitySuite read_stability(const DescriptionFile &file, const std::string &profile) {
    const Json &chosen = file.profile(profile);
    StabilitySuite suite{file.json.at("name"),
                         profile,
                         file.json.at("defaults").at("bound"),
                         file.json.value("survey", false),
                         {}};
    std::set<std::string> names;
    for (const Json &json : file.json.at("cases")) {
        const std::string name = json.at("name");
        const std::vector<std::string> profiles =
            json.value("profiles", std::vector<std::string>{"quick", "full"});
        if (std::find(profiles.begin(), profiles.end(), profile) == profiles.end()) {
            continue;
        }
        try {
            for (const auto &swept : combinations(json.value("each", Json::object()))) {
                suite.cases.push_back(read_case(file, json, swept, chosen));
                if (!names.insert(suite.cases.back().name).second) {
                    throw input_error("two cases have this name; rename one");
                }
            }
        } catch (const Error &error) {
            throw Error(error.exit_code(),
                        fmt::format("{}: case '{}': {}", file.path.string(), name, error.what()));
        }
    }
    if (suite.cases.empty()) {
        throw input_error(
            fmt::format("{}: no case has the profile '{}'", file.path.string(), profile));
    }
    return suite;
}

}  // namespace rtrays
