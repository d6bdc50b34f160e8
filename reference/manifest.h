// SPDX-License-Identifier: MIT
#pragma once

#include <filesystem>
#include <string>

#include "renderer/base/json.h"

namespace rtrays::reference {

/// The parts of a reference's file name, SCENE.ENGINE.HALF.exr.
struct ReferenceName {
    std::string scene;
    std::string engine;  ///< embree | mitsuba | cycles
    std::string half;    ///< a | b: disjoint seeds
};

/// Throws `Error` (bad input) naming the expected form.
ReferenceName parse_reference_name(const std::filesystem::path &path);

/// SHA-256 of a file as 64 hexadecimal digits. Throws `Error` (bad input) when it cannot be read.
std::string sha256_of(const std::filesystem::path &path);

/// Loads and validates a manifest (schema/manifest.schema.json); throws `Error` (bad input).
Json load_manifest(const std::filesystem::path &path);

/// Adds or replaces the entry of `image` (SCENE.ENGINE.HALF.exr, beside the manifest); a missing
/// manifest is created. `entry` holds what the schema asks for, sha256 and engine apart, which are
/// filled in here. The manifest is locked against other writers, validated and replaced as a whole.
void update_manifest(const std::filesystem::path &path, const std::filesystem::path &image,
                     Json entry);

/// The entry of `image`; null where there is none, or the file is not the one that was listed.
Json manifest_entry(const std::filesystem::path &path, const std::filesystem::path &image);

/// Whether the manifest lists `image` with at least `wanted["spp"]` samples and otherwise the
/// values of `wanted` (keys of an entry), and the file is the one that was listed.
bool manifest_lists(const std::filesystem::path &path, const std::filesystem::path &image,
                    const Json &wanted);

}  // namespace rtrays::reference
