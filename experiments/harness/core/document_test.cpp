// SPDX-License-Identifier: MIT
// Tests of the curves in run.json that are computed from measurements.
#include "experiments/harness/core/document.h"

#include <gtest/gtest.h>

#include <cmath>

#include "renderer/base/error.h"

namespace rtrays {
namespace {

/// Returns ladders with MSE = scale(seed)^2 / spp + the noise of a reference.
std::vector<Repetition> power_law(double noise_mse) {
    std::vector<Repetition> repetitions;
    for (uint32_t seed = 1; seed <= 8; ++seed) {
        Repetition repetition;
        repetition.seed = seed;
        for (uint64_t spp : {1, 2, 4, 8, 16}) {
            const double scale = 1 + 0.01 * seed;
            const double mse = scale * scale / static_cast<double>(spp) + noise_mse;
            const double rmse = std::sqrt(mse);
            repetition.points.push_back({spp,
                                         0.5 * static_cast<double>(spp) * seed,
                                         static_cast<double>(spp),
                                         {10 * rmse, rmse, 0.5 * rmse, 2 * mse, mse}});
        }
        repetitions.push_back(repetition);
    }
    return repetitions;
}

TEST(Document, CurveHoldsMediansAndRawValues) {
    const auto curve = summarise_curve(power_law(0), 0);
    const auto &points = curve.at("points");
    ASSERT_EQ(points.size(), 5u);
    EXPECT_EQ(points[2].at("spp"), 4);
    EXPECT_DOUBLE_EQ(points[2].at("rmse"), 1.045 / 2);  // between seeds 4 and 5
    EXPECT_DOUBLE_EQ(points[2].at("seconds_device"), 2 * 4.5);
    EXPECT_EQ(points[2].at("repetitions").size(), 8u);
    EXPECT_EQ(points[2].at("repetitions")[7].at("seed"), 8);
    EXPECT_FALSE(points[4].at("noise_dominates"));
    EXPECT_NEAR(curve.at("slope").at("value"), -0.5, 1e-12);
    EXPECT_EQ(curve.at("slope").at("spp"), (nlohmann::json{1, 16}));
}

TEST(Document, CurveStopsWhereTheReferenceNoiseDominates) {
    // The noise exceeds 10 % of the MSE between 8 and 16 spp.
    const auto curve = summarise_curve(power_law(0.009), 0.009);
    EXPECT_FALSE(curve.at("points")[3].at("noise_dominates"));
    EXPECT_TRUE(curve.at("points")[4].at("noise_dominates"));
    EXPECT_EQ(curve.at("slope").at("spp"), (nlohmann::json{1, 8}));
    EXPECT_GT(curve.at("slope").at("value"), -0.5);  // flattened by the noise
    EXPECT_NEAR(curve.at("slope_unbiased").at("value"), -0.5, 1e-9);
}

TEST(Document, ATooNoisyReferenceIsAnError) {
    EXPECT_THROW(summarise_curve(power_law(0.5), 0.5), Error);
}

TEST(Document, RepetitionsRoundTrip) {
    const auto repetition = power_law(0.1)[3];
    const auto again = parse_repetition(nlohmann::json::parse(to_json(repetition).dump()));
    EXPECT_EQ(to_json(again), to_json(repetition));
}

/// Reads the text as a document and returns the message of the error.
std::string error_of(const std::string &text) {
    try {
        parse_document(text, "run.json");
    } catch (const Error &error) {
        EXPECT_EQ(error.exit_code(), ExitCode::bad_input);
        return error.what();
    }
    return "no error";
}

TEST(Document, AnIncompleteRunIsRefused) {
    EXPECT_NE(error_of(R"({"schema_version": 3})").find("missing key 'kind'"), std::string::npos);
    // JSON has no NaN, so it is written as null.
    const nlohmann::json run = {{"schema_version", std::nan("")}};
    EXPECT_NE(error_of(run.dump()).find("run.json"), std::string::npos) << error_of(run.dump());
}

}  // namespace
}  // namespace rtrays
