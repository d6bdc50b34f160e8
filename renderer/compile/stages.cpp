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
    for (const Stage stage : stages) {
        const StageDescription &description = stage_description(stage);
        const auto program =
            programs_.try_emplace(description.file, *device_, description.file, defines_, overlays_)
                .first;
        const uint32_t size = description.items == StageItems::one ? 1 : group_size_;
        const bool is_new =
            kernels_.try_emplace(stage, program->second, description.name, size).second;
        if (is_new && !arguments_.empty()) {
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
    for (const auto &[file, program] : programs_) {
        seconds += program.build_seconds();
    }
    return seconds;
}

}  // namespace rtrays
