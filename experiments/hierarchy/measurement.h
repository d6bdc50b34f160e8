// SPDX-License-Identifier: MIT
// Experiments on speed, thesis 4.4: what they measure is named in their file, mesh by mesh or scene
// by scene.
#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <string>
#include <vector>

#include "experiments/runner.h"
#include "renderer/base/error.h"
#include "renderer/base/json.h"
#include "renderer/device/context.h"

namespace rtrays {

/// A profile of an experiment (schema/measurement.schema.json).
struct MeasurementSettings {
    int repetitions = 0;         ///< turns of every contest
    size_t rays = 0;             ///< of a kind and mesh
    size_t watertight_rays = 0;  ///< of a closed shape
    int frames = 0;              ///< of an animation, but for the first
    std::vector<std::string> meshes;
    std::vector<std::string> scenes;
    std::vector<std::string> references;  ///< scenes of this repository that have some
    std::vector<std::string> probes;      ///< of scenes/probes
    uint64_t probe_spp = 0;
    int width = 0, height = 0;          ///< pixels of a frame
    uint64_t spp = 0;                   ///< of a frame
    std::vector<std::string> peers;     ///< variants of Mitsuba 3, "cycles"
    std::vector<std::string> settings;  ///< NAME=VALUE of the renderer, to be tried one at a time
};

/// One row of the result: a mesh or a scene.
struct MeasurementTask {
    std::string id;  ///< names the file of a partial result
    std::function<Json()> measure;
};

/// What a kind of measurement consists of.
struct MeasurementPlan {
    std::vector<MeasurementTask> tasks;
    std::function<Json(const Json &rows)> summarise;  ///< what follows from all rows
};

/// Whether the file describes a measurement, not renders to be compared with a reference. Throws
/// `Error` (bad input) when it cannot be read.
bool is_measurement(const std::filesystem::path &experiment);

/// Measures and writes OUT/run.json; returns OUT (empty after a dry run). Rows that an earlier,
/// stopped call finished are not measured again, nor is a finished run (`Resumption`). A mesh or
/// scene that is not there is replaced by its stand-in, or listed as absent. Throws `Error`: bad
/// input, run failed, interrupted. `exit_code` becomes `ExitCode::regression` when a check fails.
std::filesystem::path run_measurement(const RunOptions &options, ExitCode &exit_code);

}  // namespace rtrays
