// SPDX-License-Identifier: MIT
// The table of all stages, and their compilation, binding and launch.
#include "renderer/compile/stages.h"

#include <fmt/format.h>

#include <algorithm>

namespace rtrays {

const std::vector<StageDescription> &stage_table() {
    using In = StageInput;
    using Items = StageDescription::Items;
    static const std::vector<StageDescription> table = {
        {"reset_streams",
         "kernels/advance_streams.cl",
         {In::first_work, In::streams},
         Items::slots},
        {"generate_camera_rays",
         "kernels/generate_camera_rays.cl",
         {In::camera, In::settings, In::first_sample, In::work, In::live_pixels, In::streams},
         Items::entries},
        {"generate_light_paths",
         "kernels/generate_light_paths.cl",
         {In::surfaces, In::lights, In::settings, In::first_sample, In::work, In::vertices,
          In::streams},
         Items::entries},
        {"begin_round", "kernels/advance_streams.cl", {In::counters}, Items::one},
        {"intersect_nearest",
         "kernels/intersect_nearest.cl",
         {In::geometry, In::streams},
         Items::entries},
        {"evaluate_emission",
         "kernels/evaluate_emission.cl",
         {In::surfaces, In::lights, In::settings, In::streams},
         Items::entries},
        {"sample_light",
         "kernels/sample_light.cl",
         {In::surfaces, In::materials, In::lights, In::settings, In::first_sample, In::chosen,
          In::streams},
         Items::entries},
        {"intersect_any", "kernels/intersect_any.cl", {In::geometry, In::streams}, Items::entries},
        {"connect_emitter",
         "kernels/connect_emitter.cl",
         {In::surfaces, In::lights, In::camera, In::settings, In::first_sample, In::streams},
         Items::entries},
        {"connect_camera",
         "kernels/connect_camera.cl",
         {In::surfaces, In::materials, In::lights, In::camera, In::settings, In::first_sample,
          In::streams},
         Items::entries},
        {"store_vertex",
         "kernels/store_vertex.cl",
         {In::surfaces, In::materials, In::settings, In::vertices, In::streams},
         Items::entries},
        {"connect_vertices",
         "kernels/connect_vertices.cl",
         {In::surfaces, In::materials, In::settings, In::chosen, In::vertices, In::streams},
         Items::entries},
        {"splat_unblocked",
         "kernels/splat_unblocked.cl",
         {In::geometry, In::film, In::streams},
         Items::entries},
        {"extend_path",
         "kernels/extend_path.cl",
         {In::surfaces, In::materials, In::film, In::half_film, In::settings, In::first_sample,
          In::streams},
         Items::entries},
        {"follow_branches",
         "kernels/follow_branches.cl",
         {In::surfaces, In::materials, In::film, In::settings, In::branches, In::streams},
         Items::entries},
        {"end_paths", "kernels/end_paths.cl", {In::film, In::streams}, Items::entries},
        {"trace_paths",
         "kernels/trace_paths.cl",
         {In::traversal, In::surfaces, In::materials, In::lights, In::camera, In::film,
          In::half_film, In::settings, In::first_sample, In::first_work, In::work, In::live_pixels,
          In::counters},
         Items::paths},
        {"finish_paths",
         "kernels/finish_paths.cl",
         {In::traversal, In::surfaces, In::materials, In::lights, In::camera, In::film,
          In::half_film, In::settings, In::first_sample, In::streams},
         Items::few_paths},
        {"end_shadow_rays", "kernels/advance_streams.cl", {In::counters}, Items::one},
        {"count_nearest_rays",
         "kernels/count_rays.cl",
         {In::ray_counts, In::streams},
         Items::entries},
        {"count_shadow_rays",
         "kernels/count_rays.cl",
         {In::ray_counts, In::streams},
         Items::entries},
        {"end_round", "kernels/advance_streams.cl", {In::counters}, Items::one},
        {"carry_film", "kernels/carry_film.cl", {In::film, In::film_sums}, Items::film_sums},
    };
    return table;
}

const StageDescription &stage_description(const std::string &name) {
    const auto &table = stage_table();
    const auto found = std::find_if(table.begin(), table.end(),
                                    [&](const StageDescription &s) { return s.name == name; });
    if (found == table.end()) {
        throw run_error(fmt::format("unknown stage '{}'", name));
    }
    return *found;
}

Defines stage_defines(FeatureMask features, const StreamLayout &layout) {
    Defines defines = features.defines();
    defines["STREAM_CHUNK"] = std::to_string(layout.chunk);
    defines["PATH_STATE_INTERLEAVED"] = layout.interleaved ? "1" : "0";
    defines["BVH_LAYOUT"] = std::to_string(static_cast<uint32_t>(layout.bvh));
    return defines;
}

StageSet::StageSet(DeviceContext &device, const std::vector<std::string> &names,
                   FeatureMask features, const StreamLayout &layout, const SourceOverlays &overlays)
    : device_(&device),
      defines_(stage_defines(features, layout)),
      group_size_(layout.group_size),
      overlays_(overlays) {
    add(names);
}

void StageSet::add(const std::vector<std::string> &names) {
    for (const std::string &name : names) {
        const StageDescription &description = stage_description(name);
        const auto program =
            programs_.try_emplace(description.file, *device_, description.file, defines_, overlays_)
                .first;
        const uint32_t size = description.items == StageDescription::Items::one ? 1 : group_size_;
        const auto [stage, is_new] =
            stages_.try_emplace(name, Stage{&description, Kernel(program->second, name, size)});
        if (is_new && !arguments_.empty()) {
            bind(stage->second, arguments_);
        }
    }
}

void StageSet::bind(const StageArguments &changed) {
    for (const auto &[input, list] : changed) {
        arguments_[input] = list;
    }
    for (auto &[name, stage] : stages_) {
        bind(stage, changed);
    }
}

void StageSet::bind(Stage &stage, const StageArguments &changed) {
    uint32_t index = 0;
    for (const StageInput input : stage.description->inputs) {
        const auto found = changed.find(input);
        if (found != changed.end()) {
            for (uint32_t i = 0; i < found->second.size(); ++i) {
                stage.kernel.bind(index + i, found->second[i]);
            }
        }
        index += static_cast<uint32_t>(arguments_[input].size());
    }
    stage.kernel.require_argument_count(index);
}

void StageSet::enqueue(const std::string &name, uint64_t items) {
    stages_.at(name).kernel.enqueue(items);
}

double StageSet::build_seconds() const {
    double seconds = 0;
    for (const auto &[file, program] : programs_) {
        seconds += program.build_seconds();
    }
    return seconds;
}

}  // namespace rtrays
