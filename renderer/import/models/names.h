// SPDX-License-Identifier: MIT
// Object names of model files.
#pragma once

#include <string>
#include <unordered_map>
#include <unordered_set>

namespace rtrays {

/// Source of legal object names: unique, not empty and without dots.
class ModelNames {
  public:
    /// Returns `wanted`, or `fallback` if that is empty. Appends a number to a repeated name.
    std::string unique(const std::string &wanted, const std::string &fallback) {
        std::string name = wanted.empty() ? fallback : wanted;
        for (char &letter : name) {
            letter = letter == '.' ? '_' : letter;
        }
        std::string tried = name;
        while (!taken_.insert(tried).second) {
            tried = name + "_" + std::to_string(++last_[name] + 1);
        }
        return tried;
    }

  private:
    std::unordered_set<std::string> taken_;
    std::unordered_map<std::string, size_t> last_;
};

}  // namespace rtrays
