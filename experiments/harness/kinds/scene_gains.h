// SPDX-License-Identifier: MIT
// The kind "scene_gains": errors of several algorithms over many scenes.
#pragma once

#include <memory>

#include "experiments/harness/core/experiment.h"

namespace rtrays {

/// Makes an experiment that compares algorithms in each scene of a profile, without references.
/// Throws `Error`: bad input.
std::unique_ptr<Experiment> make_scene_gains(const DescriptionFile &file,
                                             const RunOptions &options);

}  // namespace rtrays
