// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <cctype>
#include <filesystem>
#include <string>
#include <unordered_map>
#include <unordered_set>

namespace rtrays {

/// The extension of a file in small letters: ".obj".
inline std::string lower_extension(const std::filesystem::path &path) {
    std::string extension = path.extension().string();
    std::transform(extension.begin(), extension.end(), extension.begin(),
                   [](unsigned char letter) { return static_cast<char>(std::tolower(letter)); });
    return extension;
}

/// Makes the names of a model file names of ours: unique, not empty, without dots.
class ModelNames {
  public:
    /// `wanted`, or `fallback` where that is empty, with a number behind it when it is taken.
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
