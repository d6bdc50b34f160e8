// SPDX-License-Identifier: MIT
// Planting errors, without a device: every planted error of the shipped gates still finds its place.
#include <gtest/gtest.h>

#include "experiments/gate_checks.h"
#include "renderer/base/error.h"
#include "renderer/device/source.h"

namespace rtrays {
namespace {

PlantedError error_with(const std::string &search, const std::string &replacement) {
    return {"test", {}, "kernels/test.cl", search, replacement};
}

TEST(Plant, ReplacesTheOneOccurrence) {
    EXPECT_EQ(plant(error_with("cos", "1"), "f * cos * Li"), "f * 1 * Li");
}

TEST(Plant, RefusesWhatWouldProveNothing) {
    EXPECT_THROW(plant(error_with("sin", "1"), "f * cos * Li"), Error);
    EXPECT_THROW(plant(error_with("cos", "1"), "cos * cos"), Error);
    EXPECT_THROW(plant(error_with("cos", "cos"), "f * cos"), Error);
}

TEST(Plant, ShippedErrorsFitTheShippedKernels) {
    const auto gate = load_gate(std::string(RTRAYS_EXPERIMENTS) + "/gate_path_tracing.json");
    for (const auto &error : gate.planted.errors) {
        EXPECT_NO_THROW(plant(error, device_source(error.file))) << error.name;
    }
}

}  // namespace
}  // namespace rtrays
