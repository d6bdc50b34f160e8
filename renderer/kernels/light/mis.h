// SPDX-License-Identifier: MIT
#pragma once

#include "renderer/shared/compat.h"

/// Weight of the power heuristic for the technique whose density the ratio is taken against:
/// 1 / (1 + (p_other / p_own)^beta) (Veach 1997, 9.2.2; thesis 2.57). The ratio may be 0 or infinite, the weight
/// then is 1 or 0; it is never NaN for densities that are not both 0 or both infinite.
DEVICE float power_heuristic(float other_over_own, float beta) {
    const float power = beta == 2.0f ? other_over_own * other_over_own : pow(other_over_own, beta);
    return 1.0f / (1.0f + power);
}
