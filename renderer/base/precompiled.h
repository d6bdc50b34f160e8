// SPDX-License-Identifier: MIT
// Library headers that most files include, parsed once for all targets. Files must still include
// what they use: they also compile with -DCMAKE_DISABLE_PRECOMPILE_HEADERS=ON, which the debug
// preset sets.
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
