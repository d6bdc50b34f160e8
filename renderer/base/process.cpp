// SPDX-License-Identifier: MIT
#include "renderer/base/process.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <csignal>
#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <map>
#include <sstream>

#include "renderer/base/error.h"
#include "renderer/base/files.h"

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

/// Returns the variables "NAME=VALUE" of this program, with those of `environment` replaced.
std::vector<std::string> merged_environment(
    const std::vector<std::pair<std::string, std::string>> &environment) {
    std::map<std::string, std::string> variables;
    for (char **variable = environ; *variable != nullptr; ++variable) {
        const std::string text = *variable;
        const size_t equals = text.find('=');
        if (equals != std::string::npos) {
            variables[text.substr(0, equals)] = text.substr(equals + 1);
        }
    }
    for (const auto &[name, value] : environment) {
        variables[name] = value;
    }
    std::vector<std::string> texts;
    for (const auto &[name, value] : variables) {
        texts.push_back(name + "=" + value);
    }
    return texts;
}

/// Returns the null-terminated array that exec and spawn take; they do not write to it.
std::vector<char *> pointers_to(const std::vector<std::string> &texts) {
    std::vector<char *> pointers;
    for (const std::string &text : texts) {
        pointers.push_back(const_cast<char *>(text.c_str()));
    }
    pointers.push_back(nullptr);
    return pointers;
}

/// Returns the exit code of a status of `waitpid`, or 128 plus the number of a signal.
int exit_code(int status) {
    return WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status);
}

}  // namespace

bool program_exists(const std::string &program) {
    const auto is_program = [](const std::filesystem::path &path) {
        return is_file(path) && access(path.c_str(), X_OK) == 0;
    };
    if (program.find('/') != std::string::npos) {
        return is_program(program);
    }
    const char *path = std::getenv("PATH");
    std::istringstream folders(path != nullptr ? path : "");
    for (std::string folder; std::getline(folders, folder, ':');) {
        if (is_program(std::filesystem::path(folder) / program)) {
            return true;
        }
    }
    return false;
}

std::vector<std::pair<std::string, std::string>> python_environment() {
    const char *path = std::getenv("PATH");
    return {{"PATH", fmt::format("/usr/bin:{}", path != nullptr ? path : "/bin")}};
}

Process::Process(const std::vector<std::string> &command,
                 const std::vector<std::pair<std::string, std::string>> &environment) {
    const std::vector<std::string> variables = merged_environment(environment);
    std::vector<char *> arguments = pointers_to(command), environ_of_child = pointers_to(variables);
    const auto down = make_pipe(), up = make_pipe();
    // Writing to a program that has ended fails instead of raising SIGPIPE; the missing answer then
    // shows that the program has ended.
    std::signal(SIGPIPE, SIG_IGN);
    posix_spawn_file_actions_t actions;
    posix_spawn_file_actions_init(&actions);
    posix_spawn_file_actions_adddup2(&actions, down[0], STDIN_FILENO);
    posix_spawn_file_actions_adddup2(&actions, up[1], STDOUT_FILENO);
    const int error = posix_spawnp(&process_, arguments[0], &actions, nullptr, arguments.data(),
                                   environ_of_child.data());
    posix_spawn_file_actions_destroy(&actions);
    close(down[0]);
    close(up[1]);
    to_ = down[1];
    from_ = up[0];
    if (error != 0) {
        process_ = -1;
        if (error != ENOENT) {
            close(to_);
            close(from_);
            throw run_error(
                fmt::format("cannot start {}: {}", command.front(), std::strerror(error)));
        }
    }
}

Process::~Process() {
    if (to_ >= 0) {
        close(to_);
    }
    close(from_);
    if (process_ > 0) {
        kill(process_, SIGTERM);
        wait();
    }
}

bool Process::write(const std::string &text) {
    return ::write(to_, text.data(), text.size()) == static_cast<ssize_t>(text.size());
}

void Process::end_input() {
    close(to_);
    to_ = -1;
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
    if (process_ < 0) {
        return not_found;
    }
    int status = 0;
    while (process_ > 0 && waitpid(process_, &status, 0) < 0) {
        if (errno != EINTR) {
            break;
        }
    }
    process_ = -1;
    return exit_code(status);
}

std::optional<int> Process::ended() {
    if (process_ < 0) {
        return not_found;
    }
    int status = 0;
    if (waitpid(process_, &status, WNOHANG) != process_) {
        return std::nullopt;
    }
    process_ = -1;
    return exit_code(status);
}

}  // namespace rtrays
