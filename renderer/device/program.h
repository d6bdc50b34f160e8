// SPDX-License-Identifier: MIT
#pragma once

#include <map>
#include <string>

#include "renderer/device/context.h"
#include "renderer/device/source.h"

namespace rtrays {

/// Preprocessor definitions of a specialised program, in a fixed order: name -> value.
using Defines = std::map<std::string, std::string>;

/// An OpenCL program made from one stage file, its includes and a generated block of defines.
///
/// Binaries are kept on disk in `program_cache_directory()`, keyed by expanded source, defines,
/// options, device and driver; each file carries a checksum, is written atomically and made under a
/// lock, so that processes share one compilation. A file that does not load is compiled anew. Where
/// the device's binaries are left to its driver, what others have kept is loaded and nothing is
/// added.
class Program {
  public:
    /// Throws `Error` (run failed) with the whole build log when the compiler rejects the source.
    Program(DeviceContext &device, const std::string &path, const Defines &defines = {},
            const SourceOverlays &overlays = {});

    cl_program get() const { return program_.get(); }
    DeviceContext &device() const { return *device_; }
    const std::string &path() const { return path_; }
    double build_seconds() const { return build_seconds_; }
    bool from_cache() const { return from_cache_; }
    size_t binary_bytes() const { return binary_bytes_; }  ///< 0: left to the driver

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

/// $RTRAYS_CACHE_DIR, else $XDG_CACHE_HOME/rtrays, else ~/.cache/rtrays.
std::string program_cache_directory();

/// The compiler options of every program: strict floating point, no contraction by the sources' own
/// pragma. CPUs round divisions correctly without being asked.
std::string program_options(const DeviceInfo &device);

}  // namespace rtrays
