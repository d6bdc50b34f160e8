// SPDX-License-Identifier: MIT
#include <fmt/format.h>

#include <nlohmann/json.hpp>

#include "experiments/gate.h"

namespace rtrays {

GateDescription load_gate(const std::filesystem::path &path) {
    const DescriptionFile file = load_description(path, "gate.schema.json");
    const Json &json = file.json;

    GateDescription gate;
    json.at("name").get_to(gate.name);
    gate.source = path.string();
    read_measured_scene(file, json.at("size"), gate);
    gate.baseline = file.resolve(json.at("baseline"));
    const Json &bitwise = json.at("bitwise"), &convergence = json.at("convergence"),
               &planted = json.at("planted_errors");
    bitwise.at("spp").get_to(gate.bitwise.spp);
    bitwise.at("split").get_to(gate.bitwise.split);
    if (gate.bitwise.split >= gate.bitwise.spp) {
        throw input_error(fmt::format("{}: {} is not below spp {}", file.location("/bitwise/split"),
                                      gate.bitwise.split, gate.bitwise.spp));
    }
    bitwise.at("group_sizes").get_to(gate.bitwise.group_sizes);
    bitwise.at("stream_capacities").get_to(gate.bitwise.stream_capacities);
    convergence.at("spp").get_to(gate.convergence.spp);
    require_increasing(gate.convergence.spp, file.location("/convergence/spp"));
    convergence.at("renders").get_to(gate.convergence.renders);
    convergence.at("second_stage_renders").get_to(gate.convergence.second_stage_renders);
    planted.at("spp").get_to(gate.planted.spp);
    for (const Json &error : planted.at("errors")) {
        gate.planted.errors.push_back({error.at("name"), parse_render_settings(error), error.at("file"),
                                       error.at("search"), error.at("replacement")});
    }
    return gate;
}

}  // namespace rtrays
