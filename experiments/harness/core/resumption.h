// SPDX-License-Identifier: MIT
// Continues interrupted runs and keeps finished ones.
#pragma once

#include <filesystem>
#include <functional>
#include <nlohmann/json.hpp>
#include <string>

#include "renderer/base/json.h"
#include "renderer/device/context.h"

namespace rtrays {

/// Stores the result of a run in OUT/NAME, and its finished parts in OUT/.partial/KEY. The key is a
/// hash of everything that the result depends on: the program's code (not its commit), the device,
/// the driver and `inputs`. The result has the key in "made_from".
class Resumption {
  public:
    /// Throws `Error` (bad input) if OUT cannot be written.
    Resumption(std::filesystem::path out, std::string name, const std::string &inputs,
               const DeviceInfo &device);

    /// Returns the stored result if it has the same key and `is_whole` accepts it as complete. Then
    /// also prints a notice on stderr and deletes the parts. Returns null otherwise.
    Json finished(const std::function<bool(const Json &)> &is_whole = {}) const;

    /// Folder of the finished parts.
    const std::filesystem::path &parts() const { return parts_; }

    /// Writes the result with its key, then deletes the parts.
    void finish(Json result) const;

  private:
    std::filesystem::path out_, result_, parts_;
    std::string key_;
};

/// Throws `Error` (interrupted) if SIGINT or SIGTERM arrived.
void require_not_interrupted();

/// Returns the finished part that `file` stores, or measures and stores it.
Json finished_part(const std::filesystem::path &file, const std::function<Json()> &measure);

}  // namespace rtrays
