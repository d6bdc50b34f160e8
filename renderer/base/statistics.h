// SPDX-License-Identifier: MIT
// Statistical tests: p-values, and decisions over many tests at once.
#pragma once

#include <vector>

namespace rtrays {

/// Returns the two-sided p-value of a standard normal z.
double normal_p_value(double z);

/// Returns Holm's (1979) adjusted p-values: test i is rejected at level alpha when adjusted[i] <=
/// alpha. A p-value that is NaN counts as 0, because a test that cannot be judged has not passed.
std::vector<double> holm_adjusted(std::vector<double> p_values);

}  // namespace rtrays
