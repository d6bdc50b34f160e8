// SPDX-License-Identifier: MIT
// Tests of the verdicts of stability cases: planted errors are found, and expected images pass.
#include "experiments/harness/kinds/stability_comparison.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <functional>
#include <random>

#include "experiments/harness/kinds/stability_cases.h"

namespace rtrays {
namespace {

constexpr int size = 16;
constexpr double alpha = 1e-5;

Image filled(const std::function<double(int)> &value) {
    Image image = Image::rgb(size, size);
    for (const std::string &channel : rgb_names()) {
        for (int i = 0; i < size * size; ++i) {
            image.channel(channel)[static_cast<size_t>(i)] = static_cast<float>(value(i));
        }
    }
    return image;
}

const ExpectedImage one{filled([](int) { return 1.0; }), false};

/// Returns 32 batches with the pixel values draw(generator, pixel).
std::vector<Image> batches(const std::function<double(std::mt19937 &, int)> &draw) {
    std::mt19937 generator(1);
    std::vector<Image> images;
    for (int batch = 0; batch < 32; ++batch) {
        images.push_back(filled([&](int pixel) { return draw(generator, pixel); }));
    }
    return images;
}

/// Draws a value with mean 1 and a standard deviation of 10 %.
double noise(std::mt19937 &generator, int) {
    return std::normal_distribution<double>(1, 0.1)(generator);
}

TEST(Stability, PassesWhatIsAsExpected) {
    const StabilityTest test = test_stability(batches(noise), one, 0, 0.01, alpha);
    EXPECT_EQ(test.verdict, "ok");
    EXPECT_EQ(test.tests + test.undecided, 15u);  // four blocks and the image, three channels
    EXPECT_LT(test.difference.low, 0);
    EXPECT_GT(test.difference.high, 0);
    EXPECT_NEAR(test.mse, 0.01, 0.001);
}

TEST(Stability, FindsAPlantedBias) {
    const auto biased = [](std::mt19937 &generator, int pixel) {
        return 1.01 * noise(generator, pixel);
    };
    EXPECT_EQ(test_stability(batches(biased), one, 0, 0.01, alpha).verdict, "off");
    EXPECT_EQ(test_stability(batches(biased), one, 0.02, 0.01, alpha).verdict, "ok")
        << "within its bound";
}

TEST(Stability, FindsABiasThatTheMeanHides) {
    const auto tilted = [](std::mt19937 &generator, int pixel) {
        return noise(generator, pixel) * (pixel % size < 8 ? 0.98 : 1.02);
    };
    EXPECT_EQ(test_stability(batches(tilted), one, 0, 0.01, alpha).verdict, "off");
}

TEST(Stability, HasRoundingWithoutNoiseKeepToItsBound) {
    const auto rounded = [](std::mt19937 &, int) { return 1.000002; };
    EXPECT_EQ(test_stability(batches(rounded), one, 1e-5, 0.01, alpha).verdict, "ok");
    EXPECT_EQ(test_stability(batches(rounded), one, 1e-6, 0.01, alpha).verdict, "off");
}

TEST(Stability, DoesNotPassWhatItCannotTell) {
    EXPECT_EQ(test_stability(batches(noise), one, 0, 1e-5, alpha).verdict, "imprecise");
    // One batch of 32 has all the light.
    int drawn = 0;
    const auto rare = [&](std::mt19937 &, int) { return drawn++ < 3 * size * size ? 32.0 : 0.0; };
    EXPECT_EQ(test_stability(batches(rare), one, 0, 1e9, alpha).verdict, "undecided");
    const auto none = [](std::mt19937 &, int) { return 0.0; };
    EXPECT_EQ(test_stability(batches(none), one, 0, 1e9, alpha).verdict, "off");
}

TEST(Stability, CountsTheNoiseOfTheReference) {
    ExpectedImage noisy{filled([](int) { return 1.01; }), true};
    for (const std::string &channel : rgb_names("variance")) {
        noisy.mean.add_channel(channel).assign(size * size, 0.01f);
    }
    EXPECT_EQ(test_stability(batches(noise), noisy, 0, 0.1, alpha).verdict, "ok");
}

TEST(Stability, LeavesTheNoiseOfTheReferenceOutOfTheError) {
    std::mt19937 generator(2);
    std::normal_distribution<double> far(1, 0.3);
    ExpectedImage noisy{filled([&](int) { return far(generator); }), true};
    for (const std::string &channel : rgb_names("variance")) {
        noisy.mean.add_channel(channel).assign(size * size, 0.09f);
    }
    const StabilityTest test = test_stability(batches(noise), noisy, 0, 0.1, alpha);
    EXPECT_NEAR(test.mse, 0.01, 0.025);  // 768 reference values: 0.09 +- 5 %, tolerance 5 sigma
    EXPECT_NEAR(test.mse_expected, 0.09, 0.01);
}

StabilitySuite load(const std::string &name, const std::string &profile) {
    const std::string path = RTRAYS_EXPERIMENTS "/robustness/" + name + ".json";
    return read_stability(load_description(path, "stability.schema.json"), profile);
}

TEST(StabilityCases, AreReadWithTheirSweepsAndFormulas) {
    const StabilitySuite suite = load("stability", "quick");
    EXPECT_GT(suite.cases.size(), 100u);
    const auto found =
        std::find_if(suite.cases.begin(), suite.cases.end(),
                     [](const StabilityCase &c) { return c.name == "furnace rho=0.5"; });
    ASSERT_NE(found, suite.cases.end());
    EXPECT_EQ(found->expected, (std::array<double, 3>{2, 1, 0.5}));
    const StabilitySuite stiff = load("stiffness", "quick");
    EXPECT_TRUE(stiff.survey);
    EXPECT_EQ(stiff.cases.front().runs.front().name, "path_tracing implicit");
    EXPECT_EQ(stiff.cases.front().runs.front().settings.strategies, PathStrategies::implicit_only);
    for (const char *profile : {"ci", "full"}) {
        for (const StabilityCase &tested : load("stability", profile).cases) {
            EXPECT_NO_THROW(tested.scene.load()) << tested.name;
        }
    }
}

}  // namespace
}  // namespace rtrays
