// SPDX-License-Identifier: MIT
// Common part of the benchmark programs: main.cpp runs the benchmarks that each program registers.
#pragma once

#include <benchmark/benchmark.h>

#include "experiments/harness/core/contest.h"
#include "experiments/harness/models/meshes.h"
#include "renderer/device/context.h"

namespace rtrays::benchmarks {

/// Registers the benchmarks of this program. `device` must outlive them.
void register_benchmarks(DeviceContext &device);

constexpr int turns = 9;

/// Returns all meshes except the largest, which take minutes. The full profiles of the experiments
/// measure those.
inline std::vector<std::string> benchmark_meshes() {
    std::vector<std::string> meshes = measured_meshes();
    meshes.erase(std::remove_if(meshes.begin(), meshes.end(),
                                [](const std::string &name) {
                                    return name.rfind("san_miguel", 0) == 0 ||
                                           name == "cloth_ball_next";
                                }),
                 meshes.end());
    return meshes;
}

/// Runs one turn of the contest for each iteration.
inline void take_turns(benchmark::State &state, Contest &contest) {
    for (auto _ : state) {
        state.SetIterationTime(time_of([&] { contest.turn(); }).wall);
    }
}

}  // namespace rtrays::benchmarks
