// SPDX-License-Identifier: MIT
#include "renderer/base/notice.h"

#include <fmt/format.h>

#include <cstdio>
#include <utility>

namespace rtrays {

namespace {

std::function<void(const std::string &)> &receiver() {
    static std::function<void(const std::string &)> current = [](const std::string &text) {
        fmt::print(stderr, "notice: {}\n", text);
    };
    return current;
}

}  // namespace

void notice(const std::string &text) {
    receiver()(text);
}

NoticeReceiver::NoticeReceiver(std::function<void(const std::string &)> receive)
    : previous_(std::exchange(receiver(), std::move(receive))) {}

NoticeReceiver::~NoticeReceiver() {
    receiver() = std::move(previous_);
}

}  // namespace rtrays
