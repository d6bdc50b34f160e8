// SPDX-License-Identifier: MIT
// Runs measurements: mostly of speed (thesis, section 4.4), mesh by mesh or scene by scene. The
// description file names the kind of measurement.
#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <string>
#include <vector>

#include "experiments/harness/kinds/curves.h"
#include "renderer/base/error.h"
#include "renderer/base/json.h"
#include "renderer/device/context.h"

namespace rtrays {

/// A profile of an experiment (schema/measurement.schema.json).
struct MeasurementSettings {
    int repetitions = 0;         ///< turns of every contest
    size_t rays = 0;             ///< rays for each kind of ray and mesh
    size_t watertight_rays = 0;  ///< rays for each closed shape
    int frames = 0;              ///< frames of an animation after the first
    std::vector<std::string> meshes;
    std::vector<std::string> scenes;
    std::vector<std::string> references;  ///< scenes of this repository with stored references
    std::vector<std::string> probes;      ///< scenes of scenes/probes
    uint64_t probe_spp = 0;
    int width = 0, height = 0;          ///< frame size, pixels
    uint64_t spp = 0;                   ///< samples per pixel of a frame
    std::vector<std::string> peers;     ///< variants of Mitsuba 3, or "cycles"
    std::vector<std::string> settings;  ///< renderer settings NAME=VALUE, tried one at a time
};

/// One row of the result: a mesh or a scene.
struct MeasurementTask {
    std::string id;  ///< name of the file with the partial result
    std::function<Json()> measure;
};

/// Tasks of a measurement and the summary of their rows.
struct MeasurementPlan {
    std::vector<MeasurementTask> tasks;
    std::function<Json(const Json &rows)> summarise;  ///< computes "summary" from all rows
};

/// Returns whether the file describes a measurement rather than a convergence experiment. Throws
/// `Error` (bad input) if it cannot be read.
bool is_measurement(const std::filesystem::path &experiment);

/// Measures and writes OUT/run.json. Returns OUT, or an empty path after a dry run. Rows that an
/// interrupted call finished are not measured again, and a finished run is kept (`Resumption`). A
/// missing mesh or scene is replaced by its stand-in or listed as absent. `exit_code` becomes
/// `ExitCode::regression` if a check fails. Throws `Error`: bad input, run failed, interrupted.
std::filesystem::path run_measurement(const RunOptions &options, ExitCode &exit_code);

}  // namespace rtrays
