// SPDX-License-Identifier: MIT
// Decisions over many tests at once.
#pragma once

#include <vector>

namespace rtrays {

/// Two-sided p-value of a standard normal z.
double normal_p_value(double z);

/// Holm's (1979) adjusted p-values: test i is rejected at level alpha when adjusted[i] <= alpha. A
/// p-value that is not a number counts as 0: what cannot be judged has not passed.
std::vector<double> holm_adjusted(std::vector<double> p_values);

}  // namespace rtrays
