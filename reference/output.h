// SPDX-License-Identifier: MIT
// Results of a reference render: EXR image, manifest entry and statistics.
#pragma once

#include <string>
#include <vector>

#include "reference/checkpoint.h"
#include "reference/renderer.h"

namespace rtrays::reference {

/// Returns the keys of a manifest entry that describe the settings of a run of these samples.
Json describe_run(const Json &config, SampleRange samples);

/// Files to write. An empty name is not written.
struct OutputFiles {
    std::string image, manifest, stats;
};

/// A finished render.
struct Result {
    Json config;          ///< of `make_config`
    Image image;          ///< the developed film
    SampleRanges ranges;  ///< samples per pixel
    double seconds = 0;
    std::vector<std::string> commits;  ///< of the programs that worked on the film
    Json counts = Json::object();      ///< further statistics
};

/// Writes the EXR, then the manifest entry and the statistics if requested. Throws `Error` (bad
/// input) if samples to be listed in a manifest are several ranges or a window of the picture, and
/// (run failed) naming the file that cannot be written.
void write_results(const OutputFiles &files, Result result);

/// Returns the numbers of rays and triangles, the times and the threads of the Embree path tracer.
Json describe_counts(const ReferenceRenderer &renderer, int threads);

}  // namespace rtrays::reference
