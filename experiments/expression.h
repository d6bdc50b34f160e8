// SPDX-License-Identifier: MIT
// Formulas in descriptions: an expected value is computed from the parameters that the scene is set
// to, not typed.
#pragma once

#include <functional>
#include <string>

namespace rtrays {

/// What a name stands for; throws `Error` for one it does not know.
using Names = std::function<double(const std::string &)>;

/// The value of a formula in double precision: numbers, names, + - * / ^ (right to left, before the
/// sign), parentheses, `pi`, sqrt, exp, log, expm1, log1p, sin, cos, tan, asin, acos, atan, atan2,
/// abs, min, max, and `float`, which rounds to float32 as the renderer does with its inputs. Angles
/// are radians. Throws `Error` (bad input) that shows formula and place.
double evaluate(const std::string &formula, const Names &names);

}  // namespace rtrays
