// SPDX-License-Identifier: MIT
// Rays per second of the hierarchy on the OpenCL device and of Embree, in turns, by scene, kind of ray
// and layout.
//
// An iteration traces the same rays by both, in the order AB BA AB ..., on as many threads as the device has
// compute units. Its time is the device's. Counters: Mrays_s and embree_Mrays_s by wall time (medians);
// ratio, ratio_low, ratio_high: device over Embree by processor time of all threads, median with 95 %
// interval, which other load on the machine hardly changes; wall_ratio the same by wall time; nodes and
// triangles tested per ray; MB of the tree. Embree runs by the instruction set that is fastest on these rays
// (the label says which), ROBUST.
#include <benchmark/benchmark.h>
#include <fmt/format.h>

#include <map>
#include <memory>
#include <thread>

#include "experiments/benchmarks/benchmark_program.h"
#include "experiments/benchmarks/benchmark_rays.h"
#include "experiments/statistics.h"
#include "renderer/base/error.h"
#include "renderer/tests/bvh_tree.h"

namespace rtrays::benchmarks {
namespace {

constexpr size_t ray_count = 256 * 256;
constexpr int iterations = 11;

DeviceContext &device() {
    return test::test_device();
}

class EmbreeTracer {
  public:
    EmbreeTracer(const test::Mesh &mesh, const std::string &configuration)
        : scene_(mesh, configuration), threads_(device().info().compute_units) {}

    const test::EmbreeScene &scene() const { return scene_; }

    /// Number of rays that hit something.
    size_t trace(const std::vector<RayRecord> &rays, Query query) const {
        std::vector<size_t> hits(threads_);
        std::vector<std::thread> workers;
        for (size_t worker = 0; worker < threads_; ++worker) {
            workers.emplace_back([&, worker] {
                const size_t end = rays.size() * (worker + 1) / threads_;
                size_t found = 0;
                for (size_t i = rays.size() * worker / threads_; i < end; ++i) {
                    const bool hit = query == Query::nearest ? scene_.nearest(rays[i]) < rays[i].t_max
                                                             : scene_.occluded(rays[i]);
                    found += hit ? 1 : 0;
                }
                hits[worker] = found;
            });
        }
        for (std::thread &worker : workers) {
            worker.join();
        }
        size_t all = 0;
        for (const size_t found : hits) {
            all += found;
        }
        return all;
    }

  private:
    test::EmbreeScene scene_;
    size_t threads_;
};

/// A layout of the hierarchy on the device.
class DeviceTracer {
  public:
    DeviceTracer(const test::Mesh &mesh, BvhLayout layout)
        : bvh_(test::build_on_device(mesh, layout)),
          trace_(device(), "kernels/traversal/trace_rays.cl", defines(layout, false)),
          count_(device(), "kernels/traversal/trace_rays.cl", defines(layout, true)) {}

    const BvhReport &report() const { return bvh_.report(); }

    void load(const std::vector<RayRecord> &rays, Query query) {
        query_ = query;
        ray_count_ = static_cast<uint32_t>(rays.size());
        rays_ = Buffer<RayRecord>(device(), "rays", rays);
        hits_ = Buffer<Hit>(device(), "hits", rays.size());
        occluded_ = Buffer<uint32_t>(device(), "occlusion", rays.size());
        kernel_ = query == Query::nearest ? kernel(trace_, "trace_nearest_rays", hits_)
                                          : kernel(trace_, "trace_any_rays", occluded_);
        trace();  // the first launch compiles
    }

    void trace() {
        kernel_.enqueue(ray_count_);
        device().finish();
    }

    /// Number of rays that hit something.
    size_t hits() const {
        size_t found = 0;
        if (query_ == Query::nearest) {
            for (const Hit &hit : hits_.read()) {
                found += hit.triangle != NO_HIT ? 1 : 0;
            }
        } else {
            for (const uint32_t occluded : occluded_.read()) {
                found += occluded;
            }
        }
        return found;
    }

    /// Means over the rays: {nodes, triangles}.
    std::pair<double, double> work_per_ray() {
        const Buffer<RayWork> work(device(), "work of rays", ray_count_);
        kernel(count_, query_ == Query::nearest ? "count_nearest_rays" : "count_any_rays", work)
            .enqueue(ray_count_);
        device().finish();
        double nodes = 0, triangles = 0;
        for (const RayWork &ray : work.read()) {
            nodes += ray.nodes;
            triangles += ray.triangles;
        }
        return {nodes / ray_count_, triangles / ray_count_};
    }

  private:
    static Defines defines(BvhLayout layout, bool counts) {
        return {{"BVH_LAYOUT", std::to_string(static_cast<uint32_t>(layout))},
                {"TRAVERSAL_COUNTS", counts ? "1" : "0"}};
    }

    template <typename T>
    Kernel kernel(const Program &program, const std::string &name, const Buffer<T> &results) const {
        Kernel kernel(program, name, 64);
        bvh_.visit([&](const auto &nodes, const auto &triangles) {
            kernel.bind({nodes, triangles, rays_, ray_count_, results});
        });
        return kernel;
    }

    Bvh bvh_;
    Program trace_, count_;
    Kernel kernel_;
    Query query_ = Query::nearest;
    uint32_t ray_count_ = 0;
    Buffer<RayRecord> rays_;
    Buffer<Hit> hits_;
    Buffer<uint32_t> occluded_;
};

/// One scene by Embree, with every instruction set, and by the device, with every layout. Benchmarks run
/// scene by scene: the last is kept.
struct LoadedScene {
    explicit LoadedScene(const BenchmarkScene &scene)
        : name(scene.name), view(scene.view), mesh(load_benchmark_mesh(scene.name)) {
        for (const auto &[isa, width] :
             {std::pair("sse4.2", 128), std::pair("avx2", 256), std::pair("avx512", 512)}) {
            const uint32_t threads = device().info().compute_units;
            embree.emplace_back(
                isa, std::make_unique<EmbreeTracer>(
                         mesh, fmt::format("threads={},isa={},frequency_level=simd{}", threads, isa, width)));
        }
        for (const NamedBvhLayout &named : bvh_layouts) {
            ours.try_emplace(named.layout, mesh, named.layout);
        }
    }

    std::string name;
    View view;
    test::Mesh mesh;
    std::map<BvhLayout, DeviceTracer> ours;
    std::vector<std::pair<std::string, std::unique_ptr<EmbreeTracer>>> embree;
};

LoadedScene &loaded(const BenchmarkScene &scene) {
    static std::unique_ptr<LoadedScene> last;
    if (!last || last->name != scene.name) {
        last.reset();
        last = std::make_unique<LoadedScene>(scene);
    }
    return *last;
}

/// Of the instruction sets the one that traces these rays fastest, best of three.
size_t fastest_embree(const LoadedScene &scene, const std::vector<RayRecord> &rays, Query query) {
    size_t fastest = 0;
    double best = INFINITY;
    for (int turn = 0; turn < 3; ++turn) {
        for (size_t i = 0; i < scene.embree.size(); ++i) {
            const double seconds = time_of([&] { scene.embree[i].second->trace(rays, query); }).processor;
            if (seconds < best) {
                best = seconds;
                fastest = i;
            }
        }
    }
    return fastest;
}

void trace_rays(benchmark::State &state, const BenchmarkScene &description, const RayKind &kind,
                BvhLayout layout) {
    LoadedScene &scene = loaded(description);
    const std::vector<RayRecord> rays =
        make_rays(kind.name, scene.mesh, scene.view, scene.embree.front().second->scene(), ray_count);
    const auto &[isa, embree] = scene.embree[fastest_embree(scene, rays, kind.query)];
    DeviceTracer &device_tracer = scene.ours.at(layout);
    device_tracer.load(rays, kind.query);
    const size_t embree_hits = embree->trace(rays, kind.query), hits = device_tracer.hits();
    if (std::max(hits, embree_hits) - std::min(hits, embree_hits) > rays.size() / 10000) {
        state.SkipWithError(
            fmt::format("{} of {} rays hit, {} by Embree", hits, rays.size(), embree_hits).c_str());
        return;
    }

    std::vector<double> wall_seconds, embree_wall_seconds, ratios, wall_ratios;
    for (auto _ : state) {
        Seconds ours{}, theirs{};
        const bool ours_first = wall_seconds.size() % 2 == 0;
        if (ours_first) {
            ours = time_of([&] { device_tracer.trace(); });
        }
        theirs = time_of([&] { benchmark::DoNotOptimize(embree->trace(rays, kind.query)); });
        if (!ours_first) {
            ours = time_of([&] { device_tracer.trace(); });
        }
        wall_seconds.push_back(ours.wall);
        embree_wall_seconds.push_back(theirs.wall);
        ratios.push_back(theirs.processor / ours.processor);
        wall_ratios.push_back(theirs.wall / ours.wall);
        state.SetIterationTime(ours.wall);
    }
    const double millions = 1e-6 * static_cast<double>(rays.size());
    const Interval ratio = median_interval(ratios);
    const auto [nodes, triangles] = device_tracer.work_per_ray();
    state.SetLabel("Embree by " + isa);
    state.counters["Mrays_s"] = millions / median(wall_seconds);
    state.counters["embree_Mrays_s"] = millions / median(embree_wall_seconds);
    state.counters["ratio"] = ratio.value;
    state.counters["ratio_low"] = ratio.low;
    state.counters["ratio_high"] = ratio.high;
    state.counters["wall_ratio"] = median(wall_ratios);
    state.counters["nodes"] = nodes;
    state.counters["triangles"] = triangles;
    state.counters["MB"] = 1e-6 * static_cast<double>(device_tracer.report().bytes);
}

}  // namespace

void register_benchmarks() {
    for (const BenchmarkScene &scene : benchmark_scenes()) {
        for (const RayKind &kind : ray_kinds()) {
            for (const NamedBvhLayout &named : bvh_layouts) {
                const auto run = [scene, kind, named](benchmark::State &state) {
                    trace_rays(state, scene, kind, named.layout);
                };
                benchmark::RegisterBenchmark(
                    fmt::format("{}/{}/{}", scene.name, kind.name, named.name).c_str(), run)
                    ->Iterations(iterations)
                    ->UseManualTime()
                    ->Unit(benchmark::kMillisecond);
            }
        }
    }
}

}  // namespace rtrays::benchmarks
