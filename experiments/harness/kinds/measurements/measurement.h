// SPDX-License-Identifier: MIT
// The kinds of measurements: mostly of speed (thesis, section 4.4), mesh by mesh or scene by scene.
#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "experiments/harness/core/experiment.h"

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

/// Makes a measurement of the kind that the file names. A mesh or scene whose files are missing is
/// replaced by its stand-in or listed as absent. Throws `Error` (bad input) for unknown names and
/// missing keys.
std::unique_ptr<Experiment> make_measurement(const DescriptionFile &file,
                                             const RunOptions &options);

}  // namespace rtrays
