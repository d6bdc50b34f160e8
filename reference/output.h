// SPDX-License-Identifier: MIT
#pragma once

#include "reference/checkpoint.h"
#include "reference/options.h"
#include "reference/renderer.h"

namespace rtrays::reference {

/// What a manifest entry says about the settings of a run that ends with `spp` samples.
Json describe_run(const Options &options, const Json &config, uint64_t spp);

/// What was rendered.
struct Result {
    Image image;                  ///< as developed
    uint64_t begin = 0, end = 0;  ///< samples
    double seconds = 0;
    Json counts;  ///< further statistics, an object
};

/// Writes the EXR, then the manifest entry and the statistics when asked for. `commits` are those
/// of the programs that worked on the film. Throws `Error` (run failed) naming the file that cannot
/// be written.
void write_results(const Options &options, const Json &config, Result result,
                   const std::vector<std::string> &commits);

/// Rays, triangles and times of the Embree path tracer.
Json describe_counts(const ReferenceRenderer &renderer);

}  // namespace rtrays::reference
