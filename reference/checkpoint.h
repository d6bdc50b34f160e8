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

/// Version of the sampling code. It is incremented whenever the same settings give other samples;
/// older states and images are then not continued.
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
    SampleRange wanted;                ///< sample range requested by the run
    double seconds;                    ///< wall time spent on the film
    std::vector<std::string> commits;  ///< program commits in order of work, without duplicates

    bool finished() const { return missing_ranges(film.ranges, wanted).empty(); }
};

/// Writes the state atomically (temporary file, fsync, rename). The layout, with little-endian
/// numbers, is:
///
///     8 bytes magic
///     u32 version
///     u32 length of the JSON header
///     JSON header
///     words of the pixels (PixelSums) as i64; rows from the top
///     32 hexadecimal digits: XXH3 hash of everything before
void save_checkpoint(const Checkpoint &checkpoint, const std::filesystem::path &path);

/// Loads a state. Throws `Error` (bad input) naming the file if it is missing, not a state file, of
/// another version, truncated or damaged.
Checkpoint load_checkpoint(const std::filesystem::path &path);

/// Checks that a render of `wanted` with `config` can continue `checkpoint`. Throws `Error` (bad
/// input) naming the first difference if it cannot.
void require_continues(const Checkpoint &checkpoint, const Json &config, SampleRange wanted,
                       const std::filesystem::path &path);

/// Adds the samples of `other`. The film has the bits of one render of all samples. Throws `Error`
/// (bad input) naming the first difference of the configurations, or samples that both films have.
void merge_checkpoint(Checkpoint &checkpoint, const Checkpoint &other);

/// Adds commits to a list, without duplicates.
void add_commits(std::vector<std::string> &commits, const std::vector<std::string> &more);

}  // namespace rtrays::reference
