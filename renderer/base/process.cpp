// SPDX-License-Identifier: MIT
#include "renderer/base/process.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <csignal>
#include <cstdlib>
#include <cstring>

#include "renderer/base/error.h"

namespace rtrays {

namespace {

constexpr int not_found = 127;  // exit code of a shell for an unknown command

std::array<int, 2> make_pipe() {
    std::array<int, 2> ends{};
    if (pipe2(ends.data(), O_CLOEXEC) != 0) {  // no other child process inherits the ends
        throw run_error(
            fmt::format("cannot create a pipe to another program: {}", std::strerror(errno)));
    }
    return ends;
}

}  // namespace

std::vector<std::pair<std::string, std::string>> python_environment() {
    const char *path = std::getenv("PATH");
    return {{"PATH", fmt::format("/usr/bin:{}", path != nullptr ? path : "/bin")}};
}

Process::Process(const std::vector<std::string> &command,
                 const std::vector<std::pair<std::string, std::string>> &environment) {
    std::vector<char *> arguments;
    for (const std::string &word : command) {
        arguments.push_back(const_cast<char *>(word.c_str()));
    }
    arguments.push_back(nullptr);
    const auto down = make_pipe(), up = make_pipe();
    // Writing to a program that has ended fails instead of raising SIGPIPE; the missing answer then
    // shows that the program has ended.
    std::signal(SIGPIPE, SIG_IGN);
    process_ = fork();
    if (process_ < 0) {
        throw run_error(fmt::format("cannot start {}: {}", command.front(), std::strerror(errno)));
    }
    if (process_ == 0) {
        for (const auto &[name, value] : environment) {
            setenv(name.c_str(), value.c_str(), 1);
        }
        dup2(down[0], STDIN_FILENO);
        dup2(up[1], STDOUT_FILENO);
        execvp(arguments[0], arguments.data());
        _exit(not_found);
    }
    close(down[0]);
    close(up[1]);
    to_ = down[1];
    from_ = up[0];
}

Process::~Process() {
    close(to_);
    close(from_);
    if (process_ > 0) {
        kill(process_, SIGTERM);
        wait();
    }
}

bool Process::write(const std::string &text) {
    return ::write(to_, text.data(), text.size()) == static_cast<ssize_t>(text.size());
}

std::optional<std::string> Process::read_line() {
    for (;;) {
        if (const size_t end = read_ahead_.find('\n'); end != std::string::npos) {
            std::string line = read_ahead_.substr(0, end);
            read_ahead_.erase(0, end + 1);
            return line;
        }
        std::array<char, 4096> bytes;
        const ssize_t count = read(from_, bytes.data(), bytes.size());
        if (count < 0 && errno == EINTR) {
            continue;
        }
        if (count <= 0) {
            return std::nullopt;
        }
        read_ahead_.append(bytes.data(), static_cast<size_t>(count));
    }
}

int Process::wait() {
    int status = 0;
    while (process_ > 0 && waitpid(process_, &status, 0) < 0) {
        if (errno != EINTR) {
            break;
        }
    }
    process_ = -1;
    return WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status);
}

}  // namespace rtrays
