// SPDX-License-Identifier: MIT
#include "experiments/frames/peer.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/wait.h>
#include <unistd.h>

#include <csignal>
#include <nlohmann/json.hpp>

#include "renderer/base/error.h"

namespace rtrays {

namespace fs = std::filesystem;

MitsubaPeer::MitsubaPeer(const fs::path &scene, const std::string &variant) {
    const std::string python = RTRAYS_SOURCE "/build/peers/bin/python";
    const std::string driver = RTRAYS_SCRIPTS "/mitsuba_driver.py";
    if (!fs::exists(python)) {
        return;
    }
    int down[2], up[2];
    if (pipe2(down, O_CLOEXEC) != 0 || pipe2(up, O_CLOEXEC) != 0) {  // no other process is to hold the ends
        throw run_error("no pipe to Mitsuba's process");
    }
    std::signal(SIGPIPE, SIG_IGN);  // of a process that has ended: the answer that does not come tells
    process_ = fork();
    if (process_ == 0) {
        dup2(down[0], STDIN_FILENO);
        dup2(up[1], STDOUT_FILENO);
        execl(python.c_str(), python.c_str(), driver.c_str(), scene.c_str(), "--serve", "--variant",
              variant.c_str(), nullptr);
        _exit(127);
    }
    close(down[0]);
    close(up[1]);
    to_ = down[1];
    from_ = up[0];
    const std::string hello = process_ > 0 ? read_line() : "";
    if (!hello.empty()) {
        engine_ = nlohmann::json::parse(hello).at("engine");
    }
}

MitsubaPeer::~MitsubaPeer() {
    for (const int end : {to_, from_}) {
        if (end >= 0) {
            close(end);
        }
    }
    if (process_ > 0) {
        waitpid(process_, nullptr, 0);
    }
}

/// Empty at the end of what the process says.
std::string MitsubaPeer::read_line() {
    std::string line;
    for (char c = 0; read(from_, &c, 1) == 1;) {
        if (c == '\n') {
            return line;
        }
        line += c;
    }
    return {};
}

Seconds MitsubaPeer::render(uint32_t max_depth, uint64_t spp) {
    const std::string command = fmt::format("{} {} {}\n", max_depth, spp, ++seed_);
    const bool written = write(to_, command.data(), command.size()) == static_cast<ssize_t>(command.size());
    const std::string answer = written ? read_line() : "";
    if (answer.empty()) {
        throw run_error(fmt::format("{} ended before its image was done", engine_));
    }
    const nlohmann::json seconds = nlohmann::json::parse(answer);
    return {seconds.at("seconds"), seconds.at("processor_seconds")};
}

}  // namespace rtrays
