// SPDX-License-Identifier: MIT
#include "reference/film.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <boost/multiprecision/cpp_int.hpp>
#include <cmath>
#include <cstring>
#include <limits>
#include <random>

#include "reference/rng.h"
#include "renderer/base/error.h"

namespace rtrays::reference {
namespace {

using Rational = boost::multiprecision::cpp_rational;
using Integer = boost::multiprecision::cpp_int;

Integer integer_of(const FixedSum<4> &sum) {
    Integer total = 0;
    for (size_t k = 0; k < 4; ++k) {
        total += Integer(sum.words()[k]) << (48 * k);
    }
    return total;
}

bool same_words(const PixelSums &a, const PixelSums &b) {
    return std::memcmp(&a, &b, sizeof a) == 0;
}

TEST(FixedSum, equals_integers_of_any_length) {
    std::mt19937_64 random(11);
    FixedSum<4> sum;
    Integer expected = 0;
    for (int i = 0; i < 20000; ++i) {
        const Int128 value = static_cast<Int128>(static_cast<int64_t>(random())) *
                             (static_cast<int64_t>(random()) >> (random() % 64));
        const auto shift = static_cast<unsigned>(random() % 60);
        sum.add(value, shift);
        Integer exact = static_cast<int64_t>(value >> 64);
        exact = (exact << 64) + static_cast<uint64_t>(value);
        expected += exact << shift;
        ASSERT_EQ(integer_of(sum), expected) << i;
        for (size_t k = 0; k < 3; ++k) {
            ASSERT_EQ(sum.words()[k] >> 48, 0) << i;
        }
    }
}

TEST(FixedSum, borrows_and_carries_through_all_words) {
    FixedSum<4> sum;
    sum.add(-1, 0);
    EXPECT_EQ(integer_of(sum), -1);
    EXPECT_EQ(sum.value(3), -8.0);
    sum.add(1, 0);
    EXPECT_EQ(integer_of(sum), 0);
    sum.add(1, 144);
    sum.add(-1, 0);
    EXPECT_EQ(integer_of(sum), (Integer(1) << 144) - 1);
    sum.add(-5, 150);
    EXPECT_EQ(integer_of(sum), (Integer(1) << 144) - 1 - (Integer(5) << 150));
}

TEST(FixedSum, multiplies_without_rounding) {
    FixedSum<2> factor;
    factor.add((static_cast<Int128>(1) << 90) + 12345, 0);
    FixedSum<4> product;
    product.add_multiple(factor, 987654321, 7);
    EXPECT_EQ(integer_of(product), (((Integer(1) << 90) + 12345) * 987654321) << 7);
    product.add_multiple(factor, -987654321, 7);
    EXPECT_EQ(integer_of(product), 0);
}

/// Returns a sample like those of an image with fireflies: magnitudes from 2^-100 to 2^60.
double wild_sample(std::mt19937_64 &random) {
    return std::ldexp(static_cast<double>(random() >> 11), static_cast<int>(random() % 160) - 153);
}

/// Exact sums of samples rounded to multiples of 2^-88.
struct ExactSums {
    void add(double sample) {
        const Rational value = rounded(sample);
        sum += value;
        squares += value * value;
        ++count;
    }
    static Rational rounded(double sample) {
        const Rational units = Rational(sample) * Rational(Integer(1) << 88);
        const Integer numerator = boost::multiprecision::numerator(units),
                      denominator = boost::multiprecision::denominator(units);
        Integer whole = numerator / denominator;
        const Integer twice = 2 * (numerator - whole * denominator);
        if (twice > denominator || (twice == denominator && whole % 2 == 1)) {
            ++whole;
        }
        return Rational(whole, Integer(1) << 88);
    }
    double mean() const { return static_cast<double>(Rational(sum / count)); }
    double variance_of_mean() const {
        const Rational n = count;
        return static_cast<double>(Rational((squares - sum * sum / n) / (n * (n - Rational(1)))));
    }

    Rational sum = 0, squares = 0;
    uint64_t count = 0;
};

TEST(PixelSums, equal_exact_rationals_over_200k_wild_samples) {
    std::mt19937_64 random(5);
    constexpr uint64_t count = 200000;
    PixelSums sums;
    ExactSums exact;
    double plain = 0;
    for (uint64_t i = 0; i < count; ++i) {
        const double sample = wild_sample(random);
        ASSERT_TRUE(sums.add(Spectrum(1.0, sample, 2.0)));
        exact.add(sample);
        plain += sample;
    }
    const double tolerance = 0x1p-49;
    EXPECT_NEAR(sums.mean(count)[1] / exact.mean(), 1.0, tolerance);
    EXPECT_NEAR(sums.variance_of_mean(count)[1] / exact.variance_of_mean(), 1.0, tolerance);
    // A plain sum of doubles has a larger error, so the tolerance can tell.
    EXPECT_GT(std::abs(plain / static_cast<double>(count) / exact.mean() - 1.0), tolerance);
}

TEST(PixelSums, know_the_scatter_of_equal_and_almost_equal_samples) {
    constexpr uint64_t count = 200000;
    PixelSums sums;
    ExactSums exact;
    for (uint64_t i = 0; i < count; ++i) {
        const double almost = i % 2 == 0 ? 0.1 : std::nextafter(0.1, 1.0);
        sums.add(Spectrum(0.1, almost, 1e20));
        exact.add(almost);
    }
    EXPECT_EQ(sums.mean(count)[0], 0.1);
    EXPECT_EQ(sums.variance_of_mean(count)[0], 0.0);
    EXPECT_EQ(sums.variance_of_mean(count)[2], 0.0);
    EXPECT_GT(exact.variance_of_mean(), 0.0);
    EXPECT_NEAR(sums.variance_of_mean(count)[1] / exact.variance_of_mean(), 1.0, 0x1p-49);
}

TEST(PixelSums, survive_a_firefly) {
    // One sample of 1e8 among 200k ones. A plain double sum keeps the mean, but its square would
    // cancel in the variance.
    constexpr uint64_t count = 200000;
    PixelSums sums;
    for (uint64_t i = 0; i < count; ++i) {
        sums.add(Spectrum::Constant(i == 1234 ? 1e8 : 1.0));
    }
    const double n = count;
    EXPECT_DOUBLE_EQ(sums.mean(count)[1], (1e8 + n - 1.0) / n);
    const double expected = (1e8 - 1.0) * (1e8 - 1.0) * (n - 1.0) / n / (n * (n - 1.0));
    EXPECT_NEAR(sums.variance_of_mean(count)[1] / expected, 1.0, 1e-14);
}

TEST(PixelSums, do_not_depend_on_order_or_split) {
    std::mt19937_64 random(3);
    std::vector<double> samples(3000);
    for (double &sample : samples) {
        sample = (random() % 2 == 0 ? 1.0 : -1.0) * wild_sample(random);
    }
    PixelSums whole;
    for (const double sample : samples) {
        whole.add(Spectrum::Constant(sample));
    }
    for (int repetition = 0; repetition < 20; ++repetition) {
        std::shuffle(samples.begin(), samples.end(), random);
        std::array<PixelSums, 7> parts;
        for (const double sample : samples) {
            parts.at(random() % parts.size()).add(Spectrum::Constant(sample));
        }
        for (size_t i = 1; i < parts.size(); ++i) {
            parts[0] += parts.at(i);
        }
        ASSERT_TRUE(same_words(parts[0], whole)) << repetition;
        parts[0].add(Spectrum(0.0, 0.0, 0x1p-88));
        ASSERT_FALSE(same_words(parts[0], whole)) << repetition;
    }
}

/// The largest numbers and numbers of either sign at every shift fill the words the most.
TEST(PixelSums, add_many_at_once_as_one_by_one) {
    const double largest = std::nextafter(PixelSums::limit, 0.0);
    for (int exponent = 0; exponent < 140; ++exponent) {
        const double sample = std::ldexp(largest, -exponent);
        PixelSums single, many;
        {
            PixelSums::Adder adder(many);
            for (int i = 0; i < 500; ++i) {
                adder.add(Spectrum(sample, -sample, i % 3 == 0 ? -sample : sample));
            }
        }
        for (int i = 0; i < 500; ++i) {
            single.add(Spectrum(sample, -sample, i % 3 == 0 ? -sample : sample));
        }
        ASSERT_TRUE(same_words(single, many)) << exponent;
        ASSERT_DOUBLE_EQ(many.mean(500)[1], -sample);
        ASSERT_EQ(many.variance_of_mean(500)[0], 0.0);
    }
}

/// Adds the words of many films as other processes do, and carries once.
TEST(PixelSums, carry_sums_of_words) {
    PixelSums one;
    for (int i = 0; i < 5; ++i) {
        one.add(Spectrum(0x1.fffffffffffffp135, 0.7, 1e-20));
    }
    constexpr int films = 1 << 15;
    std::array<int64_t, PixelSums::word_count> words{}, own;
    std::memcpy(own.data(), &one, sizeof one);
    PixelSums expected;
    for (int film = 0; film < films; ++film) {
        for (size_t k = 0; k < words.size(); ++k) {
            words.at(k) += own.at(k);
        }
        expected += one;
    }
    PixelSums total;
    std::memcpy(static_cast<void *>(&total), words.data(), sizeof total);
    EXPECT_FALSE(same_words(total, expected));
    total.carry();
    EXPECT_TRUE(same_words(total, expected));
    EXPECT_DOUBLE_EQ(total.mean(5 * films)[1], 0.7);
    EXPECT_DOUBLE_EQ(total.mean(5 * films)[0], 0x1p136);
}

TEST(PixelSums, refuse_what_is_not_finite_or_out_of_range) {
    PixelSums sums;
    const PixelSums empty = sums;
    for (const double bad : {std::numeric_limits<double>::infinity(), 0x1p136, -0x1p136,
                             std::numeric_limits<double>::quiet_NaN()}) {
        EXPECT_FALSE(sums.add(Spectrum(1.0, 1.0, bad))) << bad;
        EXPECT_TRUE(same_words(sums, empty)) << bad;
    }
    const double largest = std::nextafter(0x1p136, 0.0);
    EXPECT_TRUE(sums.add(Spectrum::Constant(largest)));
    EXPECT_TRUE(sums.add(Spectrum::Constant(-largest)));
    EXPECT_EQ(sums.mean(2)[0], 0.0);
    EXPECT_DOUBLE_EQ(sums.variance_of_mean(2)[0], largest * largest);
}

TEST(PixelSums, continue_from_means_and_variances) {
    Rng rng(7, 0, 0);
    PixelSums all, first;
    constexpr uint64_t count = 1000, part = 400;
    for (uint64_t i = 0; i < count; ++i) {
        const Spectrum sample(1e6 + rng.uniform(), rng.uniform(), 1e-9 * rng.uniform());
        all.add(sample);
        if (i < part) {
            first.add(sample);
        } else if (i == part) {
            const auto as_floats = [](const Spectrum &values) -> Spectrum {
                return values.cast<float>().cast<double>();
            };
            first = PixelSums::of(as_floats(first.mean(part)),
                                  as_floats(first.variance_of_mean(part)), part);
            first.add(sample);
        } else {
            first.add(sample);
        }
    }
    for (Eigen::Index c = 0; c < 3; ++c) {
        EXPECT_NEAR(first.mean(count)[c] / all.mean(count)[c], 1.0, 1e-7) << c;
        // The first mean is rounded by 2^-25, up to 0.03 in the first channel.
        EXPECT_NEAR(first.variance_of_mean(count)[c] / all.variance_of_mean(count)[c], 1.0,
                    c == 0 ? 1e-2 : 1e-6)
            << c;
    }
    const Spectrum infinite = Spectrum::Constant(std::numeric_limits<double>::infinity());
    EXPECT_THROW(PixelSums::of(infinite, infinite, part), Error);
}

TEST(Film, develops_means_variances_and_counts) {
    Film film(2, 1);
    film.pixels[1].add(Spectrum(1.0, 2.0, 3.0));
    film.pixels[1].add(Spectrum(3.0, 2.0, 7.0));
    film.add({10, 12});
    const Image image = film.develop(1.5);
    EXPECT_EQ(image.channel("R")[1], 2.0f);
    EXPECT_EQ(image.channel("B")[1], 5.0f);
    EXPECT_EQ(image.channel("variance.R")[1], 1.0f);
    EXPECT_EQ(image.channel("variance.G")[1], 0.0f);
    EXPECT_EQ(image.channel("variance.B")[1], 4.0f);
    EXPECT_EQ(image.channel("samples")[0], 2.0f);
    EXPECT_EQ(std::get<float>(image.attributes().at("renderTimeSeconds")), 1.5f);
}

TEST(Film, merges_other_samples_of_the_same_size) {
    Film film(1, 1), other(1, 1);
    film.add({0, 2});
    other.add({3, 4});
    other.pixels[0].add(Spectrum(4.0, 2.0, 0.0));
    film.merge(other);
    EXPECT_EQ(describe(film.ranges), "0:2 3:4");
    EXPECT_EQ(film.pixels[0].mean(film.count())[0], 4.0 / 3.0);
    EXPECT_THROW(film.merge(other), Error);
    EXPECT_EQ(film.count(), 3u);
    EXPECT_THROW(film.merge(Film(1, 2)), Error);
    EXPECT_THROW(film.add({4, 5 + PixelSums::max_count}), Error);
}

}  // namespace
}  // namespace rtrays::reference
