// SPDX-License-Identifier: MIT
// Tests whether two independent noisy images estimate the same picture: tests per block and of the
// mean, and a statement of equivalence.
#pragma once

#include <array>
#include <cstddef>
#include <functional>
#include <string>
#include <vector>

#include "experiments/harness/core/statistics.h"
#include "renderer/base/image.h"

namespace rtrays {

enum class Equivalence { equivalent, different, undecided };

const char *to_string(Equivalence equivalence);

struct Agreement {
    size_t tests = 0;      ///< channels x (blocks + full image), without the undecided ones
    size_t undecided = 0;  ///< excluded because the batches are too skewed for a t test
    size_t rejected = 0;   ///< tests with adjusted p <= alpha
    /// Tests that rejected at first, but not with fresh batches or not in both halves.
    size_t unconfirmed = 0;
    double largest_z = 0;  ///< largest |z| of all tests
    /// Channel and block corner of the largest |z|: "R (16, 0)" or "R whole image".
    std::string largest_z_at;
    double smallest_adjusted_p = 1;  ///< by Holm over all tests
    /// Difference of the means over pixels and channels, divided by the reference's mean.
    Interval relative_difference;
    Equivalence equivalence = Equivalence::undecided;

    bool agrees() const { return rejected == 0; }
};

struct AgreementPolicy {
    int block_size = 16;              ///< pixels, at least 1
    double alpha = 0.01;              ///< family-wise level, by Holm
    double confidence = 0.99;         ///< of the interval of the relative difference
    double equivalence_limit = 1e-3;  ///< of the relative difference
    /// Largest absolute skewness of the batches at which a block is tested. Rare bright paths that
    /// most batches lack make a block look more certain than it is. This is true even after the
    /// first-order effect of skewness is removed. 32 normal batches exceed the limit in one case of
    /// 800.
    double largest_skewness = 1.5;
};

/// Renders batches with seeds that the tested batches do not use.
using FreshBatches = std::function<std::vector<Image>()>;

/// Two images with equal sample counts and different seeds. Their mean is tested.
using Halves = std::array<Image, 2>;

/// Tests whether an image agrees with a reference. The two must share no samples.
///
/// Without batches, both images have the layers "variance.*" (variance of the mean of each pixel).
/// Pixels are then assumed independent, which is true of algorithms without splats. For algorithms
/// with splats, pass `batches`: images of independent samples with equal sample counts. Their
/// scatter gives the variance of each block.
///
/// If all batches lack the rare bright paths of a dark block, they agree with each other, are not
/// conspicuously skewed, and reject. Rejections are therefore confirmed. `fresh` is called only if
/// a test rejects. The rejected tests are then decided by the fresh batches alone, with Holm's
/// adjustment over these tests. With halves, a rejection of the means stands only if the first
/// halves and the second halves both reject the test on the same side. Holm's adjustment then uses
/// the larger p of both. A single rare path in one half of the image or the reference is thus no
/// rejection.
///
/// Channels of a pixel are correlated, so each channel is tested separately. The standard error of
/// the mean over channels is bounded by the mean of their standard errors (perfect correlation).
/// The standard error includes the rounding of float32 pixels, so that no noise-free block divides
/// by zero. Throws `Error` (bad input) if sizes differ, a variance layer is missing, a value is not
/// finite or the reference is black.
Agreement test_agreement(const Image &image, const Image &reference,
                         const AgreementPolicy &policy = {});
Agreement test_agreement(const std::vector<Image> &batches, const Image &reference,
                         const AgreementPolicy &policy = {}, const FreshBatches &fresh = {});
Agreement test_agreement(const Halves &image, const Halves &reference,
                         const AgreementPolicy &policy = {});
Agreement test_agreement(const std::vector<Image> &batches, const std::vector<Image> &others,
                         const AgreementPolicy &policy = {});

}  // namespace rtrays
