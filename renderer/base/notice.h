// SPDX-License-Identifier: MIT
// Notices: messages to the user that are not errors.
#pragma once

#include <functional>
#include <string>

namespace rtrays {

/// Informs the user that the program departs from its input: prints "notice: TEXT" on stderr, or
/// passes the text to the current `NoticeReceiver`.
void notice(const std::string &text);

/// Redirects notices to `receive` during its lifetime. Not thread-safe.
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
