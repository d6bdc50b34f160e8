// SPDX-License-Identifier: MIT
// Exclusive prefix sums of any length, in blocks.
//
// sum_blocks (one work-item per block) computes the sums of blocks. It is repeated on its results
// until they form a single block; scan_blocks then returns level by level. The sums are integers,
// so the result does not depend on the size of a block.
#include "renderer/shared/compat.h"

__kernel void sum_blocks(GLOBAL const uint *values, uint count, uint block_size,
                         GLOBAL uint *sums) {
    const uint block = (uint)get_global_id(0);
    const uint begin = block * block_size;
    if (begin >= count) {
        return;
    }
    const uint end = min(begin + block_size, count);
    uint sum = 0;
    for (uint i = begin; i < end; ++i) {
        sum += values[i];
    }
    sums[block] = sum;
}

/// Replaces values by their prefix sums. `sums` are the sums before each block; they are read if
/// there is more than one block.
__kernel void scan_blocks(GLOBAL uint *values, uint count, uint block_size,
                          GLOBAL const uint *sums) {
    const uint block = (uint)get_global_id(0);
    const uint begin = block * block_size;
    if (begin >= count) {
        return;
    }
    const uint end = min(begin + block_size, count);
    uint sum = count > block_size ? sums[block] : 0u;
    for (uint i = begin; i < end; ++i) {
        const uint value = values[i];
        values[i] = sum;
        sum += value;
    }
}
