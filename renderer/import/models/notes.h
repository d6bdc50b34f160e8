// SPDX-License-Identifier: MIT
// Notices of a model import.
#pragma once

#include <cstddef>
#include <map>
#include <string>
#include <vector>

namespace rtrays {

/// Collects what an import ignores or changes. Each kind of change is reported once, with the
/// number of objects concerned.
class ModelNotes {
  public:
    explicit ModelNotes(std::string file) : file_(std::move(file)) {}

    /// Adds a note about the object `name`, or about the full file if `name` is empty.
    void add(const std::string &text, const std::string &name = {});

    /// Sends one `notice` per text, such as "FILE: TEXT (3: a, b, c)".
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
