// SPDX-License-Identifier: MIT
// State files of reference renders. Unlike the EXR, they store the film exactly, so that a render
// can resume with the same bits.
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

/// Version of the sampling code. It is incremented whenever the same settings produce different
/// bits; older states are then refused.
constexpr int sampling_version = 1;

/// Returns everything that determines the samples except the sample range: scene name and hash,
/// film size, camera, seed, strategies, max_depth, engine and sampling version. Two renders may
/// share a state only if their configurations are equal.
Json make_config(const std::string &scene_name, const std::string &scene_hash,
                 const ReferenceSettings &settings, const std::string &engine);

/// A film, finished or not, and its provenance.
struct Checkpoint {
    Json config;
    Film film;
    uint64_t target;                   ///< end of the sample range requested by the run
    double seconds;                    ///< wall time spent on the film
    std::vector<std::string> commits;  ///< program commits in order of work, without duplicates

    bool finished() const { return film.end >= target; }
};

/// Writes the state atomically (temporary file, fsync, rename). The layout, with little-endian
/// numbers, is:
///
///     8 bytes magic
///     u32 version
///     u32 length of the JSON header
///     JSON header
///     moments of the pixels as doubles: sum, compensation, squared deviations, with 3 channels
///         each; rows from the top
///     32 hexadecimal digits: XXH3 hash of everything before
void save_checkpoint(const Checkpoint &checkpoint, const std::filesystem::path &path);

/// Loads a state. Throws `Error` (bad input) naming the file if it is missing, not a state file, of
/// another version, truncated or damaged.
Checkpoint load_checkpoint(const std::filesystem::path &path);

/// Checks that a render with `config` and the sample range [begin, end) can continue `checkpoint`.
/// Throws `Error` (bad input) naming the first difference if it cannot.
void require_continues(const Checkpoint &checkpoint, const Json &config, uint64_t begin,
                       uint64_t end, const std::filesystem::path &path);

}  // namespace rtrays::reference
