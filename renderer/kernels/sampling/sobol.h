// SPDX-License-Identifier: MIT
// Owen-scrambled Sobol points in four dimensions (Sobol 1967; Owen 1995).
//
// Scrambling is by hashing (Burley 2020, "Practical hash-based Owen scrambling") with the hash of
// Vegdahl 2021. Any 2^k consecutive samples, from a multiple of 2^k on, are stratified in every
// dimension and pair of dimensions like the unscrambled sequence. Each scrambling is random, so
// estimates are unbiased. Further dimensions use sequences with independent scramblings and orders.
#pragma once

#include "renderer/shared/compat.h"

/// Direction numbers of dimensions 2 to 4 (Joe & Kuo 2008), most significant bit first. Those of
/// the first dimension are the bits themselves.
CONSTANT uint SOBOL_DIRECTIONS[3][32] = {
    {0x80000000u, 0xc0000000u, 0xa0000000u, 0xf0000000u, 0x88000000u, 0xcc000000u, 0xaa000000u,
     0xff000000u, 0x80800000u, 0xc0c00000u, 0xa0a00000u, 0xf0f00000u, 0x88880000u, 0xcccc0000u,
     0xaaaa0000u, 0xffff0000u, 0x80008000u, 0xc000c000u, 0xa000a000u, 0xf000f000u, 0x88008800u,
     0xcc00cc00u, 0xaa00aa00u, 0xff00ff00u, 0x80808080u, 0xc0c0c0c0u, 0xa0a0a0a0u, 0xf0f0f0f0u,
     0x88888888u, 0xccccccccu, 0xaaaaaaaau, 0xffffffffu},
    {0x80000000u, 0xc0000000u, 0x60000000u, 0x90000000u, 0xe8000000u, 0x5c000000u, 0x8e000000u,
     0xc5000000u, 0x68800000u, 0x9cc00000u, 0xee600000u, 0x55900000u, 0x80680000u, 0xc09c0000u,
     0x60ee0000u, 0x90550000u, 0xe8808000u, 0x5cc0c000u, 0x8e606000u, 0xc5909000u, 0x6868e800u,
     0x9c9c5c00u, 0xeeee8e00u, 0x5555c500u, 0x8000e880u, 0xc0005cc0u, 0x60008e60u, 0x9000c590u,
     0xe8006868u, 0x5c009c9cu, 0x8e00eeeeu, 0xc5005555u},
    {0x80000000u, 0xc0000000u, 0x20000000u, 0x50000000u, 0xf8000000u, 0x74000000u, 0xa2000000u,
     0x93000000u, 0xd8800000u, 0x25400000u, 0x59e00000u, 0xe6d00000u, 0x78080000u, 0xb40c0000u,
     0x82020000u, 0xc3050000u, 0x208f8000u, 0x51474000u, 0xfbea2000u, 0x75d93000u, 0xa0858800u,
     0x914e5400u, 0xdbe79e00u, 0x25db6d00u, 0x58800080u, 0xe54000c0u, 0x79e00020u, 0xb6d00050u,
     0x800800f8u, 0xc00c0074u, 0x200200a2u, 0x50050093u}};

DEVICE uint reverse_bits(uint x) {
    x = (x >> 16) | (x << 16);
    x = ((x & 0x00ff00ffu) << 8) | ((x & 0xff00ff00u) >> 8);
    x = ((x & 0x0f0f0f0fu) << 4) | ((x & 0xf0f0f0f0u) >> 4);
    x = ((x & 0x33333333u) << 2) | ((x & 0xccccccccu) >> 2);
    return ((x & 0x55555555u) << 1) | ((x & 0xaaaaaaaau) >> 1);
}

/// Permutes x at random so that every bit depends only on the bits above it: nested uniform
/// scrambling in base 2.
DEVICE uint scramble(uint x, uint seed) {
    x = reverse_bits(x);
    x ^= x * 0x3d20adeau;
    x += seed;
    x *= (seed >> 16) | 1u;
    x ^= x * 0x05526c56u;
    x ^= x * 0x53a22864u;
    return reverse_bits(x);
}

/// Returns the point of the unscrambled sequence whose index has these bits. The bits are random,
/// so masks cost less than unpredictable branches.
DEVICE uint4 plain_sobol_point(uint bits) {
    uint y = 0u, z = 0u, w = 0u;
    for (uint i = 0u; i < 32u; ++i) {
        const uint mask = 0u - ((bits >> i) & 1u);
        y ^= SOBOL_DIRECTIONS[0][i] & mask;
        z ^= SOBOL_DIRECTIONS[1][i] & mask;
        w ^= SOBOL_DIRECTIONS[2][i] & mask;
    }
    return make_uint4(reverse_bits(bits), y, z, w);
}

/// Returns point `index` of a sequence. `order` determines the order of its points, `seeds` the
/// scramblings of the dimensions.
DEVICE uint4 sobol_point(uint index, uint order, uint4 seeds) {
    const uint4 point = plain_sobol_point(scramble(index, order));
    return make_uint4(scramble(point.x, seeds.x), scramble(point.y, seeds.y),
                      scramble(point.z, seeds.z), scramble(point.w, seeds.w));
}

/// Returns point `index` of a regular sequence: sobol_point with digital shifts of index and point,
/// which keep the stratification. Point 0 is (1/2, 1/2, 0, 1/2), the centre of a pixel and of the
/// lens.
DEVICE uint4 regular_point(uint index, uint order, uint4 seeds) {
    const uint4 point = plain_sobol_point(scramble(index, order) ^ scramble(0u, order));
    return make_uint4(scramble(point.x, seeds.x) ^ scramble(0u, seeds.x) ^ 0x80000000u,
                      scramble(point.y, seeds.y) ^ scramble(0u, seeds.y) ^ 0x80000000u,
                      scramble(point.z, seeds.z) ^ scramble(0u, seeds.z),
                      scramble(point.w, seeds.w) ^ scramble(0u, seeds.w) ^ 0x80000000u);
}
