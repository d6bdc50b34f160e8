// SPDX-License-Identifier: MIT
// Text in lower case, independent of the locale.
#pragma once

#include <filesystem>
#include <string>
#include <string_view>

namespace rtrays {

/// Returns text with ASCII letters in lower case.
inline std::string in_lower_case(std::string_view text) {
    std::string lower(text);
    for (char &letter : lower) {
        letter = letter >= 'A' && letter <= 'Z' ? static_cast<char>(letter - 'A' + 'a') : letter;
    }
    return lower;
}

/// Returns the extension of a file in lower case, such as ".obj".
inline std::string lower_extension(const std::filesystem::path &path) {
    return in_lower_case(path.extension().string());
}

}  // namespace rtrays
