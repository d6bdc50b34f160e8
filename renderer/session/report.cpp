// SPDX-License-Identifier: MIT
// The document that `--stats` writes.
#include <nlohmann/json.hpp>

#include "renderer/base/commit.h"
#include "renderer/compile/guide_table.h"
#include "renderer/session/state.h"
#include "renderer/shared/path_state.h"

namespace rtrays {

namespace {

using Json = nlohmann::json;

Json device_report(const DeviceInfo &info) {
    return {{"name", info.name}, {"driver", info.driver}, {"platform", info.platform_name}};
}

Json pilot_report(const Pilot &pilot) {
    Json report = {{"light_paths", pilot.light_paths},
                   {"explicit", pilot.is_explicit},
                   {"rays", pilot.rays},
                   {"seconds", pilot.seconds},
                   {"seconds_wall", pilot.wall_seconds}};
    if (pilot.emission_guide != nullptr) {
        report["guide"] = guide_hash(pilot.emission_guide->words);
    }
    if (pilot.scatter_guide != nullptr) {
        report["scatter_guide"] = guide_hash(pilot.scatter_guide->words);
    }
    for (const PilotTrial &trial : pilot.trials) {
        report["trials"].push_back({{"light_paths_per_pixel", trial.per_pixel},
                                    {"explicit", trial.is_explicit},
                                    {"variance", trial.variance},
                                    {"cost", trial.cost}});
    }
    return report;
}

/// Adds the entry of a pass' program to "programs".
void add_program(Json &report, PassKind pass, const Program &program) {
    Json entry = {{"pass", to_string(pass)},
                  {"files", program.paths()},
                  {"seconds", program.build_seconds()},
                  {"from_cache", program.from_cache()}};
    if (program.binary_bytes() > 0) {
        entry["binary_bytes"] = program.binary_bytes();
    }
    report["programs"].push_back(entry);
}

/// Adds an entry for each stage of a profile to "stages".
void add_stages(Json &report, const std::map<std::string, Profiler::Stage> &profile,
                const char *pass = nullptr) {
    for (const auto &[name, stage] : profile) {
        Json entry = {{"name", name}, {"seconds", stage.seconds}, {"launches", stage.launches}};
        if (pass != nullptr) {
            entry["pass"] = pass;
        }
        report["stages"].push_back(entry);
    }
}

constexpr auto word_bytes = static_cast<uint32_t>(sizeof(uint32_t));

/// Returns the bytes of a path's state and of its entries in queues.
uint32_t bytes_per_path(const CompiledPass &pass) {
    return (pass.queues() + path_state_words(pass.features)) * word_bytes;
}

Json pass_report(const CompiledPass &pass, uint64_t paths_per_sample) {
    Json fields;
    for (const PathStateField &field : path_state_fields(pass.features)) {
        fields.push_back({{"field", field.name}, {"bytes", field.words * word_bytes}});
    }
    Json report = {{"name", to_string(pass.kind)},
                   {"features", pass.features.names()},
                   {"paths_per_sample", paths_per_sample},
                   {"path_state", fields},
                   {"bytes_per_path", bytes_per_path(pass)}};
    if (pass.ray_counts.size() > 0) {
        report["rays_by_depth"] = {{"nearest", pass.rays_by_depth(RAY_NEAREST)},
                                   {"shadow", pass.rays_by_depth(RAY_SHADOW)}};
    }
    return report;
}

Json bvh_report(const DeviceScene &scene, BvhLayout layout) {
    const BvhReport &bvh = scene.bvh().report();
    Json report = {{"layout", to_string(layout)},
                   {"builder", to_string(bvh.method)},
                   {"refitted", scene.is_refitted()},
                   {"nodes", bvh.nodes},
                   {"leaves", bvh.leaves},
                   {"depth", bvh.depth},
                   {"sah_cost", bvh.sah_cost},
                   {"wide_nodes", bvh.wide_nodes},
                   {"wide_leaves", bvh.wide_leaves},
                   {"rejected", bvh.rejected()},
                   {"bytes", bvh.bytes},
                   {"bytes_peak", bvh.bytes_peak}};
    add_stages(report, scene.bvh_stages());
    return report;
}

}  // namespace

void RenderSession::State::report_passes(Json &report) const {
    uint32_t largest_path = 0;
    for (const CompiledPass &pass : passes) {
        for (const Program &program : pass.stages.programs()) {
            add_program(report, pass.kind, program);
        }
        if (pass.features.has(Feature::convergence)) {
            add_program(report, pass.kind, convergence->program());
        }
        add_stages(report, pass.profile, to_string(pass.kind));
        report["passes"].push_back(pass_report(pass, paths_per_sample(pass)));
        largest_path = std::max(largest_path, bytes_per_path(pass));
    }
    // Passes reuse the memory of path states, so that only the largest counts. Light vertices are
    // kept from one pass to the next.
    const uint32_t vertex_bytes = vertex_words_per_path() * word_bytes;
    const uint32_t branch_bytes = branch_words_per_path() * word_bytes;
    report["light_vertex_bytes_per_path"] = vertex_bytes;
    report["branch_bytes_per_path"] = branch_bytes;
    report["bytes_per_path"] = largest_path + vertex_bytes + branch_bytes;
}

void RenderSession::State::report_buffers(Json &report) const {
    const auto add = [&](const auto &buffer) {
        if (buffer.size() > 0) {
            report["buffers"].push_back({{"name", buffer.name()}, {"bytes", buffer.bytes()}});
        }
    };
    scene->visit_buffers(add);
    add(emission_guide);
    add(scatter_guide);
    add(path_words);
    add(vertex_words);
    add(branch_vertices);
    add(queues);
    add(counters);
    for (const CompiledPass &pass : passes) {
        add(pass.film);
        add(pass.ray_counts);
    }
    if (convergence != nullptr) {
        convergence->visit_buffers(add);
    }
}

nlohmann::json RenderSession::report() const {
    const State &s = *state_;
    const RenderStats totals = stats();
    const StreamCounters counters = s.counters.read().front();
    Json report = {
        {"schema_version", 1},
        {"commit", commit()},
        {"dirty", built_from_changed_sources()},
        {"device", device_report(s.device.info())},
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
         {{"compile", totals.compile_seconds},
          {"bvh_device", totals.bvh_seconds},
          {"bvh_wall", s.scene->bvh_wall_seconds()},
          {"device", totals.device_seconds},
          {"wall", totals.wall_seconds}}},
        {"samples", totals.samples},
        {"rays", {{"nearest", counters.nearest_rays}, {"shadow", counters.shadow_rays}}},
        {"rounds", counters.iterations},
        {"bvh", bvh_report(*s.scene, s.layout.bvh)},
    };
    if (s.pilot.rays > 0) {
        report["pilot"] = pilot_report(s.pilot);
    }
    s.report_passes(report);
    s.report_buffers(report);
    if (s.convergence != nullptr) {
        report["convergence"] = convergence_report(s.convergence->state(), s.ranges.samples());
    }
    return report;
}

}  // namespace rtrays
