// SPDX-License-Identifier: MIT
// Random numbers of the reference: xoshiro256** (Blackman & Vigna 2021, "Scrambled Linear
// Pseudorandom Number Generators"), seeded by SplitMix64 (Steele et al. 2014). The renderer uses
// Philox, so the two share no generator.
#pragma once

#include <array>
#include <cstdint>

namespace rtrays::reference {

/// Random number generator of one camera path. The start state is an injective function of (seed,
/// pixel, sample). A path therefore depends only on these three, not on threads, batches or
/// checkpoints.
class Rng {
  public:
    Rng(uint64_t seed, uint64_t pixel, uint64_t sample) {
        // Each step mixes one more coordinate through a bijection. The first output depends on
        // state_[1] alone, so that word must contain all three coordinates.
        const uint64_t of_seed = mix(seed + golden);
        const uint64_t of_pixel = mix((of_seed ^ pixel) + golden);
        const uint64_t of_sample = mix((of_pixel ^ sample) + golden);
        state_ = {of_pixel, of_sample, mix(of_sample + golden),
                  mix(of_sample + 2 * golden) ^ of_seed};
    }

    uint64_t next_bits() {
        const uint64_t result = rotate(state_[1] * 5, 7) * 9;
        const uint64_t shifted = state_[1] << 17;
        state_[2] ^= state_[0];
        state_[3] ^= state_[1];
        state_[1] ^= state_[2];
        state_[0] ^= state_[3];
        state_[2] ^= shifted;
        state_[3] = rotate(state_[3], 45);
        return result;
    }

    /// Returns a uniform number in [0, 1), a multiple of 2^-53.
    double uniform() { return static_cast<double>(next_bits() >> 11) * 0x1p-53; }

  private:
    static constexpr uint64_t golden = 0x9e3779b97f4a7c15;

    static uint64_t rotate(uint64_t x, int k) { return (x << k) | (x >> (64 - k)); }

    /// Applies the finalizer of SplitMix64, a bijection of 64-bit words.
    static uint64_t mix(uint64_t x) {
        x = (x ^ (x >> 30)) * 0xbf58476d1ce4e5b9;
        x = (x ^ (x >> 27)) * 0x94d049bb133111eb;
        return x ^ (x >> 31);
    }

    std::array<uint64_t, 4> state_;
};

}  // namespace rtrays::reference
