// SPDX-License-Identifier: MIT
#include "experiments/harness/core/agreement.h"

#include <fmt/format.h>

#include <algorithm>
#include <boost/math/distributions/normal.hpp>
#include <boost/math/distributions/students_t.hpp>
#include <cmath>
#include <functional>
#include <iterator>
#include <limits>
#include <numeric>
#include <vector>

#include "experiments/harness/core/blocks.h"
#include "experiments/harness/core/metrics.h"
#include "renderer/base/error.h"
#include "renderer/base/statistics.h"

namespace rtrays {

namespace {

/// Test of the difference of one channel's means over a block.
struct BlockTest {
    double difference = 0;      ///< mean of the image minus mean of the reference
    double standard_error = 0;  ///< of `difference`
    double reference = 0;       ///< mean of the reference
    double skewness = 0;        ///< larger absolute skewness of image and reference
    double p_value = 1;
    double adjusted_p = 1;
    double z = 0;  ///< value of a normal variable that has the same p-value
};

/// Degrees of freedom of Welch's test; infinite if both variances are known.
double welch_freedom(const NoisySum &a, const NoisySum &b) {
    const auto share = [](const NoisySum &sum) {
        return sum.variance * sum.variance / sum.freedom;
    };
    const double variance = a.variance + b.variance, shares = share(a) + share(b);
    return shares > 0 ? variance * variance / shares : std::numeric_limits<double>::infinity();
}

/// Third cumulant of the mean of `freedom` + 1 batches; 0 if the variance is known.
double third_cumulant(const NoisySum &sum) {
    return std::isfinite(sum.freedom)
               ? sum.skewness * std::pow(sum.variance, 1.5) / std::sqrt(sum.freedom + 1)
               : 0;
}

/// Removes the first-order effect of the skewness `q` of the mean from Student's t. If bright
/// batches are rare, a sample without them has a low mean and a low scatter, so that large negative
/// t are common. The result increases with t. P. Hall, On the removal of skewness by
/// transformation, J. R. Statist. Soc. B 54 (1992), 221-228, equation (2.4) with a = 1/3, b = 1/6.
double without_skewness(double t, double q) {
    return t + q * t * t / 3 + q * q * t * t * t / 27 + q / 6;
}

BlockTest test_block(const NoisySum &image, const NoisySum &reference, double pixels) {
    BlockTest test;
    test.reference = reference.value / pixels;
    test.skewness = std::max(std::abs(image.skewness), std::abs(reference.skewness));
    test.difference = (image.value - reference.value) / pixels;
    // Rounding of the pixels to float32: half an ulp each, in the worst case all in one direction.
    const double rounding = std::numeric_limits<float>::epsilon() *
                            std::max(std::abs(image.value), std::abs(reference.value)) / pixels;
    const double variance = image.variance + reference.variance;
    test.standard_error = std::sqrt(variance) / pixels + rounding;
    // A block that is black in both images has no difference and no standard error.
    test.z = test.standard_error > 0 ? test.difference / test.standard_error : 0;
    test.p_value = normal_p_value(test.z);
    const double freedom = welch_freedom(image, reference);
    if (std::isfinite(freedom)) {
        // Without any scatter the skewness is undefined.
        const double q = variance > 0 ? (third_cumulant(image) - third_cumulant(reference)) /
                                            std::pow(variance, 1.5)
                                      : 0;
        const double t = without_skewness(test.z, q);
        const boost::math::students_t student(freedom);
        test.p_value = 2 * boost::math::cdf(boost::math::complement(student, std::abs(t)));
        const boost::math::normal normal;
        test.z = test.p_value > 0
                     ? boost::math::quantile(boost::math::complement(normal, 0.5 * test.p_value))
                     : test.z;
    }
    return test;
}

}  // namespace

const char *to_string(Equivalence equivalence) {
    switch (equivalence) {
        case Equivalence::equivalent:
            return "equivalent";
        case Equivalence::different:
            return "different";
        case Equivalence::undecided:
            return "undecided";
    }
    throw run_error("unknown equivalence");
}

namespace {

/// Computes the sums of a channel.
using Sums = std::function<std::vector<NoisySum>(size_t)>;

/// Tests every block and, last, the full image, channel by channel.
std::vector<BlockTest> block_tests(const Sums &image_sums, const Sums &reference_sums,
                                   const std::vector<double> &pixels) {
    std::vector<BlockTest> tests;
    for (size_t c = 0; c < rgb_names().size(); ++c) {
        const std::vector<NoisySum> image = image_sums(c), reference = reference_sums(c);
        for (size_t i = 0; i < pixels.size(); ++i) {
            tests.push_back(test_block(image[i], reference[i], pixels[i]));
        }
    }
    return tests;
}

/// Applies Holm's adjustment to the tests `asked`, as one family.
void adjust(std::vector<BlockTest> &tests, const std::vector<size_t> &asked) {
    std::vector<double> p_values;
    for (const size_t i : asked) {
        p_values.push_back(tests[i].p_value);
    }
    const std::vector<double> adjusted = holm_adjusted(p_values);
    for (size_t k = 0; k < asked.size(); ++k) {
        tests[asked[k]].adjusted_p = adjusted[k];
    }
}

template <class Predicate>
std::vector<size_t> chosen(const std::vector<size_t> &among, const Predicate &predicate) {
    std::vector<size_t> result;
    std::copy_if(among.begin(), among.end(), std::back_inserter(result), predicate);
    return result;
}

/// Repeats all tests with other samples, given the pixels of every block.
using TestsAgain = std::function<std::vector<BlockTest>(const std::vector<double> &)>;

/// Runs the tests. `again` is called only if a test rejects.
Agreement test_sums(const Sums &image_sums, const Sums &reference_sums, const Image &shape,
                    const AgreementPolicy &policy, const TestsAgain &again = {}) {
    const std::vector<double> pixels = block_pixels(shape, policy.block_size);
    std::vector<BlockTest> tests = block_tests(image_sums, reference_sums, pixels);
    const auto is_decided = [&](size_t i) { return tests[i].skewness <= policy.largest_skewness; };
    const auto rejects = [&](size_t i) { return tests[i].adjusted_p <= policy.alpha; };

    Agreement result;
    double mean_difference = 0, mean_error = 0, mean_reference = 0;
    for (size_t i = pixels.size() - 1; i < tests.size(); i += pixels.size()) {
        mean_difference += tests[i].difference / 3;
        mean_error += tests[i].standard_error / 3;
        mean_reference += tests[i].reference / 3;
    }
    if (!(mean_reference > 0)) {
        throw input_error(
            "the reference is black, so the relative difference of the mean is undefined");
    }

    std::vector<size_t> decided(tests.size());
    std::iota(decided.begin(), decided.end(), size_t{0});
    decided = chosen(decided, is_decided);
    adjust(tests, decided);
    const std::vector<size_t> suspects = chosen(decided, rejects);
    if (again && !suspects.empty()) {
        const std::vector<BlockTest> others = again(pixels);
        for (const size_t i : suspects) {
            tests[i] = others[i];
        }
        adjust(tests, chosen(suspects, is_decided));
        result.unconfirmed = suspects.size() - chosen(suspects, rejects).size();
        decided = chosen(decided, is_decided);
    }

    result.tests = decided.size();
    result.undecided = tests.size() - decided.size();
    result.rejected = chosen(decided, rejects).size();
    for (const size_t i : decided) {
        result.smallest_adjusted_p = std::min(result.smallest_adjusted_p, tests[i].adjusted_p);
        if (std::abs(tests[i].z) >= result.largest_z) {
            result.largest_z = std::abs(tests[i].z);
            result.largest_z_at = rgb_names()[i / pixels.size()] + " " +
                                  block_name(i % pixels.size(), shape, policy.block_size);
        }
    }

    const double reach = normal_quantile_two_sided(policy.confidence) * mean_error;
    result.relative_difference = {mean_difference / mean_reference,
                                  (mean_difference - reach) / mean_reference,
                                  (mean_difference + reach) / mean_reference};
    const auto &[value, low, high] = result.relative_difference;
    if (low >= -policy.equivalence_limit && high <= policy.equivalence_limit) {
        result.equivalence = Equivalence::equivalent;
    } else if (high < -policy.equivalence_limit || low > policy.equivalence_limit) {
        result.equivalence = Equivalence::different;
    }
    return result;
}

/// Combines two tests of one block: returns the less significant one, and p = 1 if their signs
/// differ.
BlockTest weaker(const BlockTest &a, const BlockTest &b) {
    BlockTest result = std::abs(a.z) < std::abs(b.z) ? a : b;
    if (a.z * b.z < 0) {
        result.z = 0;
        result.p_value = 1;
    }
    return result;
}

void require_testable(const Image &image, const Image &other) {
    require_same_size(image, other);
    if (!has_variance(image)) {
        throw input_error(
            "an agreement test needs the layers variance.* (variance of the mean) in both images");
    }
}

Sums sums_of(const Image &image, const AgreementPolicy &policy) {
    return [&](size_t channel) { return sums_by_layer(image, channel, policy.block_size); };
}

Sums sums_of(const std::vector<Image> &batches, const AgreementPolicy &policy) {
    return [&](size_t channel) { return sums_by_batch(batches, channel, policy.block_size); };
}

}  // namespace

Agreement test_agreement(const Image &image, const Image &reference,
                         const AgreementPolicy &policy) {
    require_testable(image, reference);
    require_testable(reference, image);
    return test_sums(sums_of(image, policy), sums_of(reference, policy), image, policy);
}

Agreement test_agreement(const std::vector<Image> &batches, const Image &reference,
                         const AgreementPolicy &policy, const FreshBatches &fresh) {
    if (batches.size() < 2 || !has_variance(reference)) {
        throw input_error(
            "an agreement test needs at least two batches and a reference with the layers "
            "variance.*");
    }
    for (const Image &batch : batches) {
        require_same_size(batch, reference);
    }
    const auto again = [&](const std::vector<double> &pixels) {
        const std::vector<Image> others = fresh();
        return block_tests(sums_of(others, policy), sums_of(reference, policy), pixels);
    };
    return test_sums(sums_of(batches, policy), sums_of(reference, policy), reference, policy,
                     fresh ? again : TestsAgain());
}

Agreement test_agreement(const Halves &image, const Halves &reference,
                         const AgreementPolicy &policy) {
    for (const Halves &halves : {image, reference}) {
        require_testable(halves[0], image[0]);
        require_testable(halves[1], image[0]);
    }
    const auto again = [&](const std::vector<double> &pixels) {
        std::vector<BlockTest> first =
            block_tests(sums_of(image[0], policy), sums_of(reference[0], policy), pixels);
        const std::vector<BlockTest> second =
            block_tests(sums_of(image[1], policy), sums_of(reference[1], policy), pixels);
        std::transform(first.begin(), first.end(), second.begin(), first.begin(), weaker);
        return first;
    };
    const Image whole = average_images({image[0], image[1]}),
                other = average_images({reference[0], reference[1]});
    return test_sums(sums_of(whole, policy), sums_of(other, policy), whole, policy, again);
}

Agreement test_agreement(const std::vector<Image> &batches, const std::vector<Image> &others,
                         const AgreementPolicy &policy) {
    if (batches.size() < 2 || others.size() < 2) {
        throw input_error("an agreement test needs at least two batches of each image");
    }
    for (const std::vector<Image> &side : {batches, others}) {
        for (const Image &batch : side) {
            require_same_size(batch, batches.front());
        }
    }
    return test_sums(sums_of(batches, policy), sums_of(others, policy), batches.front(), policy);
}

}  // namespace rtrays
