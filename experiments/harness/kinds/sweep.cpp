// SPDX-License-Identifier: MIT
#include "experiments/harness/kinds/sweep.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <nlohmann/json.hpp>

#include "experiments/harness/core/expression.h"
#include "experiments/harness/kinds/unreferenced.h"
#include "renderer/base/error.h"
#include "renderer/import/load_scene.h"

namespace rtrays {

namespace {

/// One scene whose properties are functions of a value x.
struct Sweep {
    std::filesystem::path scene;
    /// Formulas of x by the address of their property.
    std::vector<std::pair<std::string, std::vector<std::string>>> properties;
};

Sweep read_sweep(const DescriptionFile &file, const Json &json) {
    Sweep sweep{file.resolve(json.at("scene")), {}};
    for (const auto &[address, formulas] : json.at("properties").items()) {
        sweep.properties.emplace_back(address, formulas.is_string()
                                                   ? std::vector<std::string>{formulas}
                                                   : formulas.get<std::vector<std::string>>());
    }
    return sweep;
}

/// Loads the scene of a sweep and sets its properties for a value.
Scene scene_at(const Sweep &sweep, double value) {
    Scene scene = load_scene(sweep.scene.string());
    const Names names = [&](const std::string &name) {
        if (name != "x") {
            throw input_error(fmt::format("unknown name '{}'; the value of a sweep is x", name));
        }
        return value;
    };
    for (const auto &[address, formulas] : sweep.properties) {
        std::vector<std::string> numbers;
        for (const std::string &formula : formulas) {
            numbers.push_back(fmt::format("{:.9g}", evaluate(formula, names)));
        }
        scene.set_property(address, fmt::format("{}", fmt::join(numbers, ",")));
    }
    scene.update(0);
    return scene;
}

}  // namespace

std::unique_ptr<Experiment> make_sweep(const DescriptionFile &file, const RunOptions &options) {
    const Json &values = file.profile(options.profile).at("values");
    std::vector<UnreferencedCase> cases;
    std::string plan;
    for (const Json &json : file.json.at("sweeps")) {
        const std::string name = json.at("name");
        if (!values.contains(name)) {
            throw input_error(fmt::format("{}: the sweep '{}' has no values",
                                          file.location("/profiles/" + options.profile + "/values"),
                                          name));
        }
        const auto own = values.at(name).get<std::vector<double>>();
        plan += fmt::format("  {:24} {}\n", name, fmt::join(own, ", "));
        for (size_t i = 0; i < own.size(); ++i) {
            cases.push_back({fmt::format("{}.{}.json", name, i),
                             {{"sweep", name}, {"value", own[i]}},
                             [sweep = read_sweep(file, json), value = own[i]] {
                                 return scene_at(sweep, value);
                             }});
        }
    }
    return make_unreferenced(file, options.profile, {"name", "title", "thesis", "claim", "sweeps"},
                             std::move(cases), plan);
}

}  // namespace rtrays
