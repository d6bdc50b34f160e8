// SPDX-License-Identifier: MIT
// The state file of a reference render: what must resume exactly, unlike the EXR.
#pragma once

#include <cstdint>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "reference/film.h"
#include "reference/settings.h"
#include "renderer/base/json.h"

namespace rtrays::reference {

/// Raised whenever the same settings give other bits than before: older states are then refused.
constexpr int sampling_version = 1;

/// Everything the samples depend on, the sample range apart: scene name and hash, film size,
/// camera, seed, strategies, max_depth, engine, sampling version. Two renders may share a state
/// only if it is equal.
Json make_config(const std::string &scene_name, const std::string &scene_hash,
                 const ReferenceSettings &settings, const std::string &engine);

/// A film on its way, with its origin.
struct Checkpoint {
    Json config;
    Film film;
    uint64_t target;                   ///< the sample at which the run means to end
    double seconds;                    ///< wall time spent on the film
    std::vector<std::string> commits;  ///< of the programs that worked on it, in order, each once

    bool finished() const { return film.end >= target; }
};

/// Writes the state whole or not at all (temporary file, fsync, rename).
/// Layout: 8 bytes magic; u32 version; u32 length of the JSON header; header; the pixels' moments
/// as doubles (sum, compensation, squared deviations, 3 channels each; rows from the top); 32
/// hexadecimal digits of the XXH3 of everything before. Numbers are little-endian.
void save_checkpoint(const Checkpoint &checkpoint, const std::filesystem::path &path);

/// Throws `Error` (bad input) naming the file when it is missing, no state, of another version,
/// truncated or damaged.
Checkpoint load_checkpoint(const std::filesystem::path &path);

/// Throws `Error` (bad input) naming the first difference unless `checkpoint` was made with
/// `config` and holds samples that the range [begin, end) continues.
void require_continues(const Checkpoint &checkpoint, const Json &config, uint64_t begin,
                       uint64_t end, const std::filesystem::path &path);

}  // namespace rtrays::reference
