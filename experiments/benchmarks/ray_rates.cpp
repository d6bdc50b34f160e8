// SPDX-License-Identifier: MIT
// Rays per second through the hierarchy on the OpenCL device, by every builder and layout, and
// through Embree's, by mesh and kind of ray: the turns of the experiment ray_rates.json. The time
// is that of a turn; counters, by contestant: Mrays/s by wall time, and how many times faster than
// rtcIntersect1 or rtcOccluded1 by processor time (medians).
#include <benchmark/benchmark.h>

#include <memory>

#include "experiments/benchmarks/benchmark_program.h"
#include "experiments/hierarchy/ray_contest.h"

namespace rtrays::benchmarks {

namespace {

constexpr size_t ray_count = 256 * 256;

/// Benchmarks run mesh by mesh: the last is kept.
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
