// SPDX-License-Identifier: MIT
// The document that `--stats` writes.
#include <nlohmann/json.hpp>

#include "renderer/base/commit.h"
#include "renderer/session/state.h"
#include "renderer/shared/path_state.h"

namespace rtrays {

nlohmann::json RenderSession::report() const {
    const State &s = *state_;
    const RenderStats numbers = stats();
    const StreamCounters counters = s.counters.read().front();
    nlohmann::json report = {
        {"schema_version", 1},
        {"commit", commit()},
        {"dirty", built_from_changed_sources()},
        {"device",
         {{"name", s.device.info().name},
          {"driver", s.device.info().driver},
          {"platform", s.device.info().platform_name}}},
        {"settings", image_settings(s.settings)},
        {"features", s.features.names()},
        {"pipeline", name_in(pipelines, s.settings.pipeline)},
        {"stream",
         {{"group_size", s.layout.group_size},
          {"capacity", s.layout.capacity},
          {"chunk", s.layout.chunk},
          {"interleaved", s.layout.interleaved}}},
        {"scene",
         {{"hash", s.scene->hash()},
          {"triangles", s.scene->compiled().surface_triangles.size()},
          {"lights", s.scene->compiled().lights.size()}}},
        {"seconds",
         {{"compile", numbers.compile_seconds},
          {"bvh_device", numbers.bvh_seconds},
          {"bvh_wall", s.scene->bvh_wall_seconds()},
          {"device", numbers.device_seconds},
          {"wall", numbers.wall_seconds}}},
        {"samples", numbers.samples},
        {"rays", {{"nearest", counters.nearest_rays}, {"shadow", counters.shadow_rays}}},
        {"rounds", counters.iterations},
    };
    for (const PilotTrial &trial : s.pilot.trials) {
        report["pilot"]["trials"].push_back({{"light_paths_per_pixel", trial.per_pixel},
                                             {"variance", trial.variance},
                                             {"rays_per_pixel", trial.rays}});
    }
    if (!s.pilot.trials.empty()) {
        report["pilot"].update(
            {{"light_paths", s.pilot.light_paths}, {"seconds", s.pilot.seconds}});
    }
    uint32_t largest_path = 0;
    for (const CompiledPass &pass : s.passes) {
        const auto add_programs = [&](const std::map<std::string, Program> &programs) {
            for (const auto &[file, program] : programs) {
                report["programs"].push_back({{"pass", to_string(pass.kind)},
                                              {"file", file},
                                              {"seconds", program.build_seconds()},
                                              {"from_cache", program.from_cache()}});
                if (program.binary_bytes() > 0) {
                    report["programs"].back()["binary_bytes"] = program.binary_bytes();
                }
            }
        };
        add_programs(pass.stages.programs());
        if (pass.features.has(Feature::convergence)) {
            add_programs(s.convergence->programs());
        }
        for (const auto &[name, stage] : pass.profile) {
            report["stages"].push_back({{"pass", to_string(pass.kind)},
                                        {"name", name},
                                        {"seconds", stage.seconds},
                                        {"launches", stage.launches}});
        }
        uint32_t path_bytes = pass.streams ? STREAM_QUEUES * sizeof(uint32_t) : 0;
        nlohmann::json fields;
        for (const PathStateField &field : path_state_fields(pass.features)) {
            fields.push_back({{"field", field.name}, {"bytes", field.words * sizeof(uint32_t)}});
            path_bytes += field.words * static_cast<uint32_t>(sizeof(uint32_t));
        }
        report["passes"].push_back({{"name", to_string(pass.kind)},
                                    {"features", pass.features.names()},
                                    {"paths_per_sample", s.paths_per_sample(pass)},
                                    {"path_state", fields},
                                    {"bytes_per_path", path_bytes}});
        if (pass.ray_counts.size() > 0) {
            report["passes"].back()["rays_by_depth"] = {
                {"nearest", pass.rays_by_depth(RAY_NEAREST)},
                {"shadow", pass.rays_by_depth(RAY_SHADOW)}};
        }
        largest_path = std::max(largest_path, path_bytes);
    }
    // Passes reuse the memory of path states, so that only the largest counts. Light vertices are
    // kept from one pass to the next.
    const uint32_t vertex_bytes =
        s.vertex_words_per_path() * static_cast<uint32_t>(sizeof(uint32_t));
    const uint32_t branch_bytes =
        s.branch_words_per_path() * static_cast<uint32_t>(sizeof(uint32_t));
    report["light_vertex_bytes_per_path"] = vertex_bytes;
    report["branch_bytes_per_path"] = branch_bytes;
    report["bytes_per_path"] = largest_path + vertex_bytes + branch_bytes;
    for (const auto &[name, stage] : s.scene->bvh_stages()) {
        report["bvh"]["stages"].push_back(
            {{"name", name}, {"seconds", stage.seconds}, {"launches", stage.launches}});
    }
    const BvhReport &bvh = s.scene->bvh().report();
    report["bvh"].update({{"layout", to_string(s.layout.bvh)},
                          {"builder", to_string(bvh.method)},
                          {"refitted", s.scene->is_refitted()},
                          {"nodes", bvh.nodes},
                          {"leaves", bvh.leaves},
                          {"depth", bvh.depth},
                          {"sah_cost", bvh.sah_cost},
                          {"wide_nodes", bvh.wide_nodes},
                          {"wide_leaves", bvh.wide_leaves},
                          {"rejected", bvh.rejected()},
                          {"bytes", bvh.bytes},
                          {"bytes_peak", bvh.bytes_peak}});
    const auto add_buffer = [&](const auto &buffer) {
        if (buffer.size() > 0) {
            report["buffers"].push_back({{"name", buffer.name()}, {"bytes", buffer.bytes()}});
        }
    };
    s.scene->visit_buffers(add_buffer);
    add_buffer(s.path_words);
    add_buffer(s.vertex_words);
    add_buffer(s.branch_vertices);
    add_buffer(s.queues);
    add_buffer(s.counters);
    for (const CompiledPass &pass : s.passes) {
        add_buffer(pass.film);
        add_buffer(pass.ray_counts);
    }
    if (s.convergence != nullptr) {
        s.convergence->visit_buffers(add_buffer);
        report["convergence"] = convergence_report(s.convergence->state(), s.ranges.samples());
    }
    return report;
}

}  // namespace rtrays
