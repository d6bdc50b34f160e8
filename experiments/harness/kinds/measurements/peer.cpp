// SPDX-License-Identifier: MIT
#include "experiments/harness/kinds/measurements/peer.h"

#include <fmt/format.h>

#include <nlohmann/json.hpp>

#include "renderer/base/error.h"
#include "renderer/base/resources.h"
#include "renderer/export/export_scene.h"

namespace rtrays {

namespace fs = std::filesystem;

namespace {

constexpr const char *cycles = "cycles";
/// Frames in one render call of Blender. The overhead of a call is a tenth of a second.
constexpr uint64_t frames_of_cycles = 4;

/// Exports the scene and returns the command that serves it.
std::vector<std::string> served(const Scene &scene, const fs::path &folder,
                                const std::string &kind) {
    const std::string scripts = resource_folder() / "scripts/rtrays/peers";
    const fs::path file = folder / (kind == cycles ? "scene.blender.json" : "scene.xml");
    export_scene(scene, file);
    if (kind == cycles) {
        return {"blender",     "--background", "--factory-startup",           "--python-exit-code",
                "1",           "--python",     scripts + "/cycles_driver.py", "--",
                file.string(), "--serve"};
    }
    return {resource_folder() / "build/peers/bin/python",
            scripts + "/mitsuba_driver.py",
            file.string(),
            "--serve",
            "--variant",
            kind};
}

}  // namespace

Peer::Peer(const Scene &scene, const fs::path &folder, const std::string &kind)
    : process_(served(scene, folder, kind), python_environment()),
      frames_(kind == cycles ? frames_of_cycles : 1) {
    if (const std::string hello = next_record(); !hello.empty()) {
        engine_ = nlohmann::json::parse(hello).at("engine");
    }
}

std::string Peer::name_of(const std::string &kind) {
    return kind == cycles ? "Blender's Cycles" : "Mitsuba 3 " + kind;
}

std::string Peer::next_record() {
    while (const auto line = process_.read_line()) {
        if (line->rfind('{', 0) == 0) {
            return *line;
        }
    }
    return {};
}

Seconds Peer::render(const PeerFrame &frame) {
    // The error of an image is that of its own samples.
    const uint64_t count = frame.image.empty() ? frames_ : 1;
    process_.write(fmt::format("{} {} {} {} {}\n", frame.max_depth, count * frame.spp,
                               frame.seed != 0 ? frame.seed : ++seed_, frame.roulette,
                               frame.image.string()));
    const std::string answer = next_record();
    if (answer.empty()) {
        throw run_error(fmt::format("{} ended before its image was finished, with exit code {}",
                                    engine_, process_.wait()));
    }
    const nlohmann::json seconds = nlohmann::json::parse(answer);
    const auto frames = static_cast<double>(count);
    return {seconds.at("seconds").get<double>() / frames,
            seconds.at("processor_seconds").get<double>() / frames};
}

}  // namespace rtrays
