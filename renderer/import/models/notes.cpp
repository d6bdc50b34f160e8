// SPDX-License-Identifier: MIT
#include "renderer/import/models/notes.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "renderer/base/notice.h"

namespace rtrays {

void ModelNotes::add(const std::string &text, const std::string &name) {
    constexpr size_t named = 8;
    Objects &objects = notes_[text];
    if (name.empty()) {
        return;
    }
    ++objects.count;
    if (objects.first.size() < named) {
        objects.first.push_back(name);
    }
}

void ModelNotes::tell() const {
    for (const auto &[text, objects] : notes_) {
        const std::string names =
            objects.count == 0
                ? ""
                : fmt::format(" ({}: {}{})", objects.count, fmt::join(objects.first, ", "),
                              objects.count > objects.first.size() ? ", ..." : "");
        notice(fmt::format("{}: {}{}", file_, text, names));
    }
}

}  // namespace rtrays
