// SPDX-License-Identifier: MIT
#include "renderer/import/mitsuba/error_list.h"

#include <fmt/format.h>

namespace rtrays::mitsuba {

void ErrorList::raise(const std::string &source_name) const {
    if (messages_.empty()) {
        return;
    }
    if (messages_.size() == 1) {
        throw LocatedError(messages_.front());
    }
    constexpr size_t most = 100;
    std::string text = fmt::format("{}: {} errors", source_name, messages_.size());
    for (size_t i = 0; i < messages_.size() && i < most; ++i) {
        text += "\n" + messages_[i];
    }
    throw LocatedError(messages_.size() > most ? text + "\n..." : text, messages_);
}

}  // namespace rtrays::mitsuba
