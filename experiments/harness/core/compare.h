// SPDX-License-Identifier: MIT
// Compares two image files: errors and agreement.
#pragma once

#include <filesystem>
#include <nlohmann/json.hpp>
#include <string>

namespace rtrays {

/// Computes the error of `image` against `reference` with the key names of run.json. Adds the
/// agreement tests if both have variance layers. "mean_ratio" is the means of R, G and B divided by
/// those of the reference; null if a channel of the reference is black.
nlohmann::json compare_images(const std::filesystem::path &image,
                              const std::filesystem::path &reference);

/// Formats a comparison as text for the terminal.
std::string comparison_text(const nlohmann::json &comparison);

}  // namespace rtrays
