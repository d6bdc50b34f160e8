// SPDX-License-Identifier: MIT
// How a run that was stopped goes on, and one that is finished stays as it is.
#pragma once

#include <filesystem>
#include <functional>
#include <nlohmann/json.hpp>
#include <string>

#include "renderer/base/json.h"
#include "renderer/device/context.h"

namespace rtrays {

/// A run's result, OUT/NAME, and the parts of it that are done, in OUT/.partial/KEY. The key is a
/// hash of all that the result depends on: the program's code (not its commit), device, driver and
/// `inputs`. The result keeps it in "made_from".
class Resumption {
  public:
    /// Throws `Error` (bad usage) where OUT cannot be written.
    Resumption(std::filesystem::path out, std::string name, const std::string &inputs,
               const DeviceInfo &device);

    /// The result, where one is there of the same key and `is_whole` finds nothing missing that
    /// belongs to it; says so on stderr and deletes the parts. Null otherwise.
    Json finished(const std::function<bool(const Json &)> &is_whole = {}) const;

    /// The folder of the parts.
    const std::filesystem::path &parts() const { return parts_; }

    /// Writes the result with its key, then deletes the parts. The text that is written.
    void finish(Json result) const;

  private:
    std::filesystem::path out_, result_, parts_;
    std::string key_;
};

}  // namespace rtrays
