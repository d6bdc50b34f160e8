// SPDX-License-Identifier: MIT
#include "renderer/compile/stages.h"

namespace rtrays {

Defines stage_defines(FeatureMask features, const StreamLayout &layout) {
    Defines defines = features.defines();
    defines["STREAM_CHUNK"] = std::to_string(layout.chunk);
    defines["PATH_STATE_INTERLEAVED"] = layout.interleaved ? "1" : "0";
    defines["BVH_LAYOUT"] = std::to_string(static_cast<uint32_t>(layout.bvh));
    return defines;
}

StageSet::StageSet(DeviceContext &device, const std::vector<Stage> &stages, FeatureMask features,
                   const StreamLayout &layout, const SourceOverlays &overlays)
    : device_(&device),
      defines_(stage_defines(features, layout)),
      group_size_(layout.group_size),
      overlays_(overlays) {
    add(stages);
}

void StageSet::add(const std::vector<Stage> &stages) {
    std::map<StageProgram, std::set<Stage>> of_programs;
    for (const Stage stage : stages) {
        if (!has(stage)) {
            of_programs[stage_description(stage).program].insert(stage);
        }
    }
    for (const auto &[program, of_program] : of_programs) {
        build(of_program);
    }
}

void StageSet::build(const std::set<Stage> &of_one_program) {
    std::set<std::string> files;
    for (const Stage stage : of_one_program) {
        files.insert(stage_description(stage).file);
    }
    const Program &program = programs_.emplace_back(
        *device_, std::vector<std::string>(files.begin(), files.end()), defines_, overlays_);
    for (const Stage stage : of_one_program) {
        const StageDescription &description = stage_description(stage);
        const uint32_t size = description.items == StageItems::one ? 1 : group_size_;
        kernels_.try_emplace(stage, program, description.name, size);
        if (!arguments_.empty()) {
            bind(stage, arguments_);
        }
    }
}

void StageSet::bind(const StageArguments &changed) {
    for (const auto &[input, list] : changed) {
        arguments_[input] = list;
    }
    for (const auto &[stage, kernel] : kernels_) {
        bind(stage, changed);
    }
}

void StageSet::bind(Stage stage, const StageArguments &changed) {
    Kernel &kernel = kernels_.at(stage);
    uint32_t index = 0;
    for (const StageInput input : stage_description(stage).inputs) {
        const auto found = changed.find(input);
        if (found != changed.end()) {
            for (uint32_t i = 0; i < found->second.size(); ++i) {
                kernel.bind(index + i, found->second[i]);
            }
        }
        index += static_cast<uint32_t>(arguments_[input].size());
    }
    kernel.require_argument_count(index);
}

void StageSet::enqueue(Stage stage, uint64_t items) {
    kernels_.at(stage).enqueue(items);
}

double StageSet::build_seconds() const {
    double seconds = 0;
    for (const Program &program : programs_) {
        seconds += program.build_seconds();
    }
    return seconds;
}

}  // namespace rtrays
