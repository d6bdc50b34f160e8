// SPDX-License-Identifier: MIT
#pragma once

#include <functional>
#include <string>

namespace rtrays {

/// Tells the user what a program does otherwise than its input says: a line "notice: TEXT" on
/// stderr.
void notice(const std::string &text);

/// While it lives, notices go to `receive` instead (not from several threads at once).
class NoticeReceiver {
  public:
    explicit NoticeReceiver(std::function<void(const std::string &)> receive);
    ~NoticeReceiver();
    NoticeReceiver(const NoticeReceiver &) = delete;
    NoticeReceiver &operator=(const NoticeReceiver &) = delete;

  private:
    std::function<void(const std::string &)> previous_;
};

}  // namespace rtrays
