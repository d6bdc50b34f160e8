// SPDX-License-Identifier: MIT
// What the programs that render references share around the render itself: checks of the output
// files, the scene, the film to continue, and the results.
#pragma once

#include "reference/checkpoint.h"
#include "reference/options.h"
#include "reference/output.h"
#include "renderer/base/error.h"
#include "renderer/scene/scene.h"

namespace rtrays::reference {

/// The samples to render, in steps of the renderer.
struct Steps {
    SampleRange range;
    uint64_t samples = 1;  ///< samples per pixel of one step
};

/// Throws `Error` (bad usage) if an output of the options cannot be written or has a wrong name.
void require_outputs(const Options &options);

/// Loads the scene with the changes of the options. Sets the size of the picture, its window and
/// the camera in the settings.
Scene load_scene(Options &options);

/// Returns whether --skip-if-listed is given and the manifest lists a result that satisfies the
/// request, and prints so. A longer range with the same start is sufficient.
bool is_done(const Options &options, const Json &config);

/// Returns the film to begin with: that of the state file if --resume is given and the file exists,
/// otherwise that of a listed image, or an empty one. Throws `Error` (bad input) instead of
/// overwriting an unfinished state. The commits include this program's if there is work left.
Checkpoint begin_or_resume(const Options &options, const Steps &steps, const Json &config);

/// Writes the results of a complete film and prints what was written. `steps` are those of the
/// film, `counts` further statistics.
void write_results(const Options &options, const Steps &steps, const Checkpoint &checkpoint,
                   Image image, Json counts);

/// Prints how many samples are done and how to continue.
void report_interruption(const Options &options, uint64_t samples);

/// Adds states of one scene and one seed with disjoint samples, and writes their image.
ExitCode merge_states(const MergeOptions &options);

}  // namespace rtrays::reference
