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
    if (json.contains("convergence")) {
        const Json &convergence = json.at("convergence");
        gate.convergence = {convergence.at("spp"), convergence.at("renders"),
                            convergence.at("second_stage_renders")};
        require_increasing(gate.convergence->spp, file.location("/convergence/spp"));
        gate.baseline = file.resolve(json.at("baseline"));
    }
    if (json.contains("agreement")) {
        const Json &agreement = json.at("agreement");
        gate.agreement = {agreement.at("spp"), {}};
        for (const Json &error : agreement.value("planted_errors", Json::array())) {
            gate.agreement->planted_errors.push_back(read_planted_error(error));
            if (gate.agreement->planted_errors.back().by_slope && !gate.convergence) {
                throw input_error(
                    fmt::format("{}: errors that the slope finds need \"convergence\"",
                                file.location("/agreement/planted_errors")));
            }
        }
    }
    if (!gate.bitwise && !gate.convergence && !gate.agreement) {
        throw input_error(
            fmt::format("{}: nothing to check; add \"bitwise\", \"convergence\" or \"agreement\"",
                        file.path.string()));
    }
    return gate;
}

}  // namespace rtrays
