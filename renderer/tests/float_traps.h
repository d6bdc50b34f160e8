// SPDX-License-Identifier: MIT
// Programs built with TRAPS (CMakeLists.txt) stop at a floating-point operation that has no result:
// inf - inf, 0 x inf, 0 / 0, the root of a negative number, an order asked of a NaN. What is meant
// to be without is done while an InvalidAllowed lives.
#pragma once

#include <cfenv>

namespace rtrays::test {

/// From here on, in all threads started later, too.
inline void trap_invalid() {
    feenableexcept(FE_INVALID);
}

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
