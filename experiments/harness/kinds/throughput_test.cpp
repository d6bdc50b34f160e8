// SPDX-License-Identifier: MIT
// Tests of throughput: interleaved repetitions, and refusal under foreign load.
#include "experiments/harness/kinds/throughput.h"

#include <gtest/gtest.h>
#include <unistd.h>

#include <chrono>
#include <nlohmann/json.hpp>
#include <thread>

namespace rtrays {
namespace {

struct Fixture {
    std::string order;
    Contestant renderer = [this] { order += 'a'; };
    Contestant reference = [this] { order += 'b'; };
    ThroughputSettings settings;
};

TEST(Throughput, TurnsAreInterleaved) {
    Fixture f;
    f.settings.samples = 100;
    const auto result = measure_throughput(
        f.settings, f.renderer, f.reference,
        [] {
            return CpuUse{1, 0, 0};
        },
        [](int) {});
    EXPECT_TRUE(result.accepted);
    EXPECT_EQ(f.order, "abbaabbaabbaabbaab");
    EXPECT_GT(result.ratio.low, 0);
    EXPECT_LE(result.ratio.low, result.ratio.value);
}

TEST(Throughput, RatioIsThatOfTheTimes) {
    Fixture f;
    f.settings.samples = 1000;
    f.renderer = [] { std::this_thread::sleep_for(std::chrono::milliseconds(2)); };
    f.reference = [] { std::this_thread::sleep_for(std::chrono::milliseconds(20)); };
    const auto result = measure_throughput(
        f.settings, f.renderer, f.reference, [] { return CpuUse{}; }, [](int) {});
    EXPECT_GT(result.ratio.value, 2);
    EXPECT_LT(result.renderer.value, 1000 / 0.002);
    EXPECT_LT(result.reference.value, 1000 / 0.02);
}

TEST(Throughput, DisturbedTurnsAreRepeated) {
    Fixture f;
    int calls = 0;
    // `use_since` is called before and after each turn; every third turn is disturbed.
    const auto result = measure_throughput(
        f.settings, f.renderer, f.reference,
        [&] {
            return CpuUse{0.8, ++calls % 6 == 0 ? 0.2 : 0.05, 0};
        },
        [](int) {});
    EXPECT_TRUE(result.accepted);
    EXPECT_EQ(result.repetitions.size(), 13u);
}

TEST(Throughput, RefusedUnderLoad) {
    Fixture f;
    const auto result = measure_throughput(
        f.settings, f.renderer, f.reference,
        [] {
            return CpuUse{0.5, 0.05, 0.3};
        },
        [](int) {});
    EXPECT_FALSE(result.accepted);
    const auto json = to_json(result, f.settings);
    EXPECT_FALSE(json.contains("ratio"));
    EXPECT_NE(json.at("reason").get<std::string>().find("foreign load"), std::string::npos);
    EXPECT_EQ(json.at("repetitions").size(), 27u);
}

TEST(CpuMeter, SeesOwnWork) {
    CpuMeter meter;
    const auto until = std::chrono::steady_clock::now() + std::chrono::milliseconds(300);
    volatile double work = 0;
    while (std::chrono::steady_clock::now() < until) {
        work = work + 1;
    }
    const auto use = meter.use();
    EXPECT_GT(use.own,
              0.1 / static_cast<double>(sysconf(_SC_NPROCESSORS_ONLN)));  // a tenth of one core
    EXPECT_GE(use.foreign, 0);
    EXPECT_LE(use.own + use.foreign + use.steal, 1.3);  // tick counts are coarse
}

}  // namespace
}  // namespace rtrays
