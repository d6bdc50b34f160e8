// SPDX-License-Identifier: MIT
// Whether two independent noisy images estimate the same picture: z tests per block and on the
// mean, and a statement of equivalence.
#pragma once

#include <array>
#include <cstddef>
#include <functional>
#include <string>
#include <vector>

#include "experiments/statistics.h"
#include "renderer/base/image.h"

namespace rtrays {

enum class Equivalence { equivalent, different, undecided };

const char *to_string(Equivalence equivalence);

struct Agreement {
    size_t tests = 0;      ///< channels x (blocks + whole image), less those undecided
    size_t undecided = 0;  ///< left out: the batches are too skewed for a t test
    size_t rejected = 0;   ///< tests with adjusted p <= alpha
    size_t unconfirmed =
        0;  ///< tests that rejected at first, and not again with fresh batches or in both halves
    double largest_z = 0;  ///< largest |z| of all tests
    std::string
        largest_z_at;  ///< its channel and the corner of its block, or "whole image"; "R (16, 0)"
    double smallest_adjusted_p = 1;  ///< Holm over all tests
    Interval
        relative_difference;  ///< of the mean over pixels and channels, over the reference's mean
    Equivalence equivalence = Equivalence::undecided;

    bool agrees() const { return rejected == 0; }
};

struct AgreementPolicy {
    int block_size = 16;              ///< pixels, at least 1
    double alpha = 0.01;              ///< family-wise, Holm
    double confidence = 0.99;         ///< of the interval of the mean difference
    double equivalence_limit = 1e-3;  ///< of the relative difference of the mean
    /// Of batches. Rare bright paths that most batches lack make a block look more certain than it
    /// is, even after the tests have taken off the first-order effect of skewness; 32 normal
    /// batches exceed this in one case of 800.
    double largest_skewness = 1.5;
};

/// Batches of other seeds than those tested.
using FreshBatches = std::function<std::vector<Image>()>;

/// Two images of equal sample count and other seeds, whose mean is tested.
using Halves = std::array<Image, 2>;

/// Both images carry "variance.*" (variance of the mean of each pixel) and share no samples; pixels
/// are taken as independent, which holds for algorithms without splats. For those with: `batches`,
/// images of independent samples, as many each, whose scatter gives the variance of every block as
/// a whole.
///
/// Batches that all lack the rare bright paths of a dark block agree with each other, are no more
/// skewed than others, and reject. With `fresh`, which is asked only then, a rejection stands where
/// these batches reject the same test again (Holm over those asked again); the others are as the
/// fresh batches have them. With halves, a rejection of their means stands where the first halves
/// and the second ones both reject the same test on the same side (Holm over those asked again, of
/// the larger p of both): one rare path that one half met, or one of a reference, does not.
///
/// Channels of a pixel are correlated, so each channel is tested alone, and the standard error of
/// the mean over channels is bounded by the mean of their standard errors (perfect correlation).
/// The standard error includes the rounding of float32 pixels, so that noise-free blocks are not
/// divided by zero. Throws `Error` (bad input) when sizes differ, a variance layer is missing, a
/// value is not finite or the reference is black.
Agreement test_agreement(const Image &image, const Image &reference,
                         const AgreementPolicy &policy = {});
Agreement test_agreement(const std::vector<Image> &batches, const Image &reference,
                         const AgreementPolicy &policy = {}, const FreshBatches &fresh = {});
Agreement test_agreement(const Halves &image, const Halves &reference,
                         const AgreementPolicy &policy = {});
Agreement test_agreement(const std::vector<Image> &batches, const std::vector<Image> &others,
                         const AgreementPolicy &policy = {});

}  // namespace rtrays
