// SPDX-License-Identifier: MIT
// Prefix sums and totals by a single work-group, for stages that number items in a fixed order. On
// a GPU its ONE_GROUP work-items process as many items at a time; on a CPU it is a single
// work-item.
#pragma once

#include "renderer/shared/compat.h"

#ifndef ONE_GROUP
#define ONE_GROUP 1u
#endif

/// Returns the sum of `value` over the work-items before this one, and sets `*total` to the sum
/// over all. All work-items must call it equally often. `values` is shared by them and free again
/// on return.
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
