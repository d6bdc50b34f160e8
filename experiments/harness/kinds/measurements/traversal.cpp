// SPDX-License-Identifier: MIT
// Checks traversal with large numbers of rays, in batches: correct hits and watertight surfaces.
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <nlohmann/json.hpp>
#include <thread>

#include "experiments/harness/core/host.h"
#include "experiments/harness/core/resumption.h"
#include "experiments/harness/kinds/measurements/plans.h"
#include "experiments/harness/models/meshes.h"
#include "experiments/harness/models/tracers.h"
#include "renderer/testing/double_intersector.h"
#include "renderer/testing/ray_sets.h"

namespace rtrays {

namespace {

constexpr size_t batch_size = 1 << 18;

/// Largest shares of wrong hits, as judged in double precision, and of rays that escape from a
/// closed shape near the origin and far from it. The far limit is that of Embree's own test.
constexpr double wrong_limit = 1e-6, miss_limit = 0, far_miss_limit = 2e-5;

std::vector<DeviceTracer> tracers_of(DeviceContext &device, const test::Mesh &mesh,
                                     std::vector<std::string> &names) {
    const DeviceMesh on_device(device, mesh);
    std::vector<DeviceTracer> tracers;
    for (const HierarchyVariant &variant : hierarchy_variants(device.info())) {
        BvhBuilder builder(device, variant.parameters);
        tracers.emplace_back(device, builder.build(on_device.positions, on_device.indices));
        names.push_back(variant.name);
    }
    return tracers;
}

/// Calls work(count, batch) until all rays are done. Throws `Error` (interrupted) between batches
/// if a signal stops it.
template <typename Work>
void by_batches(size_t rays, const Work &work) {
    for (size_t first = 0, batch = 0; first < rays; first += batch_size, ++batch) {
        require_not_interrupted();
        work(std::min(batch_size, rays - first), batch);
    }
}

/// Calls work(i) for i in [0, count) on `threads` threads.
template <typename Work>
void in_parallel(size_t count, uint32_t threads, const Work &work) {
    std::atomic<size_t> next = 0;
    std::vector<std::thread> workers;
    for (uint32_t worker = 0; worker < threads; ++worker) {
        workers.emplace_back([&] {
            for (size_t i; (i = next++) < count;) {
                work(i);
            }
        });
    }
    for (std::thread &worker : workers) {
        worker.join();
    }
}

/// Numbers of hits that differ from Embree's, by kind of ray, and of those that are wrong in double
/// precision.
struct Differences {
    size_t random = 0, grazing = 0, tied = 0, wrong = 0;
};

/// Judgement of a hit of a ray, if one was given.
struct Verdict {
    bool given = false;
    float t = 0;
    uint32_t triangle = 0;
    bool is_right = false;
};

Json compare_hits(DeviceContext &device, const std::string &name, size_t ray_count) {
    const test::Mesh mesh = load_measured_mesh(name).mesh;
    const uint32_t threads = host_threads(device.info());
    const EmbreeTracer embree(mesh, threads, embree_isas().back());
    const test::DoubleJudge judge(mesh);
    std::vector<std::string> names;
    const std::vector<DeviceTracer> tracers = tracers_of(device, mesh, names);
    std::vector<Differences> differences(tracers.size());
    const float tolerance = 1e-5f * mesh.box().diagonal().norm();
    size_t hits = 0;
    by_batches(ray_count, [&](size_t count, size_t batch) {
        const std::vector<RayRecord> rays = test::fuzzed_rays(mesh, count, batch + 1);
        const std::vector<float> theirs = embree.nearest(rays);
        hits += static_cast<size_t>(
            std::count_if(theirs.begin(), theirs.end(), [](float t) { return t < INFINITY; }));
        const DeviceRays on_device(device, rays, Query::nearest);
        std::vector<Verdict> verdicts(count);  // kept, as layouts mostly find the same hits
        for (size_t i = 0; i < tracers.size(); ++i) {
            tracers[i].trace(on_device);
            const std::vector<Hit> ours = on_device.hits.read();
            std::vector<size_t> differing;
            for (size_t ray = 0; ray < count; ++ray) {
                if (!(ours[ray].t == INFINITY && theirs[ray] == INFINITY) &&
                    !(std::abs(ours[ray].t - theirs[ray]) <= tolerance)) {
                    differing.push_back(ray);
                    Differences &all = differences[i];
                    size_t *const by_kind[] = {&all.random, &all.grazing, &all.tied};  // ray_sets.h
                    ++*by_kind[ray % 3];
                }
            }
            std::atomic<size_t> wrong = 0;
            in_parallel(differing.size(), threads, [&](size_t d) {
                const RayRecord &ray = rays[differing[d]];
                const Hit &hit = ours[differing[d]];
                Verdict &verdict = verdicts[differing[d]];
                if (!verdict.given || verdict.t != hit.t || verdict.triangle != hit.triangle) {
                    verdict = {true, hit.t, hit.triangle,
                               judge.is_right(test::ray_origin(ray), test::ray_direction(ray),
                                              hit.t, hit.triangle, static_cast<double>(tolerance))};
                }
                wrong += verdict.is_right ? 0 : 1;
            });
            differences[i].wrong += wrong;
        }
    });
    Json layouts = Json::array();
    for (size_t i = 0; i < tracers.size(); ++i) {
        const Differences &d = differences[i];
        layouts.push_back({{"name", names[i]},
                           {"random", d.random},
                           {"grazing", d.grazing},
                           {"tied", d.tied},
                           {"wrong", d.wrong},
                           {"limit", wrong_limit},
                           {"passed", static_cast<double>(d.wrong) <=
                                          wrong_limit * static_cast<double>(ray_count)}});
    }
    return {{"check", "hits"},   {"mesh", name}, {"triangles", mesh.triangles.size()},
            {"rays", ray_count}, {"hits", hits}, {"layouts", layouts}};
}

/// A closed shape, and a ball inside it where rays start.
struct ClosedShape {
    std::string name;
    test::Mesh mesh;
    Eigen::Vector3f centre;
    float radius;
    double limit;
};

std::vector<ClosedShape> closed_shapes() {
    const Eigen::Vector3f far(148376.0f, 1234.0f, -223423.0f);  // from Embree's own test
    return {{"closed sphere",
             test::sphere(64, 128, 1.0f, 0.05f, {0, 0, 0}),
             {0, 0, 0},
             0.5f,
             miss_limit},
            {"closed room", test::room(), {450.0f, 400.0f, 200.0f}, 60.0f, miss_limit},
            {"closed sphere at (148376, 1234, -223423)", test::sphere(64, 128, 10.0f, 0.05f, far),
             far, 5.0f, far_miss_limit}};
}

/// Makes rays from inside a shape. Half of them have random directions. The others aim, in equal
/// parts, at points on triangles, on edges and at vertices.
std::vector<RayRecord> rays_from_inside(const ClosedShape &shape, size_t count, uint64_t seed) {
    test::Random random(seed);
    std::vector<RayRecord> rays;
    for (size_t i = 0; i < count; ++i) {
        const Eigen::Vector3f origin =
            shape.centre + shape.radius * test::uniform(random) * test::uniform_direction(random);
        const Eigen::Vector3f direction =
            i % 2 == 0 ? test::uniform_direction(random)
                       : Eigen::Vector3f(test::aim(shape.mesh, i / 2, random) - origin);
        rays.push_back(test::make_ray(origin, direction));
    }
    return rays;
}

Json count_misses(DeviceContext &device, const ClosedShape &shape, size_t ray_count) {
    std::vector<std::string> names;
    const std::vector<DeviceTracer> tracers = tracers_of(device, shape.mesh, names);
    std::vector<size_t> misses(tracers.size());
    by_batches(ray_count, [&](size_t count, size_t batch) {
        const DeviceRays rays(device, rays_from_inside(shape, count, batch + 1), Query::nearest);
        for (size_t i = 0; i < tracers.size(); ++i) {
            tracers[i].trace(rays);
            misses[i] += count - rays.hit_count();
        }
    });
    Json layouts = Json::array();
    for (size_t i = 0; i < tracers.size(); ++i) {
        layouts.push_back({{"name", names[i]},
                           {"misses", misses[i]},
                           {"limit", shape.limit},
                           {"passed", static_cast<double>(misses[i]) <=
                                          shape.limit * static_cast<double>(ray_count)}});
    }
    return {{"check", "watertight"},
            {"mesh", shape.name},
            {"triangles", shape.mesh.triangles.size()},
            {"rays", ray_count},
            {"layouts", layouts}};
}

}  // namespace

MeasurementPlan plan_traversal(const MeasurementSettings &settings, DeviceContext &device) {
    MeasurementPlan plan;
    for (const std::string &name : settings.meshes) {
        plan.tasks.push_back({"hits." + name, [&device, settings, name] {
                                  return compare_hits(device, name, settings.rays);
                              }});
    }
    for (const ClosedShape &shape : closed_shapes()) {
        plan.tasks.push_back(
            {fmt::format("watertight.{}", plan.tasks.size()), [&device, settings, shape] {
                 return count_misses(device, shape, settings.watertight_rays);
             }});
    }
    plan.summarise = [](const Json &) { return Json::object(); };
    return plan;
}

std::optional<bool> traversal_passes(const Json &row) {
    const Json &layouts = row.at("layouts");
    return std::all_of(layouts.begin(), layouts.end(),
                       [](const Json &layout) { return layout.at("passed").get<bool>(); });
}

}  // namespace rtrays
