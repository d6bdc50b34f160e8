// SPDX-License-Identifier: MIT
// The commands of rtrays-mpi.
#pragma once

#include "cluster/world.h"
#include "renderer/base/error.h"

namespace rtrays::cluster {

/// Which ranks may render one film.
enum class Devices {
    equal,  ///< those with equal devices, whose bits are equal
    mixed,
};

/// Renders an image of a scene on the OpenCL devices of all ranks; the arguments are those of
/// rtrays-render. All ranks call it.
ExitCode render(const World &world, Devices devices, int argc, char **argv);

/// Renders a reference by the processors of all ranks; the arguments are those of rtrays-reference.
/// All ranks call it.
ExitCode render_reference(const World &world, Devices devices, int argc, char **argv);

}  // namespace rtrays::cluster
