// SPDX-License-Identifier: MIT
// "Did you mean" for misspelt names.
#pragma once

#include <string>
#include <vector>

namespace rtrays {

/// Returns "did you mean 'NAME'? " with the known name nearest to an unknown one, or an empty text
/// if none is near: more than a third of the letters would have to change (Levenshtein distance).
std::string suggestion(const std::string &unknown, const std::vector<std::string> &known);

}  // namespace rtrays
