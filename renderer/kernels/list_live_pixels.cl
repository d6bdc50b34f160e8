// SPDX-License-Identifier: MIT
// Stages that list the live pixels, which have not stopped, in ascending order.
//
// The list is a stable compaction, so it does not depend on the order of work-items. The stages
// count the live pixels of each block, sum the counts, and write the blocks one after the other.

#include "renderer/shared/live_pixels.h"

/// Loops `pixel` over the pixels of a block.
#define FOR_EACH_PIXEL(pixel, block, pixels)                                               \
    for (uint pixel = (block)*LIVE_BLOCK, pixel##_end = min(pixel + LIVE_BLOCK, (pixels)); \
         pixel < pixel##_end; ++pixel)

/// Stage count_live_pixels: counts the live pixels of each block. One work-item per block.
///
/// STAGE(count_live_pixels,
///       reads(stopped_at),
///       writes(live_blocks))
__kernel void count_live_pixels(GLOBAL const ulong *stopped_at, uint pixels,
                                GLOBAL uint *live_blocks) {
    const uint block = get_global_id(0);
    if (block >= LIVE_BLOCKS(pixels)) {
        return;
    }
    uint live = 0;
    FOR_EACH_PIXEL(pixel, block, pixels) {
        live += stopped_at[pixel] == 0u ? 1u : 0u;
    }
    live_blocks[block] = live;
}

/// Stage place_live_blocks (one work-item): replaces the counts of the blocks by their offsets in
/// the list, and writes the length of the list.
///
/// STAGE(place_live_blocks,
///       writes(live_blocks, live_count))
__kernel void place_live_blocks(uint pixels, GLOBAL uint *live_blocks, GLOBAL uint *live_count) {
    if (get_global_id(0) != 0u) {
        return;
    }
    uint begin = 0;
    for (uint block = 0; block < LIVE_BLOCKS(pixels); ++block) {
        const uint live = live_blocks[block];
        live_blocks[block] = begin;
        begin += live;
    }
    *live_count = begin;
}

/// Stage list_live_pixels: writes the list. One work-item per block.
///
/// STAGE(list_live_pixels,
///       reads(live_blocks, stopped_at),
///       writes(live_pixels))
__kernel void list_live_pixels(GLOBAL const ulong *stopped_at, uint pixels,
                               GLOBAL const uint *live_blocks, GLOBAL uint *live_pixels) {
    const uint block = get_global_id(0);
    if (block >= LIVE_BLOCKS(pixels)) {
        return;
    }
    uint place = live_blocks[block];
    FOR_EACH_PIXEL(pixel, block, pixels) {
        if (stopped_at[pixel] == 0u) {
            live_pixels[place++] = pixel;
        }
    }
}
