// SPDX-License-Identifier: MIT
#include "renderer/base/shell.h"

#include <algorithm>
#include <cctype>
#include <cstring>

namespace rtrays {

namespace fs = std::filesystem;

std::string in_shell(const fs::path &path) {
    const std::string text = path.string();
    const bool is_plain = std::all_of(text.begin(), text.end(), [](unsigned char c) {
        return std::isalnum(c) != 0 || std::strchr("_./-+,=:@%", c) != nullptr;
    });
    std::string quoted = "'";
    for (const char c : text) {
        quoted += c == '\'' ? "'\\''" : std::string(1, c);
    }
    return is_plain && !text.empty() ? text : quoted + "'";
}

fs::path sibling_program(const std::string &name) {
    std::error_code unknown;  // without /proc, the name alone is the answer
    const fs::path own = fs::read_symlink("/proc/self/exe", unknown);
    const fs::path sibling = own.parent_path() / name;
    const fs::path relative = fs::proximate(sibling, unknown);
    return unknown ? fs::path(name) : *relative.begin() == ".." ? sibling : relative;
}

}  // namespace rtrays
