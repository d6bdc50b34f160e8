// SPDX-License-Identifier: MIT
// OpenCL programs: compilation of stage files with defines, and the cache of binaries on disk.
#pragma once

#include <map>
#include <string>

#include "renderer/device/context.h"
#include "renderer/device/source.h"

namespace rtrays {

/// Preprocessor definitions of a specialised program: name -> value, in a fixed order.
using Defines = std::map<std::string, std::string>;

/// An OpenCL program built from one stage file, its includes and a generated block of defines.
///
/// Binaries are kept on disk in `program_cache_directory()`. Their key is a hash of expanded
/// source, defines, options, device and driver. Each file carries a checksum, is written
/// atomically, and is written under a lock, so that concurrent processes share one compilation. A
/// file that does not load is compiled again. With `Binaries::leave`, existing files are loaded but
/// no file is added.
class Program {
  public:
    /// Loads or compiles the program at `path`. Throws `Error` (run failed) with the full build log
    /// when the compiler rejects the source.
    Program(DeviceContext &device, const std::string &path, const Defines &defines = {},
            const SourceOverlays &overlays = {});

    cl_program get() const { return program_.get(); }
    DeviceContext &device() const { return *device_; }
    const std::string &path() const { return path_; }
    double build_seconds() const { return build_seconds_; }
    bool from_cache() const { return from_cache_; }
    size_t binary_bytes() const { return binary_bytes_; }  ///< 0: the binary is left to the driver

  private:
    bool load(const std::string &key);
    void compile(const std::string &source, const std::string &key);

    DeviceContext *device_;
    std::string path_;
    ClProgram program_;
    double build_seconds_ = 0;
    bool from_cache_ = false;
    size_t binary_bytes_ = 0;
};

/// Returns $RTRAYS_CACHE_DIR, otherwise $XDG_CACHE_HOME/rtrays, otherwise ~/.cache/rtrays.
std::string program_cache_directory();

/// Returns the compiler options that all programs share. Floating point is strict; a pragma in the
/// sources disables contraction. GPUs that support correctly rounded divisions and square roots are
/// asked for them; CPUs round correctly without the option.
std::string program_options(const DeviceInfo &device);

}  // namespace rtrays
