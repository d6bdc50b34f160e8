// SPDX-License-Identifier: MIT
// Building the hierarchy on the OpenCL device and by Embree, in turns, by scene and layout (thesis
// table 4.1).
//
// An iteration builds by the device, from buffers that are there to a hierarchy that can be traced, and by
// Embree's low, medium and high qualities (rtcCommitScene, not ROBUST), on as many threads as the device has
// compute units; every second one in reverse order. Its time is the device's. Counters: Mtris_s and
// embree_*_ms by wall time (medians); ratio, ratio_low, ratio_high: device over Embree's medium quality by
// processor time of all threads, median with 95 % interval; SAH cost of the two-wide tree (K_T = K_I = 1);
// bytes per triangle of the result, and of the peak, input included.
#include <benchmark/benchmark.h>
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <functional>

#include "experiments/benchmarks/benchmark_program.h"
#include "experiments/benchmarks/benchmark_scenes.h"
#include "experiments/statistics.h"
#include "renderer/tests/bvh_tree.h"
#include "renderer/tests/embree_scene.h"

namespace rtrays::benchmarks {
namespace {

constexpr int iterations = 9;

struct EmbreeQuality {
    const char *name;
    RTCBuildQuality quality;
};
constexpr EmbreeQuality qualities[] = {
    {"low", RTC_BUILD_QUALITY_LOW}, {"medium", RTC_BUILD_QUALITY_MEDIUM}, {"high", RTC_BUILD_QUALITY_HIGH}};

Seconds time_embree(const test::Mesh &mesh, RTCBuildQuality quality) {
    const uint32_t threads = test::test_device().info().compute_units;
    test::EmbreeScene scene(mesh, fmt::format("threads={}", threads), quality, RTC_SCENE_FLAG_NONE);
    return time_of([&] { scene.commit(); });
}

/// The three numbers of every vertex or triangle.
template <typename Number, typename Three>
std::vector<Number> numbers_of(const std::vector<Three> &all) {
    std::vector<Number> numbers;
    for (const Three &three : all) {
        numbers.insert(numbers.end(), three.data(), three.data() + 3);
    }
    return numbers;
}

void build(benchmark::State &state, const std::string &name, BvhLayout layout) {
    const test::Mesh mesh = load_benchmark_mesh(name);
    DeviceContext &device = test::test_device();
    BvhBuildParameters parameters = BvhBuildParameters::for_device(device.info());
    parameters.layout = layout;
    BvhBuilder builder(device, parameters);
    const Buffer<float> positions(device, "positions", numbers_of<float>(mesh.positions));
    const Buffer<uint32_t> indices(device, "indices", numbers_of<uint32_t>(mesh.triangles));
    const BvhReport report = builder.build(positions, indices).report();  // the first launches compile

    std::vector<double> wall_seconds, ratios;
    std::array<std::vector<double>, std::size(qualities)> embree_wall_seconds;
    for (auto _ : state) {
        Seconds ours{}, medium{};
        std::vector<std::function<void()>> turns = {
            [&] { ours = time_of([&] { builder.build(positions, indices); }); }};
        for (size_t i = 0; i < std::size(qualities); ++i) {
            turns.emplace_back([&, i] {
                const Seconds seconds = time_embree(mesh, qualities[i].quality);
                embree_wall_seconds[i].push_back(seconds.wall);
                medium = qualities[i].quality == RTC_BUILD_QUALITY_MEDIUM ? seconds : medium;
            });
        }
        if (wall_seconds.size() % 2 == 1) {
            std::reverse(turns.begin(), turns.end());
        }
        for (const auto &turn : turns) {
            turn();
        }
        wall_seconds.push_back(ours.wall);
        ratios.push_back(medium.processor / ours.processor);
        state.SetIterationTime(ours.wall);
    }
    const auto triangles = static_cast<double>(mesh.triangles.size());
    const Interval ratio = median_interval(ratios);
    state.counters["triangles"] = triangles;
    state.counters["Mtris_s"] = 1e-6 * triangles / median(wall_seconds);
    for (size_t i = 0; i < std::size(qualities); ++i) {
        state.counters[fmt::format("embree_{}_ms", qualities[i].name)] = 1e3 * median(embree_wall_seconds[i]);
    }
    state.counters["ratio"] = ratio.value;
    state.counters["ratio_low"] = ratio.low;
    state.counters["ratio_high"] = ratio.high;
    state.counters["sah"] = report.sah_cost;
    state.counters["bytes"] = static_cast<double>(report.bytes) / triangles;
    state.counters["bytes_peak"] = static_cast<double>(report.bytes_peak) / triangles;
}

}  // namespace

void register_benchmarks() {
    for (const BenchmarkScene &scene : benchmark_scenes()) {
        for (const NamedBvhLayout &named : bvh_layouts) {
            const auto run = [name = scene.name, layout = named.layout](benchmark::State &state) {
                build(state, name, layout);
            };
            benchmark::RegisterBenchmark(fmt::format("{}/{}", scene.name, named.name).c_str(), run)
                ->Iterations(iterations)
                ->UseManualTime()
                ->Unit(benchmark::kMillisecond);
        }
    }
}

}  // namespace rtrays::benchmarks
