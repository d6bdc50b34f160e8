// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <map>
#include <string>
#include <vector>

namespace rtrays {

/// What an import leaves out or changes: each kind is told once, however many objects it happened
/// to.
class ModelNotes {
  public:
    explicit ModelNotes(std::string file) : file_(std::move(file)) {}

    /// `name` is the object concerned; empty when the text says it all.
    void add(const std::string &text, const std::string &name = {});

    /// Sends a `notice` for every kind: "FILE: TEXT (3: a, b, c)".
    void tell() const;

  private:
    struct Objects {
        size_t count = 0;
        std::vector<std::string> first;
    };
    std::string file_;
    std::map<std::string, Objects> notes_;
};

}  // namespace rtrays
