// SPDX-License-Identifier: MIT
#include <benchmark/benchmark.h>

#include "experiments/benchmarks/benchmark_program.h"
#include "renderer/tests/bvh_tree.h"

int main(int argc, char **argv) {
    rtrays::benchmarks::register_benchmarks();
    benchmark::Initialize(&argc, argv);
    if (benchmark::ReportUnrecognizedArguments(argc, argv)) {
        return 2;
    }
    benchmark::AddCustomContext("device", rtrays::test::test_device().info().name);
    benchmark::RunSpecifiedBenchmarks();
    return 0;
}
