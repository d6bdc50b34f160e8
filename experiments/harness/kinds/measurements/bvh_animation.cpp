// SPDX-License-Identifier: MIT
// Compares rebuilding with refitting of the hierarchy of an animated mesh, frame by frame.
#include <fmt/format.h>

#include <cmath>
#include <memory>
#include <nlohmann/json.hpp>

#include "experiments/harness/core/document.h"
#include "experiments/harness/core/host.h"
#include "experiments/harness/kinds/measurements/plans.h"
#include "experiments/harness/models/meshes.h"
#include "experiments/harness/models/tracers.h"
#include "renderer/bvh/refit.h"

namespace rtrays {

namespace {

/// Returns the mesh at `time`. cloth_ball has frames at times 0 and 1 and is extrapolated linearly
/// beyond. Any other mesh is twisted about the vertical axis through its centre, at time 1 by a
/// full turn over its height.
test::Mesh at_time(const test::Mesh &mesh, const test::Mesh *second, float time) {
    test::Mesh moved = mesh;
    const Eigen::AlignedBox3f box = mesh.box();
    for (size_t i = 0; i < mesh.positions.size(); ++i) {
        Eigen::Vector3f &p = moved.positions[i];
        if (second != nullptr) {
            p += time * (second->positions[i] - p);
        } else {
            const float angle =
                2 * static_cast<float>(M_PI) * time * (p.y() - box.min().y()) / box.sizes().y();
            p = box.center() +
                Eigen::AngleAxisf(angle, Eigen::Vector3f::UnitY()) * (p - box.center());
        }
    }
    return moved;
}

/// A tree of the first frame that is refitted to every other frame.
struct Fitted {
    std::string name;
    std::unique_ptr<DeviceTracer> tracer;
    std::unique_ptr<BvhRefitter> refitter;
};

struct Variant {
    std::string name;
    BvhBuilder builder;
};

class Animation {
  public:
    Animation(DeviceContext &device, const std::string &name, const MeasurementSettings &settings)
        : device_(&device), settings_(settings), first_(load_measured_mesh(name)) {
        if (name == "cloth_ball") {
            second_ = std::make_unique<test::Mesh>(load_measured_mesh("cloth_ball_next").mesh);
        }
        const DeviceMesh mesh(device, first_.mesh);
        const BvhLayout usual = BvhBuildParameters::for_device(device.info()).layout;
        for (const HierarchyVariant &variant : hierarchy_variants(device.info())) {
            if (variant.parameters.layout == usual) {
                builders_.push_back({variant.name, BvhBuilder(device, variant.parameters)});
                Bvh bvh = builders_.back().builder.build(mesh.positions, mesh.indices);
                auto refitter = std::make_unique<BvhRefitter>(device, bvh);
                fitted_.push_back({variant.name,
                                   std::make_unique<DeviceTracer>(device, std::move(bvh)),
                                   std::move(refitter)});
            }
        }
    }

    /// Measures frame `frame`, from 0 to settings.frames. Its time is frame / settings.frames for a
    /// twist, or frame for cloth_ball.
    Json frame(int frame) {
        const float time =
            static_cast<float>(frame) / (second_ ? 1.0f : static_cast<float>(settings_.frames));
        const test::Mesh mesh = at_time(first_.mesh, second_.get(), time);
        const DeviceMesh on_device(*device_, mesh);
        Contest updates(clock_of(device_->info()));
        std::vector<std::unique_ptr<DeviceTracer>> built;
        for (Variant &variant : builders_) {
            built.push_back(std::make_unique<DeviceTracer>(
                *device_, variant.builder.build(on_device.positions, on_device.indices)));
            updates.add("build " + variant.name, [&, builder = &variant.builder] {
                return time_of([&] { builder->build(on_device.positions, on_device.indices); });
            });
        }
        for (Fitted &fitted : fitted_) {
            const auto fit = [&, &tree = fitted] {
                if (!tree.refitter->refit(tree.tracer->bvh(), on_device.positions,
                                          on_device.indices)) {
                    throw run_error(
                        fmt::format("{}: new triangles appear in frame {}", mesh.name, frame));
                }
            };
            fit();  // the first launches compile
            updates.add("fit " + fitted.name, [fit] { return time_of(fit); });
        }
        run_turns(updates, settings_.repetitions);

        const uint32_t threads = host_threads(device_->info());
        const test::EmbreeScene embree(mesh, fmt::format("threads={}", threads));
        const DeviceRays rays(*device_,
                              make_rays("diffuse", mesh, first_.view, embree, settings_.rays),
                              Query::nearest);
        Contest traces(clock_of(device_->info()));
        Json work = Json::array();
        const auto add = [&](const std::string &name, const DeviceTracer &tracer) {
            tracer.trace(rays);
            const auto [nodes, triangles] = tracer.work_per_ray(rays);
            work.push_back({{"name", name},
                            {"hits", rays.hit_count()},
                            {"nodes_per_ray", nodes},
                            {"triangles_per_ray", triangles}});
            traces.add(name, [&] { return time_of([&] { tracer.trace(rays); }); });
        };
        for (size_t i = 0; i < builders_.size(); ++i) {
            add("build " + builders_[i].name, *built[i]);
            add("fit " + fitted_[i].name, *fitted_[i].tracer);
        }
        run_turns(traces, settings_.repetitions);
        return result(frame, updates, traces, work, static_cast<double>(rays.count));
    }

    Json description() const {
        return {{"mesh", first_.mesh.name},
                {"triangles", first_.mesh.triangles.size()},
                {"motion",
                 second_ ? "two frames, then extrapolated" : "twisted by a turn over its height"}};
    }

  private:
    /// Returns the result of a frame. Speeds are relative to the default builder's rebuilt tree.
    Json result(int frame, const Contest &updates, const Contest &traces, Json work,
                double ray_count) const {
        Json entries = Json::array();
        for (const std::string &name : updates.names()) {
            entries.push_back({{"name", name},
                               {"wall_ms", scaled(updates.wall_seconds(name), 1e3)},
                               {"processor_ms", scaled(updates.processor_seconds(name), 1e3)}});
        }
        const std::string base = "build " + builders_.front().name;
        for (Json &entry : work) {
            const std::string name = entry.at("name");
            if (entry.at("hits") != work.front().at("hits")) {
                throw run_error(fmt::format(
                    "{}: in frame {}, {} rays hit with '{}' and {} with '{}'", first_.mesh.name,
                    frame, entry.at("hits").dump(), name, work.front().at("hits").dump(), base));
            }
            entry["processor_ns"] = scaled(traces.processor_seconds(name), 1e9 / ray_count);
            entry["speed_over_build"] = to_json(traces.speed_over(name, base));
        }
        return {{"frame", frame},
                {"updates", entries},
                {"rays", work},
                {"foreign_load", updates.foreign_load()}};
    }

    DeviceContext *device_;
    MeasurementSettings settings_;
    MeasuredMesh first_;
    std::unique_ptr<test::Mesh> second_;
    std::vector<Variant> builders_;
    std::vector<Fitted> fitted_;
};

}  // namespace

MeasurementPlan plan_bvh_animation(const MeasurementSettings &settings, DeviceContext &device) {
    MeasurementPlan plan;
    for (const std::string &name : settings.meshes) {
        plan.tasks.push_back({name, [&device, settings, name] {
                                  Animation animation(device, name, settings);
                                  Json row = animation.description();
                                  for (int frame = 0; frame <= settings.frames; ++frame) {
                                      row["frames"].push_back(animation.frame(frame));
                                  }
                                  return row;
                              }});
    }
    plan.summarise = [](const Json &) { return Json::object(); };
    return plan;
}

}  // namespace rtrays
