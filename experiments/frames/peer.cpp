// SPDX-License-Identifier: MIT
#include "experiments/frames/peer.h"

#include <fmt/format.h>

#include <nlohmann/json.hpp>

#include "renderer/base/error.h"

namespace rtrays {

MitsubaPeer::MitsubaPeer(const std::filesystem::path &scene, const std::string &variant)
    : process_({RTRAYS_SOURCE "/build/peers/bin/python", RTRAYS_SCRIPTS "/mitsuba_driver.py", scene.string(), "--serve",
                "--variant", variant}) {
    if (const auto hello = process_.read_line()) {
        engine_ = nlohmann::json::parse(*hello).at("engine");
    }
}

Seconds MitsubaPeer::render(uint32_t max_depth, uint64_t spp) {
    process_.write(fmt::format("{} {} {}\n", max_depth, spp, ++seed_));
    const auto answer = process_.read_line();
    if (!answer) {
        throw run_error(fmt::format("{} ended before its image was done", engine_));
    }
    const nlohmann::json seconds = nlohmann::json::parse(*answer);
    return {seconds.at("seconds"), seconds.at("processor_seconds")};
}

}  // namespace rtrays
