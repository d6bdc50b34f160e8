// SPDX-License-Identifier: MIT
// Evaluates formulas in description files. Expected values are computed from the parameters of the
// scene instead of being typed.
#pragma once

#include <functional>
#include <string>

namespace rtrays {

/// Returns the value of a name; throws `Error` for an unknown one.
using Names = std::function<double(const std::string &)>;

/// Evaluates a formula in double precision. A formula has numbers, names, parentheses, `pi` and the
/// operators + - * / ^. Functions are sqrt, exp, log, expm1, log1p, sin, cos, tan, asin, acos,
/// atan, atan2, abs, min, max and `float`. `^` associates to the right and binds more tightly than
/// the sign. `float` rounds to float32, as the renderer does with its inputs. Angles are radians.
/// Throws `Error` (bad input) with the formula and the position.
double evaluate(const std::string &formula, const Names &names);

}  // namespace rtrays
