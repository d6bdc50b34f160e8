// SPDX-License-Identifier: MIT
// Finds and checks the stored reference images of a scene.
#pragma once

#include <array>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <string>

#include "experiments/harness/core/description.h"
#include "experiments/harness/core/metrics.h"
#include "renderer/scene/scene.h"

namespace rtrays {

/// Description of the requested reference.
struct ReferenceRequest {
    std::filesystem::path folder;  ///< results/references
    std::string scene_name;
    std::string scene_hash;  ///< `Scene::hash()` of the scene to be measured
    std::string engine;      ///< embree | mitsuba | cycles
    int width = 0, height = 0;
    std::string scene_path;  ///< for the commands in messages
};

struct StoredReference {
    Reference reference;
    std::array<Image, 2> halves;
    /// "reference" of run.json: engine, files, spp of both halves, reduced_by, scene_hash,
    /// noise_floor.
    nlohmann::json description;
};

/// Reads FOLDER/SCENE.ENGINE.{a,b}.exr, checks them against FOLDER/manifest.json and averages them.
/// The checks cover scene hash, file hash, seeds, sample counts and size. If the requested film is
/// smaller, squares of pixels are averaged.
///
/// Throws `Error` (reference missing) with the command that renders it if a half or its manifest
/// entry is missing. Throws `Error` (bad input) if a check fails.
StoredReference load_reference(const ReferenceRequest &request);

/// Loads the reference of an experiment's or a gate's scene.
StoredReference load_reference(const MeasuredScene &wanted, const Scene &scene);

}  // namespace rtrays
