// SPDX-License-Identifier: MIT
// Whether two independent noisy images estimate the same picture: z tests per block and on the mean, and a
// statement of equivalence.
#pragma once

#include <string>
#include <vector>

#include "experiments/statistics.h"
#include "renderer/base/image.h"

namespace rtrays {

/// The difference of one colour channel's mean over a block of pixels (or the whole image).
struct BlockTest {
    int x = 0, y = 0;           ///< block indices; -1, -1 is the whole image
    std::string channel;        ///< "R", "G" or "B"
    double difference = 0;      ///< mean of image less mean of reference
    double standard_error = 0;  ///< of `difference`
    double z = 0;
    double adjusted_p = 1;  ///< Holm over all blocks, channels and the whole image
};

enum class Equivalence { equivalent, different, undecided };

const char *to_string(Equivalence equivalence);

struct Agreement {
    std::vector<BlockTest> tests;  ///< channels x (blocks + whole image)
    size_t rejected = 0;           ///< tests with adjusted p <= alpha
    double largest_z = 0;          ///< largest |z| of all tests
    double smallest_adjusted_p = 1;
    Interval relative_difference;  ///< of the mean over pixels and channels, over the reference's mean
    Equivalence equivalence = Equivalence::undecided;

    bool agrees() const { return rejected == 0; }
};

struct AgreementPolicy {
    int block_size = 16;
    double alpha = 0.01;       ///< family-wise, Holm
    double confidence = 0.99;  ///< of the interval of the mean difference
    double equivalence_limit = 1e-3;
};

/// Both images carry "variance.*" (variance of the mean of each pixel) and share no samples; pixels are taken
/// as independent, which holds for algorithms without splats.
///
/// Channels of a pixel are correlated, so each channel is tested alone, and the standard error of the mean
/// over channels is bounded by the mean of their standard errors (perfect correlation). The standard error
/// includes the rounding of float32 pixels, so that noise-free blocks are not divided by zero. Throws `Error`
/// (bad input) when sizes differ or a variance layer is missing.
Agreement test_agreement(const Image &image, const Image &reference, const AgreementPolicy &policy = {});

}  // namespace rtrays
