// SPDX-License-Identifier: MIT
// OpenCL programs: compilation of stage files with defines, and the cache of binaries on disk.
#pragma once

#include <map>
#include <memory>
#include <string>
#include <vector>

#include "renderer/device/context.h"
#include "renderer/device/source.h"

namespace rtrays {

/// Preprocessor definitions of a specialised program: name -> value, in a fixed order.
using Defines = std::map<std::string, std::string>;

/// An OpenCL program built from stage files, their includes and a generated block of defines.
///
/// A context keeps the programs that it built last. Binaries are kept on disk in
/// `program_cache_directory()`. The key of both is a hash of expanded source, defines, options,
/// device and driver. Each file carries a checksum, is written atomically, and is written under a
/// lock, so that concurrent processes share one compilation. A file that does not load is compiled
/// again. With `Binaries::by_driver`, no file is added where the driver has a cache of its own.
class Program {
  public:
    /// Finds, loads or compiles the program of the files at `paths`. Throws `Error` (run failed)
    /// with the full build log when the compiler rejects the source.
    Program(DeviceContext &device, const std::vector<std::string> &paths,
            const Defines &defines = {}, const SourceOverlays &overlays = {});

    cl_program get() const { return built_->program.get(); }
    DeviceContext &device() const { return *device_; }
    const std::vector<std::string> &paths() const { return paths_; }
    double build_seconds() const { return build_seconds_; }
    bool from_cache() const { return from_cache_; }
    /// Size of the binary on disk; 0: it is left to the driver.
    size_t binary_bytes() const { return built_->binary_bytes; }

  private:
    std::shared_ptr<const BuiltProgram> load(const std::string &key) const;
    std::shared_ptr<const BuiltProgram> compile(const std::string &source,
                                                const std::string &key) const;

    DeviceContext *device_;
    std::vector<std::string> paths_;
    std::shared_ptr<const BuiltProgram> built_;
    double build_seconds_ = 0;
    bool from_cache_ = false;
};

/// Returns $RTRAYS_CACHE_DIR, otherwise $XDG_CACHE_HOME/rtrays, otherwise ~/.cache/rtrays.
std::string program_cache_directory();

/// Returns the compiler options that all programs share. Floating point is strict; a pragma in the
/// sources disables contraction. GPUs that support correctly rounded divisions and square roots are
/// asked for them; CPUs round correctly without the option.
std::string program_options(const DeviceInfo &device);

}  // namespace rtrays
