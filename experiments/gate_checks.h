// SPDX-License-Identifier: MIT
#pragma once

#include <map>
#include <string>
#include <vector>

#include "experiments/gate.h"
#include "experiments/references.h"
#include "experiments/statistics.h"
#include "renderer/device/context.h"
#include "renderer/pipeline/render_session.h"
#include "renderer/scene/scene.h"

namespace rtrays {

/// What one check found.
struct CheckLine {
    std::string text;
    bool passed = false;
};

/// Where the checks render.
struct GateBench {
    const GateDescription &gate;
    const Scene &scene;
    DeviceContext &device;
    bool quiet = false;

    /// A session of the gate's film size.
    RenderSession session(RenderSettings settings) const;
};

/// Every curve's image has the same bits over two runs, group sizes, stream capacities, a batch
/// split and merged films in either order; and another seed gives another image, so that equality
/// means something.
std::vector<CheckLine> check_bitwise(const GateBench &bench);

/// RMSE of each render by samples per pixel.
using StageErrors = std::map<uint64_t, std::vector<double>>;

/// Renders seeds first_seed .. first_seed + renders - 1 of a curve to each spp in turn.
/// Throws `Error` (run failed) where the reference is too noisy to judge.
StageErrors measure_errors(const GateBench &bench, const CurveDescription &curve,
                           const Reference &reference, uint32_t first_seed, int renders);

/// Seeds of the two stages: disjoint, fixed in advance.
constexpr uint32_t first_stage_seed = 1;
constexpr uint32_t second_stage_seed = 100001;

/// The stored errors of one curve.
struct CurveBaseline {
    StageErrors first_stage, second_stage;
};

/// Error of unbiased algorithms falls with the root of the number of independent samples. Intervals
/// are bootstrapped over the renders, at about 1 - 0.01 / 12 for a family of twelve pairs.
constexpr double slope_confidence = 0.999;
constexpr int slope_resamples = 40000;
/// Where `slope_bias_of_scatter` passes this, the slope of logarithms tells how errors scatter
/// rather than how they fall, and is not judged. Decided on the baseline, so that a new error
/// cannot excuse itself.
constexpr double largest_slope_bias = 0.02;

/// Whether the interval of the slope, reference noise taken off, holds -1/2.
CheckLine check_slope(const std::string &curve, const StageErrors &errors,
                      const StageErrors &baseline, const Reference &reference);

/// The two-stage rule at every spp (architecture, "The gate"), and for the slope: one that misses
/// in the first stage is decided by the second. Of nine pairs and sixteen renders, whose intervals
/// cover less than they say, one may miss.
std::vector<CheckLine> check_convergence(const GateBench &bench, const CurveDescription &curve,
                                         const Reference &reference, const CurveBaseline &baseline);

/// The text with its one occurrence of `search` replaced; throws `Error` (bad input) naming the
/// error when there is none or more than one: a planted error that is not planted proves nothing.
std::string plant(const PlantedError &error, const std::string &text);

/// The unchanged renderer agrees with the reference, and every planted error is rejected: by that
/// comparison, Holm's correction over its blocks and Bonferroni's over the curves, or by its slope.
std::vector<CheckLine> check_planted_errors(const GateBench &bench, const Reference &reference);

}  // namespace rtrays
