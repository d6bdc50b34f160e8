// SPDX-License-Identifier: MIT
// The folder in which PoCL caches compiled kernels. PoCL needs it, and damage there ends the
// program without a word of PoCL's own.
#pragma once

#include <string>

namespace rtrays {

/// Returns the folder in which PoCL caches kernels: that of POCL_CACHE_DIR, XDG_CACHE_HOME or HOME.
std::string pocl_cache_directory();

/// Returns why PoCL cannot write to its cache, or an empty string if it can. Creates the folder if
/// it is missing.
std::string pocl_cache_fault();

/// Makes the signals with which PoCL ends the program print the folder of its cache first. Former
/// handlers of the signals, such as LLVM's, run afterwards.
void explain_pocl_crashes();

}  // namespace rtrays
