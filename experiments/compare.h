// SPDX-License-Identifier: MIT
#pragma once

#include <filesystem>
#include <nlohmann/json.hpp>
#include <string>

namespace rtrays {

/// The error of `image` against `reference` with the key names of run.json, and the agreement tests
/// when both carry their variance. "mean_ratio" holds the means of R, G and B over those of the
/// reference: null where that is black.
nlohmann::json compare_images(const std::filesystem::path &image,
                              const std::filesystem::path &reference);

/// The same for reading.
std::string comparison_text(const nlohmann::json &comparison);

}  // namespace rtrays
