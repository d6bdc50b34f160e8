// SPDX-License-Identifier: MIT
// The gate's checks: scheduling independence, convergence against the baseline, agreement with the
// reference, and planted errors that these checks must find.
#pragma once

#include <map>
#include <string>
#include <vector>

#include "experiments/harness/core/references.h"
#include "experiments/harness/core/statistics.h"
#include "experiments/harness/kinds/gate.h"
#include "renderer/device/context.h"
#include "renderer/scene/scene.h"
#include "renderer/session/shared_scenes.h"

namespace rtrays {

/// Result of one check.
struct CheckLine {
    std::string text;  ///< what was found
    bool passed = false;
    /// Images of a failed check, by the names of their files without extension.
    std::map<std::string, Image> images = {};
};

/// Everything that the checks need to render.
struct GateBench {
    const GateDescription &gate;
    SharedScenes &scenes;
    bool quiet = false;

    /// Returns a session with the gate's film size.
    RenderSession session(RenderSettings settings) const;
};

/// Checks that the image of every curve has the same bits in a second run and with other group
/// sizes and stream capacities. Split batches and merged films, in either order, must not change it
/// either. Another seed must give a different image: otherwise equality would prove nothing.
std::vector<CheckLine> check_bitwise(const GateBench &bench);

/// RMSE of each render, by samples per pixel.
using StageErrors = std::map<uint64_t, std::vector<double>>;

/// Renders a curve with the seeds first_seed .. first_seed + renders - 1, each to every spp of the
/// gate. Throws `Error` (run failed) if the reference is too noisy to judge the error.
StageErrors measure_errors(const GateBench &bench, const CurveDescription &curve,
                           const Reference &reference, uint32_t first_seed, int renders);

/// First seeds of the two stages. The stages share no seed, and the seeds are fixed in advance.
constexpr uint32_t first_stage_seed = 1;
constexpr uint32_t second_stage_seed = 100001;

/// The stored errors of one curve.
struct CurveBaseline {
    StageErrors first_stage, second_stage;
};

/// Confidence of the slope's interval, about 1 - 0.01 / 12 for a family of twelve pairs. The error
/// of an unbiased algorithm falls with the square root of the number of independent samples. The
/// interval is bootstrapped over the renders.
constexpr double slope_confidence = 0.999;
constexpr int slope_resamples = 40000;
/// Largest `slope_bias_of_scatter` at which the slope is judged. Above it, the slope of the
/// logarithms shows how the errors scatter rather than how they fall. The bias is computed from the
/// baseline, so that a new error cannot excuse itself.
constexpr double largest_slope_bias = 0.02;

/// Checks that the interval of the slope contains -1/2. The reference's noise is subtracted from
/// the errors. `curve` begins the line.
CheckLine check_slope(const std::string &curve, const StageErrors &errors,
                      const StageErrors &baseline, const Reference &reference);

/// Compares the errors with the baseline at every spp, and the slope with -1/2, in two stages.
/// A comparison that the first stage leaves undecided, and a slope that misses -1/2 there, are
/// decided by the second stage, which has more renders. Intervals from sixteen renders cover less
/// than they state, so one of the first stage may miss by chance.
std::vector<CheckLine> check_convergence(const GateBench &bench, const CurveDescription &curve,
                                         const Reference &reference, const CurveBaseline &baseline);

/// Checks that the unchanged renderer agrees with the reference, and that every planted error is
/// caught. An error is caught by the agreement test, with Holm's correction over the blocks and
/// Bonferroni's over the curves, or by the slope.
std::vector<CheckLine> check_agreement(const GateBench &bench, const Reference &reference);

}  // namespace rtrays
