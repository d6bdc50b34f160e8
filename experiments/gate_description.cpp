// SPDX-License-Identifier: MIT
#include <fmt/format.h>

#include "embedded/experiment_schemas.h"
#include "experiments/gate.h"
#include "renderer/base/files.h"

namespace rtrays {

namespace {

void check_gate(const GateDescription &gate) {
    if (gate.bitwise.split >= gate.bitwise.spp) {
        throw input_error(fmt::format("{}: /bitwise/split: {} is not below spp {}", gate.source,
                                      gate.bitwise.split, gate.bitwise.spp));
    }
    const auto &spp = gate.convergence.spp;
    for (size_t i = 1; i < spp.size(); ++i) {
        if (spp[i] <= spp[i - 1]) {
            throw input_error(fmt::format("{}: /convergence/spp must increase; {} follows {}", gate.source,
                                          spp[i], spp[i - 1]));
        }
    }
}

}  // namespace

GateDescription load_gate(const std::filesystem::path &path) {
    const std::string source = path.string(), text = read_file(path);
    const Json json = parse_json(text, source);
    validate_json(json, std::string(embedded::experiment_schemas().text("gate.schema.json")), source, text);
    const auto resolve = [&](const Json &relative) {
        return (path.parent_path() / relative.get<std::string>()).lexically_normal();
    };

    GateDescription gate;
    json.at("name").get_to(gate.name);
    gate.source = source;
    gate.scene = resolve(json.at("scene"));
    gate.reference_folder = resolve(json.at("reference").at("folder"));
    json.at("reference").at("engine").get_to(gate.reference_engine);
    gate.baseline = resolve(json.at("baseline"));
    json.at("size").at(0).get_to(gate.width);
    json.at("size").at(1).get_to(gate.height);
    for (const Json &curve : json.at("curves")) {
        gate.curves.push_back({parse_render_settings(curve)});
    }
    const Json &bitwise = json.at("bitwise"), &convergence = json.at("convergence"),
               &planted = json.at("planted_errors");
    bitwise.at("spp").get_to(gate.bitwise.spp);
    bitwise.at("split").get_to(gate.bitwise.split);
    bitwise.at("group_sizes").get_to(gate.bitwise.group_sizes);
    bitwise.at("stream_capacities").get_to(gate.bitwise.stream_capacities);
    convergence.at("spp").get_to(gate.convergence.spp);
    convergence.at("renders").get_to(gate.convergence.renders);
    convergence.at("second_stage_renders").get_to(gate.convergence.second_stage_renders);
    planted.at("spp").get_to(gate.planted.spp);
    for (const Json &error : planted.at("errors")) {
        gate.planted.errors.push_back({error.at("name"), parse_render_settings(error), error.at("file"),
                                       error.at("search"), error.at("replacement")});
    }
    check_gate(gate);
    return gate;
}

}  // namespace rtrays
