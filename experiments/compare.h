// SPDX-License-Identifier: MIT
#pragma once

#include <filesystem>
#include <nlohmann/json.hpp>
#include <string>

namespace rtrays {

/// The error of `image` against `reference` with the key names of run.json, and the agreement tests when both
/// carry their variance.
nlohmann::json compare_images(const std::filesystem::path &image, const std::filesystem::path &reference);

/// The same for reading.
std::string comparison_text(const nlohmann::json &comparison);

}  // namespace rtrays
