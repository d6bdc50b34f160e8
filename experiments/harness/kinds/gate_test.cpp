// SPDX-License-Identifier: MIT
// Tests of the gate without a device: every planted error of the shipped files still fits its
// kernel, and slopes are judged correctly.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cmath>
#include <nlohmann/json.hpp>
#include <random>

#include "experiments/harness/kinds/gate_checks.h"
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
    for (const char *name : {"gate_cornell_box", "gate_mirror_ring"}) {
        const std::string path = fmt::format("{}/gates/{}.json", RTRAYS_EXPERIMENTS, name);
        const GateDescription gate = read_gate(load_description(path, "gate.schema.json"));
        for (const auto &error : gate.agreement->planted_errors) {
            EXPECT_NO_THROW(plant(error, device_source(error.file))) << error.name;
        }
        EXPECT_NO_THROW(require_plantable(gate.agreement->planted_errors));
    }
    const std::string path = RTRAYS_EXPERIMENTS "/gates/algorithms.json";
    for (const Json &json :
         load_description(path, "agreement.schema.json").json.at("planted_errors")) {
        const PlantedError error = read_planted_error(json);
        EXPECT_NO_THROW(planted_settings(error)) << error.name;
    }
}

TEST(Plant, ErrorsThatCannotBePlantedAreFoundBeforehand) {
    const std::string file = "kernels/light/light.h";
    EXPECT_THROW(require_plantable({{"test", {}, file, "this text does not occur", "1"}}), Error);
    EXPECT_THROW(require_plantable({{"test", {}, "kernels/missing.h", "cos", "1"}}), Error);
}

/// Returns the errors of 16 renders at 4, 16 and 64 spp: 0.1 (spp / 4)^slope. The squares scatter
/// with the relative deviation `scatter` at 4 spp, half of it at 16 and a quarter at 64.
StageErrors made_up_errors(double slope, double scatter, uint64_t random_seed) {
    std::mt19937_64 engine(random_seed);
    std::normal_distribution<double> noise;
    StageErrors errors;
    for (int k = 0; k < 16; ++k) {
        const double deviation = noise(engine);
        for (const uint64_t spp : {4u, 16u, 64u}) {
            const double steps = std::log2(static_cast<double>(spp) / 4) / 2;
            const double spread = scatter * std::pow(0.5, steps);
            // Log-normal with mean 1.
            const double square =
                std::exp(spread * (deviation + 0.3 * noise(engine)) - 0.5 * spread * spread * 1.09);
            errors[spp].push_back(0.1 * std::pow(4.0, slope * steps) * std::sqrt(square));
        }
    }
    return errors;
}

TEST(SlopeOfTheGate, MissesWhatDoesNotFallAsItShould) {
    const StageErrors good = made_up_errors(-0.5, 0.02, 1);
    const CheckLine passed = check_slope("good", good, good, {});
    EXPECT_TRUE(passed.passed);
    EXPECT_NE(passed.text.find("] contains -1/2"), std::string::npos) << passed.text;
    const CheckLine failed = check_slope("shallow", made_up_errors(-0.48, 0.02, 2), good, {});
    EXPECT_FALSE(failed.passed);
    EXPECT_NE(failed.text.find("does not contain -1/2"), std::string::npos) << failed.text;
    EXPECT_FALSE(check_slope("steep", made_up_errors(-0.52, 0.02, 3), good, {}).passed);
}

TEST(SlopeOfTheGate, TakesOffTheNoiseOfTheReference) {
    StageErrors noisy = made_up_errors(-0.5, 0.02, 1);
    Reference reference;
    reference.noise_mse = 1e-5;
    for (auto &entry : noisy) {
        for (double &error : entry.second) {
            error = std::hypot(error, std::sqrt(reference.noise_mse));
        }
    }
    EXPECT_FALSE(check_slope("noisy", noisy, noisy, {}).passed);
    EXPECT_TRUE(check_slope("noisy", noisy, noisy, reference).passed);
}

TEST(SlopeOfTheGate, IsNotJudgedWhereTheBaselineScattersTooMuch) {
    const StageErrors heavy = made_up_errors(-0.5, 1.5, 4), shallow = made_up_errors(-0.3, 0.02, 5);
    const CheckLine excused = check_slope("heavy", shallow, heavy, {});
    EXPECT_TRUE(excused.passed);
    EXPECT_NE(excused.text.find("not judged"), std::string::npos) << excused.text;
    EXPECT_FALSE(check_slope("light", shallow, made_up_errors(-0.5, 0.02, 6), {}).passed);
}

}  // namespace
}  // namespace rtrays
