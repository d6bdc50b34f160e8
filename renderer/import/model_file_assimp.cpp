// SPDX-License-Identifier: MIT
#include "renderer/import/model_file_assimp.h"

#include <assimp/config.h>
#include <assimp/scene.h>
#include <fcntl.h>
#include <fmt/format.h>
#include <sys/prctl.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <assimp/Importer.hpp>
#include <assimp/ProgressHandler.hpp>
#include <cerrno>
#include <csignal>
#include <cstring>
#include <exception>
#include <fstream>
#include <functional>
#include <new>

#include "renderer/base/error.h"
#include "renderer/base/progress.h"
#include "renderer/import/model_file_scene.h"

namespace rtrays {

namespace {

/// What to do with an importer: read one thing or another.
using Read = std::function<const aiScene *(Assimp::Importer &)>;

/// What the child writes: one byte of progress in percent at a time, then this byte and why it
/// failed.
constexpr uint8_t failure = 255;

class PercentWriter : public Assimp::ProgressHandler {
  public:
    explicit PercentWriter(int pipe) : pipe_(pipe) {}

    bool Update(float fraction) override {
        const auto percent =
            static_cast<uint8_t>(fraction >= 0 && fraction <= 1 ? 100 * fraction : 0);
        if (percent > last_) {
            last_ = percent;
            return write(pipe_, &percent, 1) == 1;
        }
        return true;
    }

  private:
    int pipe_;
    uint8_t last_ = 0;
};

/// A signal at `value`, the end at `last`.
void set_limit(decltype(RLIMIT_CPU) resource, rlim_t value, rlim_t last) {
    const rlimit limit{value, last};
    setrlimit(resource, &limit);
}

/// Half of the machine's memory beyond what the process has: what a reader needs more for is no
/// model we could render. The address sanitizer reserves more than any limit; it has its own.
void limit_memory() {
#ifndef __SANITIZE_ADDRESS__
    size_t pages = 0;
    std::ifstream("/proc/self/statm") >> pages;
    const auto page = static_cast<rlim_t>(sysconf(_SC_PAGESIZE));
    const rlim_t most = page * (pages + static_cast<rlim_t>(sysconf(_SC_PHYS_PAGES)) / 2);
    set_limit(RLIMIT_AS, most, most);
#endif
}

/// Seconds of processor time for files of so many bytes: a tenth of the speed at which the slowest
/// readers go.
rlim_t time_limit(uintmax_t bytes) {
    return 20 + static_cast<rlim_t>(bytes / 200000);
}

void configure(Assimp::Importer &importer) {
    // Otherwise every node of an FBX file becomes a chain of them.
    importer.SetPropertyBool(AI_CONFIG_IMPORT_FBX_PRESERVE_PIVOTS, false);
}

/// Only async-signal-safe calls would be sure to work if other threads held locks; glibc makes its
/// allocator safe across fork, and Assimp shares no other lock with us.
[[noreturn]] void read_in_child(const Read &read, rlim_t seconds, int pipe) {
    prctl(PR_SET_PDEATHSIG, SIGKILL);
    for (const int signal : {SIGINT, SIGTERM, SIGSEGV, SIGABRT, SIGXCPU}) {
        std::signal(signal, SIG_DFL);
    }
    const int nowhere = open("/dev/null", O_WRONLY);
    dup2(nowhere, STDOUT_FILENO);
    dup2(nowhere, STDERR_FILENO);
    set_limit(RLIMIT_CORE, 0, 0);
    set_limit(RLIMIT_CPU, seconds, seconds + 5);
    limit_memory();
    std::string reason;
    try {
        PercentWriter progress(pipe);
        Assimp::Importer importer;
        configure(importer);
        importer.SetProgressHandler(&progress);
        const bool ok = read(importer) != nullptr;
        reason = importer.GetErrorString();
        importer.SetProgressHandler(nullptr);
        if (ok) {
            // Taking the scene apart is part of what can go wrong.
            importer.FreeScene();
            _exit(0);
        }
    } catch (const std::bad_alloc &) {
        reason = "it needs more memory than there is";
    } catch (const std::exception &error) {
        reason = error.what();
    } catch (...) {
        reason = "unknown error";
    }
    reason.insert(reason.begin(), static_cast<char>(failure));
    _exit(write(pipe, reason.data(), reason.size()) < 0 ? 2 : 1);
}

/// Reads what the child has to say until it ends; the reason of its failure.
std::string listen(int pipe, Progress &progress) {
    std::string reason;
    bool failed = false;
    uint8_t bytes[256];
    while (true) {
        const ssize_t count = ::read(pipe, bytes, sizeof bytes);
        if (count < 0 && errno == EINTR) {
            continue;
        }
        if (count <= 0) {
            return reason;
        }
        for (ssize_t i = 0; i < count; ++i) {
            if (failed) {
                reason.push_back(static_cast<char>(bytes[i]));
            } else if (bytes[i] == failure) {
                failed = true;
            } else {
                progress.update(bytes[i]);
            }
        }
    }
}

/// Throws unless a child process can read it.
void try_in_child(const Read &read, const std::filesystem::path &path, bool quiet) {
    const rlim_t seconds = time_limit(std::filesystem::file_size(path));
    int ends[2];
    if (pipe2(ends, O_CLOEXEC) != 0) {
        throw run_error(fmt::format("{}: no pipe: {}", path.string(), std::strerror(errno)));
    }
    const pid_t child = fork();
    if (child == 0) {
        read_in_child(read, seconds, ends[1]);
    }
    close(ends[1]);
    std::string reason;
    {
        Progress progress("reading " + path.filename().string(), 100, "%", quiet);
        reason = listen(ends[0], progress);
    }
    close(ends[0]);
    int status = 0;
    pid_t waited = child;
    while (child > 0 && (waited = waitpid(child, &status, 0)) < 0 && errno == EINTR) {
    }
    if (child < 0 || waited < 0) {
        throw run_error(
            fmt::format("{}: no process to read it in: {}", path.string(), std::strerror(errno)));
    }
    if (interrupted()) {
        throw Error(ExitCode::interrupted, "interrupted");
    }
    if (WIFSIGNALED(status) && WTERMSIG(status) == SIGXCPU) {
        reason = fmt::format("the reader (Assimp) came to no end within {} s of processor time",
                             seconds);
    } else if (WIFSIGNALED(status) || (WEXITSTATUS(status) != 0 && reason.empty())) {
        reason = fmt::format(
            "the reader (Assimp) broke down on it{}; the file is damaged",
            WIFSIGNALED(status) ? fmt::format(" ({})", strsignal(WTERMSIG(status))) : "");
    }
    if (status != 0) {
        throw input_error(fmt::format("{}: cannot be read: {}", path.string(), reason));
    }
}

std::shared_ptr<const aiScene> read_fenced(const Read &read, const std::filesystem::path &path,
                                           bool quiet) {
    if (!std::filesystem::is_regular_file(path)) {
        throw input_error(fmt::format("{}: no such file", path.string()));
    }
    try_in_child(read, path, quiet);
    const auto importer = std::make_shared<Assimp::Importer>();
    configure(*importer);
    const aiScene *scene = read(*importer);
    if (scene == nullptr) {
        throw input_error(
            fmt::format("{}: cannot be read: {}", path.string(), importer->GetErrorString()));
    }
    return {importer, scene};
}

}  // namespace

bool assimp_reads(const std::string &extension) {
    // Assimp's own binary dump trusts every byte of itself (one damaged file in ten kills it).
    return extension != ".assbin" && Assimp::Importer().IsExtensionSupported(extension.c_str());
}

std::shared_ptr<const aiScene> read_by_assimp(const std::filesystem::path &path, bool quiet) {
    return read_fenced(
        [&](Assimp::Importer &importer) { return importer.ReadFile(path.string(), 0); }, path,
        quiet);
}

std::shared_ptr<const aiScene> read_mtl_by_assimp(const std::filesystem::path &path) {
    // An OBJ file of one triangle, in memory, that names the MTL file.
    const std::string model = fmt::format("mtllib {}\nv 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n",
                                          std::filesystem::absolute(path).string());
    return read_fenced(
        [&](Assimp::Importer &importer) {
            return importer.ReadFileFromMemory(model.data(), model.size(), 0, "obj");
        },
        path, true);
}

}  // namespace rtrays
