// SPDX-License-Identifier: MIT
// Finding and checking the stored reference of a scene.
#pragma once

#include <array>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <string>

#include "experiments/description.h"
#include "experiments/metrics.h"
#include "renderer/scene/scene.h"

namespace rtrays {

/// Which reference is wanted.
struct ReferenceRequest {
    std::filesystem::path folder;  ///< results/references
    std::string scene_name;
    std::string scene_hash;  ///< `Scene::hash()` of the scene to be measured
    std::string engine;      ///< embree | mitsuba | cycles
    int width = 0, height = 0;
    std::string scene_path;  ///< for the remedy in messages
};

struct StoredReference {
    Reference reference;
    std::array<Image, 2> halves;
    /// "reference" of run.json: engine, files, spp of both halves, reduced_by, scene_hash,
    /// noise_floor.
    nlohmann::json description;
};

/// Reads FOLDER/SCENE.ENGINE.{a,b}.exr, checks them against FOLDER/manifest.json (scene hash,
/// seeds, size) and averages them; a smaller film is made by averaging whole squares of pixels.
///
/// Throws `Error` (reference missing) with the command that makes it when a half or its manifest
/// entry is not there, and `Error` (bad input) when it was made of another scene, when its halves
/// share a seed or when its size does not fit.
StoredReference load_reference(const ReferenceRequest &request);

/// The same for the scene of an experiment or a gate.
StoredReference load_reference(const MeasuredScene &wanted, const Scene &scene);

}  // namespace rtrays
