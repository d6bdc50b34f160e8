// SPDX-License-Identifier: MIT
// Headers of libraries that most files include anyway, parsed once for every target. Files name
// what they use all the same: with -DCMAKE_DISABLE_PRECOMPILE_HEADERS=ON, as the debug preset has
// it, all compile without.
#pragma once

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <Eigen/Dense>
#include <algorithm>
#include <filesystem>
#include <functional>
#include <map>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>
