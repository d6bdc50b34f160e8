// SPDX-License-Identifier: MIT
// Main function of the benchmark programs.
#include <benchmark/benchmark.h>

#include "experiments/harness/benchmarks/benchmark_program.h"
#include "renderer/base/error.h"

namespace {

rtrays::ExitCode run(int argc, char **argv) {
    rtrays::DeviceContext device;
    rtrays::benchmarks::register_benchmarks(device);
    benchmark::Initialize(&argc, argv);
    if (benchmark::ReportUnrecognizedArguments(argc, argv)) {
        return rtrays::ExitCode::bad_input;
    }
    benchmark::AddCustomContext("device", device.info().name);
    benchmark::RunSpecifiedBenchmarks();
    return rtrays::ExitCode::ok;
}

}  // namespace

int main(int argc, char **argv) {
    return rtrays::run_main("benchmark", [&] { return run(argc, argv); });
}
