// SPDX-License-Identifier: MIT
// Compares the builder's prefix sums and radix sort with those of the standard library.
#include <gtest/gtest.h>

#include <algorithm>
#include <numeric>

#include "renderer/bvh/radix_sort.h"
#include "renderer/testing/bvh_tree.h"
#include "renderer/testing/errors.h"

namespace rtrays {
namespace {

using namespace test;

TEST(PrefixSums, AreThoseOfTheStandardLibrary) {
    Random random(1);
    for (const uint32_t block_size : {2u, 7u, 64u, 4096u}) {
        PrefixSums sums(test_device(), 4, block_size);
        for (const uint32_t count : {100000u, 1u, 2u, 63u, 64u, 65u, 4097u}) {
            std::vector<uint32_t> values(count);
            for (uint32_t &value : values) {
                value = static_cast<uint32_t>(random());  // sums wrap around
            }
            const Buffer<uint32_t> buffer(test_device(), "values", values);
            sums.scan(buffer, count);
            std::exclusive_scan(values.begin(), values.end(), values.begin(), 0u);
            EXPECT_EQ(buffer.read(), values) << count << " by " << block_size;
        }
    }
    expect_input_error("at least 2 values", [] { PrefixSums(test_device(), 1, 1); });
}

TEST(RadixSort, IsStableWhateverTheDistributionOfWork) {
    Random random(2);
    for (const uint32_t count : {1u, 1000u, 70001u}) {
        for (const uint64_t largest :
             {uint64_t{3}, uint64_t{1} << 40, ~uint64_t{0}}) {  // from few distinct keys to all
            std::vector<uint64_t> keys(count);
            std::vector<uint32_t> order(count);
            for (uint64_t &key : keys) {
                key = std::uniform_int_distribution<uint64_t>(0, largest)(random);
            }
            std::iota(order.begin(), order.end(), 0u);
            std::vector<uint32_t> expected = order;
            std::stable_sort(expected.begin(), expected.end(),
                             [&](uint32_t a, uint32_t b) { return keys[a] < keys[b]; });
            for (const RadixSortParameters &parameters :
                 {RadixSortParameters{1, 8, 16384}, {8, 4, 32}, {3, 5, 100}}) {
                Buffer<uint64_t> sorted(test_device(), "keys", keys);
                Buffer<uint32_t> values(test_device(), "values", order);
                RadixSort(test_device(), parameters).sort(sorted, values, 64);
                EXPECT_EQ(values.read(), expected) << count << ' ' << parameters.digit_bits;
                const std::vector<uint64_t> result = sorted.read();
                EXPECT_TRUE(std::is_sorted(result.begin(), result.end()));
            }
        }
    }
    expect_input_error("1 to 8 bits", [] { RadixSort(test_device(), {1, 9, 1}); });
}

}  // namespace
}  // namespace rtrays
