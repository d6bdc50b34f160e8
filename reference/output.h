// SPDX-License-Identifier: MIT
// Results of a reference render: EXR image, manifest entry and statistics.
#pragma once

#include "reference/checkpoint.h"
#include "reference/options.h"
#include "reference/renderer.h"

namespace rtrays::reference {

/// Returns the keys of a manifest entry that describe the settings of a run of `spp` samples.
Json describe_run(const Options &options, const Json &config, uint64_t spp);

/// A finished render.
struct Result {
    Image image;                  ///< the developed film
    uint64_t begin = 0, end = 0;  ///< sample range
    double seconds = 0;
    Json counts;  ///< further statistics, a JSON object
};

/// Writes the EXR, then the manifest entry and the statistics if requested. `commits` are those of
/// the programs that worked on the film. Throws `Error` (run failed) naming the file that cannot be
/// written.
void write_results(const Options &options, const Json &config, Result result,
                   const std::vector<std::string> &commits);

/// Returns the numbers of rays and triangles and the times of the Embree path tracer.
Json describe_counts(const ReferenceRenderer &renderer);

}  // namespace rtrays::reference
