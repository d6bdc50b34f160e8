// SPDX-License-Identifier: MIT
// Collection of the errors of a scene file, so that one message lists all of them.
#pragma once

#include <optional>
#include <string>
#include <type_traits>
#include <unordered_set>
#include <utility>
#include <vector>

#include "renderer/base/error.h"

namespace rtrays::mitsuba {

/// An `Error` whose message already contains a location.
struct LocatedError : Error {
    explicit LocatedError(const std::string &message) : LocatedError(message, {message}) {}
    LocatedError(const std::string &message, std::vector<std::string> each)
        : Error(ExitCode::bad_input, message), messages(std::move(each)) {}

    std::vector<std::string> messages;  ///< one per error
};

/// The errors of a file or of an element, each once.
class ErrorList {
  public:
    /// Runs `body` and adds its errors of bad input. Returns its result, if there is one.
    template <typename Body>
    auto collect(const Body &body) {
        using Result = std::invoke_result_t<Body>;
        std::conditional_t<std::is_void_v<Result>, bool, std::optional<Result>> result{};
        try {
            if constexpr (std::is_void_v<Result>) {
                body();
                result = true;
            } else {
                result.emplace(body());
            }
        } catch (const LocatedError &error) {
            for (const std::string &message : error.messages) {
                add(message);
            }
        } catch (const Error &error) {
            if (error.exit_code() != ExitCode::bad_input) {
                throw;
            }
            add(error.what());
        }
        return result;
    }

    bool empty() const { return messages_.empty(); }

    /// Throws the collected errors as one `LocatedError`, if there are any. The message of several
    /// errors begins with their number and shows the first 100, with missing files last.
    void raise(const std::string &source_name) const;

  private:
    void add(const std::string &message) {
        if (known_.insert(message).second) {
            messages_.push_back(message);
        }
    }

    std::vector<std::string> messages_;
    std::unordered_set<std::string> known_;
};

}  // namespace rtrays::mitsuba
