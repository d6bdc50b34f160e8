// SPDX-License-Identifier: MIT
#include "renderer/import/models/assimp.h"

#include <assimp/DefaultIOSystem.h>
#include <assimp/MemoryIOWrapper.h>
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
#include <string>
#include <utility>

#include "renderer/base/error.h"
#include "renderer/base/files.h"
#include "renderer/base/progress.h"
#include "renderer/import/models/scene.h"

namespace rtrays {

namespace {

/// A function that reads a scene with an importer.
using Read = std::function<const aiScene *(Assimp::Importer &)>;

/// Marker in the stream that the child writes. Bytes before it are progress in percent. The text
/// after it is the reason of a failure.
constexpr uint8_t failure = 255;

/// Writes Assimp's progress in percent to a pipe.
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

/// The file system, with another content of one file.
class ReplacedFile : public Assimp::DefaultIOSystem {
  public:
    ReplacedFile(std::string path, const std::string &content)
        : path_(std::move(path)), content_(content) {}

    Assimp::IOStream *Open(const char *file, const char *mode) override {
        if (path_ != file) {
            return DefaultIOSystem::Open(file, mode);
        }
        return new Assimp::MemoryIOStream(reinterpret_cast<const uint8_t *>(content_.data()),
                                          content_.size());
    }

  private:
    std::string path_;
    const std::string &content_;
};

/// Sets a soft limit, which raises a signal, and a hard limit, which ends the process.
void set_limit(decltype(RLIMIT_CPU) resource, rlim_t value, rlim_t last) {
    const rlimit limit{value, last};
    setrlimit(resource, &limit);
}

/// Limits memory to the present use plus half of the machine's memory. A model that needs more to
/// read could not be rendered. With the address sanitizer no limit is set, because it reserves more
/// than any limit.
void limit_memory() {
#ifndef __SANITIZE_ADDRESS__
    size_t pages = 0;
    std::ifstream("/proc/self/statm") >> pages;
    const auto page = static_cast<rlim_t>(sysconf(_SC_PAGESIZE));
    const rlim_t most = page * (pages + static_cast<rlim_t>(sysconf(_SC_PHYS_PAGES)) / 2);
    set_limit(RLIMIT_AS, most, most);
#endif
}

/// Limit of processor time in seconds for a file of this size. It allows a tenth of the speed of
/// the slowest readers.
rlim_t time_limit(uintmax_t bytes) {
    return 20 + static_cast<rlim_t>(bytes / 200000);
}

void configure(Assimp::Importer &importer) {
    // Otherwise every node of an FBX file becomes a chain of nodes.
    importer.SetPropertyBool(AI_CONFIG_IMPORT_FBX_PRESERVE_PIVOTS, false);
}

/// Reads the file in the child process and reports through `pipe`. If other threads held locks at
/// the fork, only async-signal-safe calls would be sure to work. But glibc makes its allocator safe
/// across fork, and Assimp shares no other lock with this program.
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
            // Destroying the scene can fail, too.
            importer.FreeScene();
            _exit(0);
        }
    } catch (const std::bad_alloc &) {
        reason = "not enough memory";
    } catch (const std::exception &error) {
        reason = error.what();
    } catch (...) {
        reason = "unknown error";
    }
    reason.insert(reason.begin(), static_cast<char>(failure));
    _exit(write(pipe, reason.data(), reason.size()) < 0 ? 2 : 1);
}

/// Shows the progress of the child until it ends. Returns the reason of its failure, if any.
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

/// Throws unless a child process can read the file.
void try_in_child(const Read &read, const std::filesystem::path &path, bool quiet) {
    const rlim_t seconds = time_limit(std::filesystem::file_size(path));
    int ends[2];
    if (pipe2(ends, O_CLOEXEC) != 0) {
        throw run_error(
            fmt::format("{}: cannot create a pipe: {}", path.string(), std::strerror(errno)));
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
            fmt::format("{}: cannot start a process: {}", path.string(), std::strerror(errno)));
    }
    if (interrupted()) {
        throw Error(ExitCode::interrupted, "interrupted");
    }
    if (WIFSIGNALED(status) && WTERMSIG(status) == SIGXCPU) {
        reason = fmt::format("the reader (Assimp) did not finish within {} s of processor time",
                             seconds);
    } else if (WIFSIGNALED(status) || (WEXITSTATUS(status) != 0 && reason.empty())) {
        reason = fmt::format(
            "the reader (Assimp) crashed{}; the file is damaged",
            WIFSIGNALED(status) ? fmt::format(" ({})", strsignal(WTERMSIG(status))) : "");
    }
    if (status != 0) {
        throw input_error(fmt::format("{}: cannot read the model: {}", path.string(), reason));
    }
}

std::shared_ptr<const aiScene> read_fenced(const Read &read, const std::filesystem::path &path,
                                           bool quiet) {
    if (!is_file(path)) {
        throw input_error(fmt::format("{}: no such file", path.string()));
    }
    try_in_child(read, path, quiet);
    const auto importer = std::make_shared<Assimp::Importer>();
    configure(*importer);
    const aiScene *scene = read(*importer);
    if (scene == nullptr) {
        throw input_error(fmt::format("{}: cannot read the model: {}", path.string(),
                                      importer->GetErrorString()));
    }
    return {importer, scene};
}

}  // namespace

bool assimp_reads(const std::string &extension) {
    // Assimp's reader of its own binary format checks nothing. One damaged file in ten crashes it.
    return extension != ".assbin" && Assimp::Importer().IsExtensionSupported(extension.c_str());
}

std::shared_ptr<const aiScene> read_by_assimp(const std::filesystem::path &path,
                                              const std::string &content, bool quiet) {
    const auto read = [&](Assimp::Importer &importer) {
        if (!content.empty()) {
            importer.SetIOHandler(new ReplacedFile(path.string(), content));  // owns it
        }
        return importer.ReadFile(path.string(), 0);
    };
    return read_fenced(read, path, quiet);
}

}  // namespace rtrays
