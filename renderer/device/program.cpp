// SPDX-License-Identifier: MIT
#include "renderer/device/program.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <fmt/ranges.h>
#include <sys/file.h>
#include <unistd.h>

#include <algorithm>
#include <filesystem>
#include <regex>

#include "renderer/base/clock.h"
#include "renderer/base/error.h"
#include "renderer/base/files.h"
#include "renderer/device/pocl_cache.h"

namespace rtrays {

namespace fs = std::filesystem;

namespace {

/// Exclusive advisory lock on a file, held for the object's lifetime. Without it two processes
/// would only compile the same program twice, so a failure to lock is not an error.
class FileLock {
  public:
    explicit FileLock(const fs::path &path)
        : fd_(open(path.c_str(), O_RDWR | O_CREAT | O_CLOEXEC, 0666)) {
        if (fd_ >= 0) {
            flock(fd_, LOCK_EX);
        }
    }
    ~FileLock() {
        if (fd_ >= 0) {
            close(fd_);
        }
    }
    FileLock(const FileLock &) = delete;
    FileLock &operator=(const FileLock &) = delete;

  private:
    int fd_;
};

/// Replaces line numbers in a build log by file names and lines. NVIDIA's compiler ignores #line
/// and counts the lines of the full text.
std::string with_file_names(const std::string &log, const std::string &source) {
    const std::regex place("<kernel>:([0-9]+)");
    std::string named;
    auto rest = log.begin();
    for (std::sregex_iterator match(log.begin(), log.end(), place), end; match != end; ++match) {
        named.append(rest, (*match)[0].first);
        named += source_place(source, std::stoul((*match)[1]));
        rest = (*match)[0].second;
    }
    return named.append(rest, log.end());
}

std::string build_log(cl_program program, cl_device_id device, const std::string &source) {
    size_t size = 0;
    clGetProgramBuildInfo(program, device, CL_PROGRAM_BUILD_LOG, 0, nullptr, &size);
    std::string log(size, '\0');
    clGetProgramBuildInfo(program, device, CL_PROGRAM_BUILD_LOG, size, log.data(), nullptr);
    log.resize(std::min(log.find('\0'), log.size()));
    return with_file_names(log, source);
}

std::string program_binary(cl_program program) {
    size_t size = 0;
    check_cl(clGetProgramInfo(program, CL_PROGRAM_BINARY_SIZES, sizeof size, &size, nullptr),
             "reading a program's size");
    std::string binary(size, '\0');
    char *pointer = binary.data();
    check_cl(clGetProgramInfo(program, CL_PROGRAM_BINARIES, sizeof pointer, &pointer, nullptr),
             "reading a program's binary");
    return binary;
}

std::string cache_file(const std::string &key) {
    return (fs::path(program_cache_directory()) / (key + ".clbin")).string();
}

}  // namespace

std::string program_options(const DeviceInfo &device) {
    const std::string options = "-cl-std=CL1.2 -cl-kernel-arg-info";
    return device.is_cpu || !device.rounds_division
               ? options
               : options + " -cl-fp32-correctly-rounded-divide-sqrt";
}

std::string program_cache_directory() {
    return cache_directory("RTRAYS_CACHE_DIR", "rtrays");
}

Program::Program(DeviceContext &device, const std::vector<std::string> &paths,
                 const Defines &defines, const SourceOverlays &overlays)
    : device_(&device), paths_(paths) {
    const auto start = SteadyClock::now();
    const std::string text = expand_source(paths, overlays);
    std::string source;
    for (const auto &[name, value] : defines) {
        // Defines that the text does not mention are omitted: they must not change the program's
        // cache key.
        if (text.find(name) != std::string::npos) {
            source += fmt::format("#define {} {}\n", name, value);
        }
    }
    source += text;
    const DeviceInfo &info = device.info();
    const std::string key =
        content_hash(fmt::format("{}\n{}\n{}\n{}\n{}", info.platform_name, info.name, info.driver,
                                 program_options(info), source));
    built_ = device.recent_programs().find(key);
    from_cache_ = built_ != nullptr;
    if (!from_cache_) {
        std::error_code ignored;  // a cache that cannot be created only costs time
        fs::create_directories(program_cache_directory(), ignored);
        const FileLock lock(cache_file(key) + ".lock");
        built_ = load(key);
        from_cache_ = built_ != nullptr;
        if (!from_cache_) {
            built_ = compile(source, key);
        }
        device.recent_programs().add(key, built_);
    }
    build_seconds_ = seconds_since(start);
}

std::shared_ptr<const BuiltProgram> Program::load(const std::string &key) const {
    std::string content;
    try {
        content = read_file(cache_file(key));
    } catch (const Error &) {
        return nullptr;
    }
    if (content.size() < hash_digits ||
        content_hash(content.substr(hash_digits)) != content.substr(0, hash_digits)) {
        return nullptr;
    }
    const cl_device_id device = device_->info().device;
    const size_t bytes = content.size() - hash_digits;
    const auto *binary = reinterpret_cast<const unsigned char *>(content.data()) + hash_digits;
    cl_int status = CL_SUCCESS;
    cl_int loaded = CL_SUCCESS;
    ClProgram program(clCreateProgramWithBinary(device_->context(), 1, &device, &bytes, &binary,
                                                &loaded, &status));
    if (status != CL_SUCCESS || loaded != CL_SUCCESS ||
        clBuildProgram(program.get(), 1, &device, program_options(device_->info()).c_str(), nullptr,
                       nullptr) != CL_SUCCESS) {
        return nullptr;
    }
    return std::make_shared<BuiltProgram>(BuiltProgram{std::move(program), bytes});
}

std::shared_ptr<const BuiltProgram> Program::compile(const std::string &source,
                                                     const std::string &key) const {
    const std::string names = fmt::format("{}", fmt::join(paths_, ", "));
    const cl_device_id device = device_->info().device;
    const char *text = source.c_str();
    cl_int status = CL_SUCCESS;
    ClProgram program(clCreateProgramWithSource(device_->context(), 1, &text, nullptr, &status));
    check_cl(status, "creating program " + names);
    const std::string options = program_options(device_->info());
    status = clBuildProgram(program.get(), 1, &device, options.c_str(), nullptr, nullptr);
    if (status != CL_SUCCESS) {
        const std::string log = build_log(program.get(), device, source);
        const bool is_explained = log.find("error:") != std::string::npos;
        throw run_error(fmt::format(
            "building {}: {}\n{}{}", names, cl_status_name(status), log,
            is_explained || !is_pocl(device_->info())
                ? ""
                : "PoCL's cache may be on a full disk: " + pocl_cache_directory() + "\n"));
    }
    if (!device_->keeps_binaries()) {
        return std::make_shared<BuiltProgram>(BuiltProgram{std::move(program), 0});
    }
    const std::string binary = program_binary(program.get());
    try {
        write_file(cache_file(key), content_hash(binary) + binary);
    } catch (const Error &) {
        // a full or read-only cache only costs time
    }
    return std::make_shared<BuiltProgram>(BuiltProgram{std::move(program), binary.size()});
}

}  // namespace rtrays
