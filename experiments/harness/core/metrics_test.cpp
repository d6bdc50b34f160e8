// SPDX-License-Identifier: MIT
// Tests the metrics against closed forms, and the agreement tests on synthetic images.
#include "experiments/harness/core/metrics.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <random>

#include "experiments/harness/core/agreement.h"
#include "experiments/harness/core/blocks.h"
#include "renderer/base/error.h"
#include "renderer/testing/errors.h"

namespace rtrays {
namespace {

Image constant(int width, int height, float value) {
    Image image = Image::rgb(width, height);
    for (const auto &name : rgb_names()) {
        std::fill(image.channel(name).begin(), image.channel(name).end(), value);
    }
    return image;
}

/// Returns an image of mean `truth` * (1 + bias) with Gaussian noise of standard deviation `sigma`
/// in every pixel and channel.
Image noisy(double truth, double bias, double sigma, uint64_t seed, int size = 64) {
    std::mt19937_64 engine(seed);
    std::normal_distribution<double> noise;
    Image image = constant(size, size, 0);
    for (const auto &name : rgb_names()) {
        for (float &value : image.channel(name)) {
            value = static_cast<float>(truth * (1 + bias) + sigma * noise(engine));
        }
    }
    for (const auto &name : rgb_names("variance")) {
        auto &values = image.add_channel(name);
        std::fill(values.begin(), values.end(), static_cast<float>(sigma * sigma));
    }
    return image;
}

TEST(Metrics, ConstantDifferenceHasTheClosedForm) {
    const auto metrics = compute_metrics(constant(8, 4, 1.5f), constant(8, 4, 1.0f));
    EXPECT_DOUBLE_EQ(metrics.l2, std::sqrt(96 * 0.25));
    EXPECT_DOUBLE_EQ(metrics.rmse, 0.5);
    EXPECT_DOUBLE_EQ(metrics.mse, 0.25);
    EXPECT_DOUBLE_EQ(metrics.mae, 0.5);
    EXPECT_NEAR(metrics.relmse, 0.25 / 1.01, 1e-15);
}

TEST(Metrics, OneChannelOfOnePixel) {
    Image image = constant(2, 1, 2.0f);
    image.channel("G")[1] = -1.0f;
    const auto metrics = compute_metrics(image, constant(2, 1, 2.0f));
    EXPECT_DOUBLE_EQ(metrics.l2, 3.0);
    EXPECT_DOUBLE_EQ(metrics.mae, 0.5);
    EXPECT_DOUBLE_EQ(metrics.relmse, 9.0 / 4.01 / 6);
}

TEST(Metrics, ClippedValuesAreThoseOfADisplay) {
    EXPECT_DOUBLE_EQ(compute_metrics(constant(8, 4, 18), constant(8, 4, 1)).mse_clipped, 0);
    EXPECT_DOUBLE_EQ(compute_metrics(constant(8, 4, 18), constant(8, 4, 0.5f)).mse_clipped, 0.25);
    EXPECT_DOUBLE_EQ(compute_metrics(constant(8, 4, 0.25f), constant(8, 4, 3)).mse_clipped, 0.5625);
    EXPECT_DOUBLE_EQ(compute_metrics(constant(8, 4, -1), constant(8, 4, 0)).mse_clipped, 1);
}

TEST(Metrics, BlackReferencePixelStaysFinite) {
    EXPECT_DOUBLE_EQ(compute_metrics(constant(1, 1, 0.1f), constant(1, 1, 0)).relmse,
                     static_cast<double>(0.1f) * 0.1f / 0.01);
}

TEST(Metrics, RejectsOtherSizesAndNonFiniteValues) {
    EXPECT_THROW(compute_metrics(constant(2, 2, 1), constant(2, 1, 1)), Error);
    Image broken = constant(2, 2, 1);
    broken.channel("B")[3] = std::numeric_limits<float>::quiet_NaN();
    EXPECT_THROW(compute_metrics(broken, constant(2, 2, 1)), Error);
}

// Crops of one picture: pixels of equal index are different places.
TEST(Metrics, RejectsOtherDataWindows) {
    const Image a = constant(8, 8, 1);
    Image b = constant(8, 8, 1);
    b.move_to(4, 4);
    const std::string message = "(0, 0) to (7, 7) and (4, 4) to (11, 11)";
    expect_input_error(message, [&] { compute_metrics(a, b); });
    expect_input_error(message, [&] { average_images({a, b}); });
    expect_input_error(message, [&] { average_runs({a, b}); });
    expect_input_error(message, [&] { combine_halves(a, b); });
    EXPECT_EQ(compute_metrics(b, b).mse, 0);
    for (const Image &mean : {average_images({b, b}), average_runs({b, b}), downsample(b, 1)}) {
        EXPECT_EQ(mean.left(), 4);
        EXPECT_EQ(mean.top(), 4);
    }
    EXPECT_EQ(downsample(b, 2).left(), 2);
    expect_input_error("(4, 4) to (11, 11)", [&] { downsample(b, 8); });
}

TEST(Metrics, HalvesGiveTheNoiseOfTheirAverage) {
    const double truth = 1, sigma = 0.2;
    const auto reference =
        combine_halves(noisy(truth, 0, sigma, 1, 256), noisy(truth, 0, sigma, 2, 256));
    EXPECT_NEAR(reference.noise_mse, sigma * sigma / 2, 0.01 * sigma * sigma / 2);
    // The estimate equals the actual error of the average, and so does the variance layer.
    const double actual = compute_metrics(reference.image, constant(256, 256, 1)).mse;
    EXPECT_NEAR(reference.noise_mse, actual, 0.02 * actual);
    EXPECT_NEAR(reference.image.channel("variance.R")[7], sigma * sigma / 2, 1e-6);
}

TEST(Metrics, UnbiasedErrorRemovesTheReferenceNoise) {
    const double sigma = 0.3, reference_sigma = 0.15;
    const auto reference =
        combine_halves(noisy(1, 0, reference_sigma, 3, 256), noisy(1, 0, reference_sigma, 4, 256));
    const double mse = compute_metrics(noisy(1, 0, sigma, 5, 256), reference.image).mse;
    EXPECT_GT(mse, sigma * sigma * 1.08);
    EXPECT_NEAR(unbiased_mse(mse, reference.noise_mse), sigma * sigma, 0.02 * sigma * sigma);
    EXPECT_TRUE(noise_dominates(mse, reference.noise_mse));
    EXPECT_FALSE(noise_dominates(1.0, 0.1));
    EXPECT_TRUE(noise_dominates(std::numeric_limits<double>::quiet_NaN(), 0.1));
}

TEST(Metrics, AveragingAddsSamplesAndDividesVariance) {
    Image a = noisy(1, 0, 0.5, 6), b = noisy(1, 0, 0.5, 7);
    a.add_channel("samples").assign(a.pixel_count(), 16.0f);
    b.add_channel("samples").assign(b.pixel_count(), 16.0f);
    const Image mean = average_images({a, b});
    EXPECT_FLOAT_EQ(mean.channel("samples")[0], 32.0f);
    EXPECT_FLOAT_EQ(mean.channel("variance.G")[5], 0.125f);
    EXPECT_FLOAT_EQ(mean.channel("R")[9], (a.channel("R")[9] + b.channel("R")[9]) / 2);
}

TEST(Metrics, BatchesAreWhatTheirMeansTell) {
    std::vector<Image> batches, means;
    for (uint64_t n = 1; n <= 4; ++n) {
        batches.push_back(noisy(1, 0, 10, n, 8));
        means.push_back(average_images(batches));
        const Image batch = last_batch(n > 1 ? means[n - 2] : Image(), means.back(), n);
        for (const std::string &name : rgb_names()) {
            for (size_t i = 0; i < batch.pixel_count(); ++i) {
                EXPECT_NEAR(batch.channel(name)[i], batches.back().channel(name)[i], 1e-5f);
            }
        }
    }
}

TEST(Metrics, DownsamplingAveragesSquares) {
    Image image = constant(4, 2, 0);
    for (size_t i = 0; i < 8; ++i) {
        image.channel("R")[i] = static_cast<float>(i);
    }
    const Image small = downsample(image, 2);
    EXPECT_EQ(small.width(), 2);
    EXPECT_EQ(small.height(), 1);
    EXPECT_FLOAT_EQ(small.channel("R")[0], (0 + 1 + 4 + 5) / 4.0f);
    EXPECT_FLOAT_EQ(small.channel("R")[1], (2 + 3 + 6 + 7) / 4.0f);
    EXPECT_FLOAT_EQ(downsample(noisy(1, 0, 0.4, 8), 4).channel("variance.B")[0], 0.01f);
    EXPECT_THROW(downsample(image, 3), Error);
}

TEST(Agreement, RejectsATrueHypothesisAtMostAtItsLevel) {
    int rejected = 0;
    const int runs = 500;
    for (int i = 0; i < runs; ++i) {
        const auto seed = static_cast<uint64_t>(2 * i);
        rejected +=
            test_agreement(noisy(1, 0, 0.1, seed), noisy(1, 0, 0.1, seed + 1)).agrees() ? 0 : 1;
    }
    // The family-wise level is 1 %, and 12 of 500 is the 99.9 % quantile of the binomial.
    EXPECT_LE(rejected, 12);
}

/// Returns an image like `noisy` whose variances are estimates from two values per pixel.
Image roughly_known(double truth, double sigma, uint64_t seed) {
    const Image a = noisy(truth, 0, sigma * std::sqrt(2.0), seed),
                b = noisy(truth, 0, sigma * std::sqrt(2.0), seed + 1);
    Image image = constant(a.width(), a.height(), 0);
    for (size_t c = 0; c < 3; ++c) {
        std::vector<float> &variances = image.add_channel(rgb_names("variance")[c]);
        for (size_t i = 0; i < image.pixel_count(); ++i) {
            const float x = a.channel(rgb_names()[c])[i], y = b.channel(rgb_names()[c])[i];
            image.channel(rgb_names()[c])[i] = (x + y) / 2;
            variances[i] = (x - y) * (x - y) / 4;
        }
    }
    image.attributes()["rtrays:varianceFreedom"] = 1;
    return image;
}

// Variances of pixels with one degree of freedom make those of small blocks uncertain, too.
TEST(Agreement, CountsTheDegreesOfFreedomOfPixels) {
    AgreementPolicy small;
    small.block_size = 4;
    int rejected = 0, rejected_as_exact = 0;
    for (uint64_t i = 0; i < 500; ++i) {
        Image a = roughly_known(1, 0.1, 4 * i), b = roughly_known(1, 0.1, 4 * i + 2);
        rejected += test_agreement(a, b, small).agrees() ? 0 : 1;
        a.attributes().clear();
        b.attributes().clear();
        rejected_as_exact += test_agreement(a, b, small).agrees() ? 0 : 1;
    }
    EXPECT_LE(rejected, 12) << "the 99.9 % quantile at the level of 1 %";
    EXPECT_GT(rejected_as_exact, 24) << "without the degrees of freedom";

    Image four = Image::rgb(2, 2);
    for (const std::string &name : rgb_names("variance")) {
        four.add_channel(name) = {3, 0, 0, 0};
    }
    four.attributes()["rtrays:varianceFreedom"] = 1;
    EXPECT_EQ(sums_by_layer(four, 0, 2).front().freedom, 1) << "one pixel alone";
    four.channel("variance.R") = {3, 3, 3, 3};
    EXPECT_EQ(sums_by_layer(four, 0, 2).front().freedom, 3 * 4 - 2);
}

TEST(Agreement, FindsAHalfPercentBias) {
    // The standard error of the mean difference per channel is sqrt(2) 0.05 / 64 = 0.0011. The bias
    // is 4.5 standard errors.
    int found = 0;
    for (uint64_t i = 0; i < 100; ++i) {
        found +=
            test_agreement(noisy(1, 0.005, 0.05, 1000 + i), noisy(1, 0, 0.05, 2000 + i)).agrees()
                ? 0
                : 1;
    }
    EXPECT_GE(found, 95);
}

TEST(Agreement, FindsALocalErrorThatTheMeanHides) {
    Image image = noisy(1, 0, 0.02, 9);
    for (size_t i = 0; i < 16 * 64; ++i) {  // a bright and a dark block leave the mean unchanged
        const size_t x = i % 64;
        image.channel("R")[i] += x < 16 ? 0.02f : x < 32 ? -0.02f : 0.0f;
    }
    const auto agreement = test_agreement(image, noisy(1, 0, 0.02, 10));
    EXPECT_EQ(agreement.rejected, 2u);
    EXPECT_EQ(agreement.tests, 3u * 17u);
    EXPECT_TRUE(agreement.largest_z_at == "R (0, 0)" || agreement.largest_z_at == "R (16, 0)")
        << agreement.largest_z_at;
}

TEST(Agreement, StatesEquivalenceOnlyWithEnoughSamples) {
    EXPECT_EQ(test_agreement(noisy(1, 0, 0.5, 11), noisy(1, 0, 0.5, 12)).equivalence,
              Equivalence::undecided);
    EXPECT_EQ(test_agreement(noisy(1, 0, 0.01, 11), noisy(1, 0, 0.01, 12)).equivalence,
              Equivalence::equivalent);
    EXPECT_EQ(test_agreement(noisy(1, 0.01, 0.01, 11), noisy(1, 0, 0.01, 12)).equivalence,
              Equivalence::different);
}

TEST(Agreement, NoiseFreeBlocksAreComparedToRounding) {
    Image light = noisy(15, 0, 0, 1), same = noisy(15, 0, 0, 2);
    light.channel("R")[0] = std::nextafter(15.0f, 16.0f);
    EXPECT_TRUE(test_agreement(light, same).agrees());
    EXPECT_FALSE(test_agreement(noisy(15, 1e-5, 0, 1), same).agrees());
}

TEST(AverageRuns, EstimatesTheVarianceOfTheMean) {
    std::vector<Image> runs;
    for (uint64_t seed = 0; seed < 16; ++seed) {
        runs.push_back(noisy(2, 0, 0.3, 500 + seed));
    }
    const Image average = average_runs(runs);
    double variance = 0;
    for (const float value : average.channel("variance.G")) {
        variance += static_cast<double>(value) / static_cast<double>(average.pixel_count());
    }
    // 4096 pixels with 15 degrees of freedom: relative standard error sqrt(2 / 61440) = 0.6 %.
    EXPECT_NEAR(variance, 0.3 * 0.3 / 16, 5 * 0.006 * 0.3 * 0.3 / 16);
    EXPECT_TRUE(test_agreement(average, noisy(2, 0, 0.05, 600)).agrees());
    EXPECT_THROW(average_runs({runs[0]}), Error);
    EXPECT_THROW(average_runs({runs[0], constant(8, 8, 2)}), Error);
}

/// Returns 32 images whose mean has the standard deviation `sigma`.
std::vector<Image> noisy_batches(double bias, double sigma, uint64_t seed) {
    std::vector<Image> batches;
    for (uint64_t i = 0; i < 32; ++i) {
        batches.push_back(noisy(1, bias, sigma * std::sqrt(32.0), seed + i));
    }
    return batches;
}

TEST(Agreement, FreshBatchesConfirmWhatRejects) {
    const Image reference = noisy(1, 0, 0.01, 7);
    int asked = 0;
    const auto fresh = [&](double bias) {
        return [&, bias] {
            ++asked;
            return noisy_batches(bias, 0.03, 300);
        };
    };
    const std::vector<Image> clean = noisy_batches(0, 0.05, 100),
                             dark = noisy_batches(-0.02, 0.005, 100);
    EXPECT_TRUE(test_agreement(clean, reference, {}, fresh(-0.02)).agrees());
    EXPECT_EQ(asked, 0) << "no test rejects";

    const Agreement alone = test_agreement(dark, reference);
    EXPECT_EQ(alone.rejected, 51u);
    const Agreement by_chance = test_agreement(dark, reference, {}, fresh(0));
    EXPECT_EQ(asked, 1);
    EXPECT_EQ(by_chance.rejected, 0u);
    EXPECT_EQ(by_chance.unconfirmed, 51u);
    EXPECT_EQ(by_chance.tests, 51u);
    EXPECT_LT(by_chance.largest_z, 5);
    const Agreement wrong = test_agreement(dark, reference, {}, fresh(-0.02));
    EXPECT_EQ(wrong.rejected, 51u);
    EXPECT_EQ(wrong.unconfirmed, 0u);
}

TEST(Agreement, CountsWhatBothHalvesReject) {
    const auto halves = [](double bias_a, double bias_b, uint32_t seed) {
        return Halves{noisy(1, bias_a, 0.05, seed), noisy(1, bias_b, 0.05, seed + 1)};
    };
    const Halves reference = halves(0, 0, 30);
    EXPECT_TRUE(test_agreement(halves(0, 0, 10), reference).agrees());

    const Agreement one = test_agreement(halves(0.1, 0, 10), reference);
    EXPECT_EQ(one.rejected, 0u);
    EXPECT_GT(one.unconfirmed, 40u);
    EXPECT_EQ(one.tests, 51u);
    const Agreement opposite = test_agreement(halves(0.2, -0.1, 10), reference);
    EXPECT_EQ(opposite.rejected, 0u);
    EXPECT_GT(opposite.unconfirmed, 40u);

    const Agreement both = test_agreement(halves(0.05, 0.05, 10), reference);
    EXPECT_EQ(both.rejected, 51u);
    EXPECT_EQ(both.unconfirmed, 0u);
    EXPECT_NEAR(both.relative_difference.value, 0.05, 0.002);
}

TEST(Agreement, OfBatchesFindsABiasAndNothingElse) {
    const Image reference = noisy(1, 0, 0.01, 7);
    const Agreement clean = test_agreement(noisy_batches(0, 0.05, 100), reference);
    EXPECT_TRUE(clean.agrees());
    EXPECT_EQ(clean.tests + clean.undecided, 51u);
    EXPECT_EQ(clean.undecided, 0u);
    EXPECT_FALSE(test_agreement(noisy_batches(0.02, 0.05, 200), reference).agrees());
    EXPECT_TRUE(test_agreement(noisy_batches(0, 0.05, 100), noisy_batches(0, 0.05, 300)).agrees());
    EXPECT_FALSE(
        test_agreement(noisy_batches(0, 0.05, 100), noisy_batches(0.02, 0.05, 400)).agrees());
}

// The batches are log-normal with mean 1 and median 1/4. Most estimates are too low and have too
// small intervals.
TEST(Agreement, LeavesBatchesUndecidedThatAreTooSkewed) {
    const Image reference = noisy(1, 0, 0.001, 7, 16);
    int rejected = 0, decided = 0;
    const double spread = std::sqrt(2 * std::log(4.0));
    std::mt19937_64 engine(5);
    std::lognormal_distribution<float> brightness(static_cast<float>(-spread * spread / 2),
                                                  static_cast<float>(spread));
    for (int run = 0; run < 500; ++run) {
        std::vector<Image> batches;
        for (int i = 0; i < 32; ++i) {
            batches.push_back(constant(16, 16, brightness(engine)));
        }
        const Agreement agreement = test_agreement(batches, reference);
        rejected += agreement.agrees() ? 0 : 1;
        decided += agreement.undecided == 0 ? 1 : 0;
    }
    EXPECT_LE(rejected, 12) << "the 99.9 % quantile of the binomial";
    EXPECT_LT(decided, 100);
}

// The batches are exponential. Student's t alone rejects 90 of these runs, but 5 are expected.
TEST(Agreement, OfSkewedBatchesRejectsFewMoreThanItsLevel) {
    AgreementPolicy pixels;
    pixels.block_size = 1;
    const Image reference = noisy(1, 0, 1e-4, 7, 4);
    std::mt19937_64 engine(6);
    std::exponential_distribution<float> brightness(1);
    int rejected = 0;
    for (int run = 0; run < 500; ++run) {
        std::vector<Image> batches(32, constant(4, 4, 0));
        for (Image &batch : batches) {
            for (const std::string &channel : rgb_names()) {
                for (float &value : batch.channel(channel)) {
                    value = brightness(engine);
                }
            }
        }
        rejected += test_agreement(batches, reference, pixels).agrees() ? 0 : 1;
    }
    EXPECT_LE(rejected, 25);
}

TEST(Agreement, NeedsVarianceLayers) {
    EXPECT_THROW(test_agreement(constant(16, 16, 1), noisy(1, 0, 1, 1, 16)), Error);
}

}  // namespace
}  // namespace rtrays
