// SPDX-License-Identifier: MIT
// Prefix sums and totals by a single work-group, for stages that number things in a fixed order: on
// a GPU its ONE_GROUP work-items take that many of them at a time, on a CPU it is one work-item.
#pragma once

#include "renderer/shared/compat.h"

#ifndef ONE_GROUP
#define ONE_GROUP 1u
#endif

/// The sum of `value` over the work-items before this one, and over all of them in `*total`. All
/// work-items call it, equally often; `values` is theirs to share, and free again when it returns.
DEVICE uint sum_before(__local uint *values, uint value, PRIVATE uint *total) {
    const uint item = (uint)get_local_id(0);
    values[item] = value;
    barrier(CLK_LOCAL_MEM_FENCE);
    for (uint step = 1; step < ONE_GROUP; step *= 2u) {
        const uint before = item >= step ? values[item - step] : 0u;
        barrier(CLK_LOCAL_MEM_FENCE);
        values[item] += before;
        barrier(CLK_LOCAL_MEM_FENCE);
    }
    *total = values[ONE_GROUP - 1u];
    const uint before = values[item] - value;
    barrier(CLK_LOCAL_MEM_FENCE);
    return before;
}
