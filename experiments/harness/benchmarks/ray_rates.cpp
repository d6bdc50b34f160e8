// SPDX-License-Identifier: MIT
// Benchmarks rays per second by mesh and kind of ray: every builder and layout on the OpenCL
// device, and Embree. It runs the turns of the experiment ray_rates.json, and the benchmark time is
// that of a turn. Counters, medians for each contestant: Mrays/s by wall time, and the speed
// relative to rtcIntersect1 or rtcOccluded1 by the contest's clock.
#include <benchmark/benchmark.h>

#include <memory>

#include "experiments/harness/benchmarks/benchmark_program.h"
#include "experiments/harness/kinds/measurements/ray_contest.h"

namespace rtrays::benchmarks {

namespace {

constexpr size_t ray_count = 256 * 256;

/// Returns a mesh with its hierarchies. Benchmarks run mesh by mesh, so the last one is kept.
const TracedMesh &loaded(DeviceContext &device, const std::string &mesh) {
    static std::unique_ptr<TracedMesh> last;
    if (!last || last->mesh().mesh.name != mesh) {
        last.reset();
        last = std::make_unique<TracedMesh>(device, mesh);
    }
    return *last;
}

}  // namespace

void register_benchmarks(DeviceContext &device) {
    for (const std::string &mesh : benchmark_meshes()) {
        for (const RayKind &kind : ray_kinds()) {
            const auto run = [&device, mesh, kind](benchmark::State &state) {
                RayContest rays(loaded(device, mesh), kind, ray_count);
                take_turns(state, rays.contest());
                for (const std::string &name : rays.contest().names()) {
                    state.counters[name + " Mrays/s"] =
                        rays.millions_of_rays() / rays.contest().wall_seconds(name).value;
                    state.counters[name + " speed"] =
                        rays.contest().speed_over(name, rays.baseline()).value;
                }
            };
            benchmark::RegisterBenchmark((mesh + "/" + kind.name).c_str(), run)
                ->Iterations(turns)
                ->UseManualTime()
                ->Unit(benchmark::kMillisecond);
        }
    }
}

}  // namespace rtrays::benchmarks
