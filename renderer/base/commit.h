// SPDX-License-Identifier: MIT
// The sources that a program was built from. Only one object file contains them, so that programs
// of equal code differ in nothing else.
#pragma once

#include <string>

namespace rtrays {

/// Returns the commit as 12 hexadecimal digits, or "unknown" if the sources are not a git
/// repository.
std::string commit();

/// Returns whether the sources differed from that commit.
bool built_from_changed_sources();

/// Returns the commit, followed by "-dirty" if the sources differed from it.
std::string version();

/// Version and commit of a program as its `--version` prints them: "rtrays-render 0.1.0 (commit)".
std::string program_version(const std::string &program);

/// Returns a hash of the running program's own bytes without the commit. It is equal for builds of
/// equal code by the same compiler in the same folder. Throws `Error` (bad input) if the program
/// cannot be read.
std::string program_hash();

}  // namespace rtrays
