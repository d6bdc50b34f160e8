// SPDX-License-Identifier: MIT
// Building the hierarchy by every builder and layout on the OpenCL device and by Embree's three
// qualities, by mesh: the turns of the experiment bvh_build.json. The time is that of a turn;
// counters, by contestant: ms by wall time, and how many times faster than Embree's medium quality
// by processor time (medians).
#include <benchmark/benchmark.h>

#include <memory>

#include "experiments/benchmarks/benchmark_program.h"
#include "experiments/hierarchy/build_contest.h"

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
