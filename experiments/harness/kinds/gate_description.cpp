// SPDX-License-Identifier: MIT
// Reads a gate file.
#include <fmt/format.h>

#include <nlohmann/json.hpp>

#include "experiments/harness/kinds/gate.h"

namespace rtrays {

GateDescription read_gate(const DescriptionFile &file) {
    const Json &json = file.json;

    GateDescription gate;
    json.at("name").get_to(gate.name);
    gate.source = file.path.string();
    read_measured_scene(file, json.at("size"), gate);
    gate.baseline = file.resolve(json.at("baseline"));
    const Json &convergence = json.at("convergence"), &planted = json.at("planted_errors");
    if (json.contains("bitwise")) {
        const Json &bitwise = json.at("bitwise");
        gate.bitwise = {bitwise.at("spp"), bitwise.at("split"), bitwise.at("group_sizes"),
                        bitwise.at("stream_capacities")};
        if (gate.bitwise->split >= gate.bitwise->spp) {
            throw input_error(fmt::format("{}: {} must be less than spp {}",
                                          file.location("/bitwise/split"), gate.bitwise->split,
                                          gate.bitwise->spp));
        }
    }
    convergence.at("spp").get_to(gate.convergence.spp);
    require_increasing(gate.convergence.spp, file.location("/convergence/spp"));
    convergence.at("renders").get_to(gate.convergence.renders);
    convergence.at("second_stage_renders").get_to(gate.convergence.second_stage_renders);
    planted.at("spp").get_to(gate.planted.spp);
    for (const Json &error : planted.at("errors")) {
        gate.planted.errors.push_back(read_planted_error(error));
    }
    return gate;
}

}  // namespace rtrays
