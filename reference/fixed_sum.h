// SPDX-License-Identifier: MIT
// Exact sums of whole numbers of many digits.
#pragma once

#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>

namespace rtrays::reference {

/// Whole number of 128 bits; products of two 64-bit numbers fit.
__extension__ typedef __int128 Int128;

/// A whole number in digits of 48 bits, for exact sums in any order. Word k has the weight 2^(48
/// k). All words but the top one are in [0, 2^48); the top word has the sign. Equal numbers thus
/// have equal words.
///
/// Words of up to 2^15 such numbers may be added as plain integers of 64 bits, for example by other
/// processes; `carry` then restores the form. 2^15 digits below 2^48 stay below 2^63. The caller
/// guarantees that the total is below 2^63 of the top word's weight.
template <size_t Words>
class FixedSum {
  public:
    static constexpr unsigned digit_bits = 48;
    static constexpr int64_t digit_mask = (int64_t{1} << digit_bits) - 1;

    /// Adds value * 2^shift. Needs shift < 48 * Words.
    void add(Int128 value, unsigned shift) {
        size_t k = shift / digit_bits;
        const unsigned bits = shift % digit_bits;
        // value * 2^bits may have more than 128 bits, so that its lowest digit is split off first.
        // Right shifts of negative numbers round down, hence each digit is in [0, 2^48).
        int64_t digit = lowest_digit(value, bits);
        Int128 rest = value >> (digit_bits - bits);
        for (; k + 1 < Words; ++k) {
            words_[k] += digit;
            rest += words_[k] >> digit_bits;
            words_[k] &= digit_mask;
            if (rest == 0) {
                return;
            }
            digit = static_cast<int64_t>(rest & digit_mask);
            rest >>= digit_bits;
        }
        words_[k] += digit + static_cast<int64_t>(rest) * (digit_mask + 1);
    }

    /// Adds value * 2^shift, which is below 2^106 in magnitude before the shift, without carries.
    /// It adds less than 2^58 to a word, so `carry` must be called after at most 31 additions.
    /// Needs shift < 48 * (Words - 2).
    void add_without_carry(Int128 value, unsigned shift) {
        int64_t *word = words_.data() + shift / digit_bits;
        const unsigned bits = shift % digit_bits;
        const Int128 rest = value >> (digit_bits - bits);
        word[0] += lowest_digit(value, bits);
        word[1] += static_cast<int64_t>(rest & digit_mask);
        word[2] += static_cast<int64_t>(rest >> digit_bits);
    }

    /// Adds other * factor * 2^shift. A product of two words is below 2^126.
    template <size_t Others>
    void add_multiple(const FixedSum<Others> &other, int64_t factor, unsigned shift = 0) {
        for (size_t k = 0; k < Others; ++k) {
            add(static_cast<Int128>(other.words()[k]) * factor,
                shift + static_cast<unsigned>(k) * digit_bits);
        }
    }

    /// Adds another number word by word.
    void operator+=(const FixedSum &other) {
        for (size_t k = 0; k < Words; ++k) {
            words_[k] += other.words_[k];
        }
        carry();
    }

    /// Propagates the carries after words were added from outside.
    void carry() {
        for (size_t k = 0; k + 1 < Words; ++k) {
            words_[k + 1] += words_[k] >> digit_bits;
            words_[k] &= digit_mask;
        }
    }

    /// Returns the number times 2^exponent. The relative error is below 2^-51: digits of 48 bits
    /// are exact as doubles, the top word is rounded by 2^-53, and of the additions only the last
    /// three round by more than 2^-90 of the result.
    double value(int exponent) const {
        if (words_[Words - 1] < 0) {
            FixedSum negated;
            negated.add_multiple(*this, -1);
            return -negated.value(exponent);
        }
        double sum = 0, unit = std::ldexp(1.0, exponent);
        for (const int64_t word : words_) {
            sum += static_cast<double>(word) * unit;
            unit *= static_cast<double>(digit_mask + 1);
        }
        return sum;
    }

    const std::array<int64_t, Words> &words() const { return words_; }

  private:
    /// Returns the lowest digit of value * 2^bits.
    static int64_t lowest_digit(Int128 value, unsigned bits) {
        return static_cast<int64_t>(value & (digit_mask >> bits)) << bits;
    }

    std::array<int64_t, Words> words_{};
};

}  // namespace rtrays::reference
