// SPDX-License-Identifier: MIT
// Child processes that answer line by line.
#pragma once

#include <sys/types.h>

#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace rtrays {

/// A running child process whose standard input and output are connected to this program. The
/// destructor closes both, asks the process to terminate and waits for it.
class Process {
  public:
    /// Starts the program `command[0]`, which is searched in the PATH of this program. The process
    /// has the environment of this program, with the variables of `environment` replaced. If the
    /// program does not exist, the process ends at once without output. Throws `Error` (run failed)
    /// if no process can be created.
    explicit Process(const std::vector<std::string> &command,
                     const std::vector<std::pair<std::string, std::string>> &environment = {});
    ~Process();
    Process(const Process &) = delete;
    Process &operator=(const Process &) = delete;

    /// Writes the text; returns whether all of it could be written.
    bool write(const std::string &text);

    /// Closes the standard input of the process, which reads its end.
    void end_input();

    /// Returns the next line without its line end, or nothing after the program closed its output.
    std::optional<std::string> read_line();

    /// Waits until the program ends and returns its exit code: 127 if the program does not exist,
    /// 128 plus the signal number if a signal ended it.
    int wait();

    /// Returns the exit code as `wait` does if the program has ended. Does not wait.
    std::optional<int> ended();

  private:
    pid_t process_ = -1;
    int to_ = -1, from_ = -1;
    std::string read_ahead_;
};

/// Returns whether `Process` finds a program: a file that may be executed, whose name has a slash
/// or which is in a folder of the PATH.
bool program_exists(const std::string &program);

/// Returns a PATH with Debian's Python first. Blender takes the packages of its Python from the
/// installation of the first python3 in the PATH.
std::vector<std::pair<std::string, std::string>> python_environment();

}  // namespace rtrays
