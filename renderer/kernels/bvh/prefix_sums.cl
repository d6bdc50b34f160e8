// SPDX-License-Identifier: MIT
// Exclusive prefix sums of any length, in blocks: sum_blocks (a work-item per block), the same of
// the sums of blocks until they are one block, and back through scan_blocks. Integers: the same
// bits whatever the size of a block.
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

/// In place; `sums` are the sums before each block, and are read where there is more than one.
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
