// SPDX-License-Identifier: MIT
// Which sources a program was built from. In one object file only: programs of equal code differ by
// nothing else.
#pragma once

#include <string>

namespace rtrays {

/// The commit, 12 hexadecimal digits, or "unknown" where the sources are no git repository.
std::string commit();

/// Whether the sources differed from that commit.
bool built_from_changed_sources();

/// Both as one text: the commit, with "-dirty" behind it where the sources were changed.
std::string version();

/// The running program's own bytes without the commit, hashed: equal for builds of equal code by
/// the same compiler in the same folder. Throws `Error` (bad input) where the program cannot be
/// read.
std::string program_hash();

}  // namespace rtrays
