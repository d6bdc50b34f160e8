// SPDX-License-Identifier: MIT
// What the benchmark programs share: main.cpp runs what each of them registers.
#pragma once

#include <chrono>
#include <ctime>

namespace rtrays::benchmarks {

/// Registers the benchmarks of this program.
void register_benchmarks();

/// Seconds of one run: by the clock on the wall, and of processor by all threads of this process.
struct Seconds {
    double wall, processor;
};

template <typename Work>
Seconds time_of(const Work &work) {
    const auto start = std::chrono::steady_clock::now();
    const std::clock_t processor = std::clock();
    work();
    return {std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count(),
            static_cast<double>(std::clock() - processor) / CLOCKS_PER_SEC};
}

}  // namespace rtrays::benchmarks
