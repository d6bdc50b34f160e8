// SPDX-License-Identifier: MIT
#include "experiments/harness/kinds/measurements/ray_contest.h"

#include <fmt/format.h>

#include <cmath>
#include <map>
#include <nlohmann/json.hpp>

#include "experiments/harness/core/document.h"
#include "experiments/harness/core/host.h"
#include "experiments/harness/kinds/measurements/plans.h"

namespace rtrays {

namespace {

/// Returns Embree's tracer with the instruction set that traces these rays fastest, best of three.
const EmbreeTracer &fastest(const TracedMesh &mesh, const std::vector<RayRecord> &rays,
                            const RayKind &kind, EmbreeCall call) {
    const EmbreeTracer *best = nullptr;
    double best_seconds = INFINITY;
    for (int turn = 0; turn < 3; ++turn) {
        for (const auto &tracer : mesh.embree()) {
            const double seconds =
                time_of([&] { tracer->trace(rays, kind.query, call, kind.coherent); }).processor;
            if (seconds < best_seconds) {
                best_seconds = seconds;
                best = tracer.get();
            }
        }
    }
    return *best;
}

}  // namespace

TracedMesh::TracedMesh(DeviceContext &device, const std::string &name)
    : device_(&device),
      mesh_(load_measured_mesh(name)),
      embree_(embree_tracers(mesh_.mesh, host_threads(device.info()))) {
    const DeviceMesh on_device(device, mesh_.mesh);
    for (const HierarchyVariant &variant : hierarchy_variants(device.info())) {
        BvhBuilder builder(device, variant.parameters);
        ours_.push_back({variant.name, DeviceTracer(device, builder.build(on_device.positions,
                                                                          on_device.indices))});
    }
}

RayContest::RayContest(const TracedMesh &mesh, const RayKind &kind, size_t count)
    : mesh_(&mesh),
      kind_(kind),
      rays_(make_rays(kind.name, mesh.mesh().mesh, mesh.mesh().view, mesh.embree().front()->scene(),
                      count)),
      on_device_(std::make_unique<DeviceRays>(mesh.device(), rays_, kind.query)),
      contest_(clock_of(mesh.device().info())),
      baseline_(name_of(EmbreeCall::single, kind.query)) {
    const size_t expected =
        mesh.embree().front()->trace(rays_, kind.query, EmbreeCall::single, kind.coherent);
    for (const TracedMesh::Named &ours : mesh.ours()) {
        ours.tracer.trace(*on_device_);
        require_equal_hits(ours.name, on_device_->hit_count(), expected);
        const auto [nodes, triangles] = ours.tracer.work_per_ray(*on_device_);
        facts_.push_back({{"side", "ours"},
                          {"method", to_string(ours.tracer.bvh().report().method)},
                          {"nodes_per_ray", nodes},
                          {"triangles_per_ray", triangles},
                          {"bytes", ours.tracer.bvh().report().bytes}});
        contest_.add(ours.name, [this, tracer = &ours.tracer] {
            return time_of([&] { tracer->trace(*on_device_); });
        });
    }
    for (const EmbreeCall call : {EmbreeCall::single, EmbreeCall::packets}) {
        const EmbreeTracer &tracer = fastest(mesh, rays_, kind, call);
        const std::string name = name_of(call, kind.query);
        require_equal_hits(name, tracer.trace(rays_, kind.query, call, kind.coherent), expected);
        facts_.push_back({{"side", "embree"}, {"isa", tracer.isa()}});
        contest_.add(name, [this, &tracer, call] {
            return time_of([&] { tracer.trace(rays_, kind_.query, call, kind_.coherent); });
        });
    }
}

void RayContest::require_equal_hits(const std::string &name, size_t hits, size_t expected) const {
    if (std::max(hits, expected) - std::min(hits, expected) > rays_.size() / 10000) {
        throw run_error(fmt::format("{}: of {} {} rays, {} hit with {} and {} with Embree",
                                    mesh_->mesh().mesh.name, rays_.size(), kind_.name, hits, name,
                                    expected));
    }
}

Json RayContest::row() const {
    Json contestants = Json::array();
    const std::vector<std::string> names = contest_.names();
    for (size_t i = 0; i < names.size(); ++i) {
        const Interval wall = contest_.wall_seconds(names[i]);
        Json entry = facts_[i];
        entry["name"] = names[i];
        entry["Mrays_s"] =
            to_json(Interval{millions_of_rays() / wall.value, millions_of_rays() / wall.high,
                             millions_of_rays() / wall.low});
        entry["processor_ns"] =
            scaled(contest_.processor_seconds(names[i]), 1e9 / static_cast<double>(rays_.size()));
        entry["speed_over_embree"] = to_json(contest_.speed_over(names[i], baseline_));
        contestants.push_back(entry);
    }
    return {{"kind", kind_.name},
            {"rays", rays_.size()},
            {"turns", contest_.turns()},
            {"foreign_load", contest_.foreign_load()},
            {"stackless_over_stack",
             to_json(contest_.speed_over("binned_sah bvh2_stackless", "binned_sah bvh2"))},
            {"contestants", contestants}};
}

MeasurementPlan plan_ray_rates(const MeasurementSettings &settings, DeviceContext &device) {
    MeasurementPlan plan;
    for (const std::string &name : settings.meshes) {
        plan.tasks.push_back({name, [&device, settings, name] {
                                  const TracedMesh mesh(device, name);
                                  Json row = {{"mesh", name},
                                              {"triangles", mesh.mesh().mesh.triangles.size()},
                                              {"kinds", Json::array()}};
                                  for (const RayKind &kind : ray_kinds()) {
                                      RayContest contest(mesh, kind, settings.rays);
                                      run_turns(contest.contest(), settings.repetitions);
                                      row["kinds"].push_back(contest.row());
                                  }
                                  return row;
                              }});
    }
    plan.summarise = [](const Json &rows) {
        // Geometric means over the meshes of the speeds over Embree, by kind and contestant.
        std::map<std::string, std::map<std::string, std::vector<double>>> logs;
        for (const Json &row : rows) {
            for (const Json &kind : row.at("kinds")) {
                auto &of_kind = logs[kind.at("kind")];
                for (const Json &contestant : kind.at("contestants")) {
                    of_kind[contestant.at("name")].push_back(
                        std::log(contestant.at("speed_over_embree").at("value").get<double>()));
                }
                of_kind["stackless_over_stack"].push_back(
                    std::log(kind.at("stackless_over_stack").at("value").get<double>()));
            }
        }
        Json means = Json::object();
        for (const auto &[kind, contestants] : logs) {
            for (const auto &[name, values] : contestants) {
                double sum = 0;
                for (const double value : values) {
                    sum += value;
                }
                means[kind][name] = std::exp(sum / static_cast<double>(values.size()));
            }
        }
        return Json{{"geometric_means", means}};
    };
    return plan;
}

}  // namespace rtrays
