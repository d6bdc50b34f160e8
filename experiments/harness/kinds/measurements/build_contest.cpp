// SPDX-License-Identifier: MIT
#include "experiments/harness/kinds/measurements/build_contest.h"

#include <fmt/format.h>

#include <nlohmann/json.hpp>

#include "experiments/harness/core/document.h"
#include "experiments/harness/core/host.h"
#include "experiments/harness/kinds/measurements/plans.h"
#include "renderer/testing/full_sweep.h"

namespace rtrays {

namespace {

struct EmbreeQuality {
    const char *name;
    RTCBuildQuality quality;
};
constexpr EmbreeQuality qualities[] = {{"Embree low", RTC_BUILD_QUALITY_LOW},
                                       {BuildContest::baseline, RTC_BUILD_QUALITY_MEDIUM},
                                       {"Embree high", RTC_BUILD_QUALITY_HIGH}};

test::EmbreeScene embree_scene(const test::Mesh &mesh, uint32_t threads, RTCBuildQuality quality) {
    return {mesh, fmt::format("threads={}", threads), quality, RTC_SCENE_FLAG_NONE};
}

/// Returns the bytes of the hierarchy including its triangles, and the peak during the build
/// including vertices and indices. The device builder counts both in the same way.
Json embree_facts(const test::Mesh &mesh, uint32_t threads, RTCBuildQuality quality) {
    test::EmbreeScene scene = embree_scene(mesh, threads, quality);
    const int64_t before = scene.bytes();
    scene.commit();
    return {
        {"side", "embree"}, {"bytes", scene.bytes() - before}, {"bytes_peak", scene.bytes_peak()}};
}

Json device_facts(DeviceContext &device, BvhBuilder &builder, const DeviceMesh &mesh,
                  const DeviceRays &rays) {
    builder.build(mesh.positions, mesh.indices);  // the first launches compile
    device.profiler().take();
    Bvh bvh = builder.build(mesh.positions, mesh.indices);
    Json stages = Json::object();
    for (const auto &[name, stage] : device.profiler().take()) {
        if (stage.launches > 0) {
            stages[name] = {{"ms", 1e3 * stage.seconds}, {"launches", stage.launches}};
        }
    }
    const BvhReport report = bvh.report();
    const auto [nodes, triangles] = DeviceTracer(device, std::move(bvh)).work_per_ray(rays);
    return {{"side", "ours"},
            {"method", to_string(report.method)},
            {"sah", report.sah_cost},
            {"depth", report.depth},
            {"rejected", report.rejected()},
            {"nodes_per_ray", nodes},
            {"triangles_per_ray", triangles},
            {"bytes", report.bytes},
            {"bytes_peak", report.bytes_peak},
            {"stages", stages}};
}

std::vector<RayRecord> diffuse_rays(const MeasuredMesh &mesh, uint32_t threads, size_t count) {
    test::EmbreeScene embree = embree_scene(mesh.mesh, threads, RTC_BUILD_QUALITY_MEDIUM);
    embree.commit();
    return make_rays("diffuse", mesh.mesh, mesh.view, embree, count);
}

}  // namespace

Builders::Builders(DeviceContext &device) : device_(&device) {
    for (const HierarchyVariant &variant : hierarchy_variants(device.info())) {
        all_.push_back({variant.name, BvhBuilder(device, variant.parameters)});
    }
}

BuildContest::BuildContest(Builders &builders, const std::string &mesh, size_t ray_count)
    : mesh_(load_measured_mesh(mesh)),
      on_device_(std::make_unique<DeviceMesh>(builders.device(), mesh_.mesh)),
      contest_(clock_of(builders.device().info())) {
    DeviceContext &device = builders.device();
    const uint32_t threads = host_threads(device.info());
    {
        const DeviceRays rays(device, diffuse_rays(mesh_, threads, ray_count), Query::nearest);
        for (Builders::Named &named : builders.all()) {
            facts_.push_back(device_facts(device, named.builder, *on_device_, rays));
            contest_.add(named.name, [this, builder = &named.builder] {
                return time_of([&] { builder->build(on_device_->positions, on_device_->indices); });
            });
        }
    }
    for (const EmbreeQuality &quality : qualities) {
        facts_.push_back(embree_facts(mesh_.mesh, threads, quality.quality));
        contest_.add(quality.name, [this, threads, quality] {
            test::EmbreeScene scene = embree_scene(mesh_.mesh, threads, quality.quality);
            return time_of([&] { scene.commit(); });
        });
    }
}

Json BuildContest::row() const {
    Json contestants = Json::array();
    const std::vector<std::string> names = contest_.names();
    for (size_t i = 0; i < names.size(); ++i) {
        Json entry = facts_[i];
        entry["name"] = names[i];
        entry["wall_ms"] = scaled(contest_.wall_seconds(names[i]), 1e3);
        entry["processor_ms"] = scaled(contest_.processor_seconds(names[i]), 1e3);
        entry["speed_over_embree"] = to_json(contest_.speed_over(names[i], baseline));
        contestants.push_back(entry);
    }
    return {{"mesh", mesh_.mesh.name},
            {"triangles", mesh_.mesh.triangles.size()},
            {"turns", contest_.turns()},
            {"foreign_load", contest_.foreign_load()},
            {"contestants", contestants}};
}

double BuildContest::full_sweep_cost() const {
    return test::full_sweep_cost(mesh_.mesh);
}

MeasurementPlan plan_bvh_build(const MeasurementSettings &settings, DeviceContext &device) {
    MeasurementPlan plan;
    const auto builders = std::make_shared<Builders>(device);
    for (const std::string &mesh : settings.meshes) {
        plan.tasks.push_back({mesh, [=] {
                                  BuildContest contest(*builders, mesh, settings.rays);
                                  run_turns(contest.contest(), settings.repetitions);
                                  Json row = contest.row();
                                  row["full_sweep_sah"] = contest.full_sweep_cost();
                                  return row;
                              }});
    }
    const char *const time =
        clock_of(device.info()) == Clock::processor ? "processor_ms" : "wall_ms";
    plan.summarise = [time](const Json &rows) {
        // Exponents of milliseconds over triangles, by contestant.
        Json exponents = Json::object();
        for (size_t i = 0; rows.size() > 2 && i < rows.at(0).at("contestants").size(); ++i) {
            std::vector<double> triangles, milliseconds;
            for (const Json &row : rows) {
                triangles.push_back(row.at("triangles"));
                milliseconds.push_back(row.at("contestants").at(i).at(time).at("value"));
            }
            exponents[rows.at(0).at("contestants").at(i).at("name").get<std::string>()] =
                to_json(power_law_exponent(triangles, milliseconds));
        }
        return Json{{"exponents", exponents}};
    };
    return plan;
}

}  // namespace rtrays
