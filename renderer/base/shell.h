// SPDX-License-Identifier: MIT
// Words of the command lines that messages print.
#pragma once

#include <filesystem>
#include <string>

namespace rtrays {

/// Returns a path as one word of a shell's command line.
std::string in_shell(const std::filesystem::path &path);

/// Returns the path of a program that is installed or built beside the running one, relative to the
/// working directory if it is below.
std::filesystem::path sibling_program(const std::string &name);

}  // namespace rtrays
