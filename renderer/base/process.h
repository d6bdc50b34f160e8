// SPDX-License-Identifier: MIT
// Another program that answers line by line.
#pragma once

#include <sys/types.h>

#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace rtrays {

/// A running program whose standard input and output are ours. The destructor closes both ends,
/// asks it to stop and waits for it.
class Process {
  public:
    /// Looks for `command[0]` in the PATH; `environment` is added to ours. A program that is not
    /// there ends at once without a word. Throws `Error` (run failed) where no process can be made.
    explicit Process(const std::vector<std::string> &command,
                     const std::vector<std::pair<std::string, std::string>> &environment = {});
    ~Process();
    Process(const Process &) = delete;
    Process &operator=(const Process &) = delete;

    /// Whether all of the text could be written.
    bool write(const std::string &text);

    /// The next line without its end; nothing once the program has closed its output.
    std::optional<std::string> read_line();

    /// Waits for the end of the program: its exit code, 127 where it is not there, 128 and the
    /// signal where one ended it.
    int wait();

  private:
    pid_t process_ = -1;
    int to_ = -1, from_ = -1;
    std::string read_ahead_;
};

/// Debian's Python first in the PATH: Blender takes its Python's packages from where the first
/// python3 is.
std::vector<std::pair<std::string, std::string>> python_environment();

}  // namespace rtrays
