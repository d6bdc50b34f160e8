// SPDX-License-Identifier: MIT
// Floating-point traps for programs built with TRAPS (CMakeLists.txt). They stop at an operation
// without a result: inf - inf, 0 x inf, 0 / 0, the root of a negative number, an ordered comparison
// with a NaN. Code that means to execute such an operation holds an InvalidAllowed.
#pragma once

#include <cfenv>

namespace rtrays::test {

/// Enables the traps in this thread and in all threads that it starts later.
inline void trap_invalid() {
    feenableexcept(FE_INVALID);
}

/// Disables the traps in this thread during its lifetime.
class InvalidAllowed {
  public:
    InvalidAllowed() : before_(fedisableexcept(FE_INVALID)) {}
    ~InvalidAllowed() {
        std::feclearexcept(FE_INVALID);
        feenableexcept(before_);
    }
    InvalidAllowed(const InvalidAllowed &) = delete;
    InvalidAllowed &operator=(const InvalidAllowed &) = delete;

  private:
    int before_;
};

}  // namespace rtrays::test
