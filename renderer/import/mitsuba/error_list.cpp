// SPDX-License-Identifier: MIT
#include "renderer/import/mitsuba/error_list.h"

#include <fmt/format.h>

#include <algorithm>

namespace rtrays::mitsuba {

void ErrorList::raise(const std::string &source_name) const {
    if (messages_.empty()) {
        return;
    }
    if (messages_.size() == 1) {
        throw LocatedError(messages_.front());
    }
    // A scene may lack hundreds of files. What is unsupported comes before them.
    std::vector<std::string> sorted = messages_;
    std::stable_partition(sorted.begin(), sorted.end(), [](const std::string &message) {
        return message.find(": cannot find '") == std::string::npos;
    });
    constexpr size_t most = 100;
    std::string text = fmt::format("{}: {} errors", source_name, sorted.size());
    for (size_t i = 0; i < sorted.size() && i < most; ++i) {
        text += "\n" + sorted[i];
    }
    throw LocatedError(sorted.size() > most ? text + "\n..." : text, sorted);
}

}  // namespace rtrays::mitsuba
