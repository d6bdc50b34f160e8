// SPDX-License-Identifier: MIT
#include "renderer/integrators/megakernel.h"

namespace rtrays {

std::vector<Pass> megakernel_passes(std::vector<Pass> path_tracing) {
    for (Pass &pass : path_tracing) {
        pass.round = {{Stage::trace_paths}};
        pass.streams = false;
        pass.tail.clear();
    }
    return path_tracing;
}

}  // namespace rtrays
