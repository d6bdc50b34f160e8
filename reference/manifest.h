// SPDX-License-Identifier: MIT
// Manifest of the reference images: names, entries and queries.
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

/// Parses the name of a reference. Throws `Error` (bad input) naming the expected form.
ReferenceName parse_reference_name(const std::filesystem::path &path);

/// Returns the SHA-256 of a file as 64 hexadecimal digits. Throws `Error` (bad input) if the file
/// cannot be read.
std::string sha256_of(const std::filesystem::path &path);

/// Loads and validates a manifest (schema/manifest.schema.json). Throws `Error` (bad input) if it
/// is invalid.
Json load_manifest(const std::filesystem::path &path);

/// Adds or replaces the entry of `image` (SCENE.ENGINE.HALF.exr, in the folder of the manifest).
/// Creates a missing manifest. `entry` has all keys that the schema requires except sha256 and
/// engine, which are added here. The manifest is locked against other writers, validated and
/// replaced atomically.
void update_manifest(const std::filesystem::path &path, const std::filesystem::path &image,
                     Json entry);

/// Returns the entry of `image`, or null if there is none or if the file differs from the listed
/// one.
Json manifest_entry(const std::filesystem::path &path, const std::filesystem::path &image);

/// Returns whether the manifest lists `image` with at least `wanted["spp"]` samples and otherwise
/// the values of `wanted` (keys of an entry). The file must be the listed one.
bool manifest_lists(const std::filesystem::path &path, const std::filesystem::path &image,
                    const Json &wanted);

}  // namespace rtrays::reference
