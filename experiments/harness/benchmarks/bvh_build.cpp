// SPDX-License-Identifier: MIT
// Benchmarks hierarchy builds by mesh: every builder and layout on the OpenCL device, and Embree's
// three qualities. It runs the turns of the experiment bvh_build.json, and the benchmark time is
// that of a turn. Counters, medians for each contestant: wall time in ms, and the speed relative to
// Embree's medium quality by the contest's clock.
#include <benchmark/benchmark.h>

#include <memory>

#include "experiments/harness/benchmarks/benchmark_program.h"
#include "experiments/harness/kinds/measurements/build_contest.h"

namespace rtrays::benchmarks {

void register_benchmarks(DeviceContext &device) {
    const auto builders = std::make_shared<Builders>(device);
    for (const std::string &mesh : benchmark_meshes()) {
        const auto run = [=](benchmark::State &state) {
            BuildContest build(*builders, mesh, 1024);
            take_turns(state, build.contest());
            for (const std::string &name : build.contest().names()) {
                state.counters[name + " ms"] = 1e3 * build.contest().wall_seconds(name).value;
                state.counters[name + " speed"] =
                    build.contest().speed_over(name, BuildContest::baseline).value;
            }
        };
        benchmark::RegisterBenchmark(mesh.c_str(), run)
            ->Iterations(turns)
            ->UseManualTime()
            ->Unit(benchmark::kMillisecond);
    }
}

}  // namespace rtrays::benchmarks
