// SPDX-License-Identifier: MIT
// Checks that the gate finds the errors that are planted in the kernels.
#include <fmt/format.h>

#include "experiments/harness/core/agreement.h"
#include "experiments/harness/core/rendering.h"
#include "experiments/harness/kinds/gate_checks.h"
#include "renderer/base/progress.h"

namespace rtrays {

namespace {

constexpr uint64_t batches = 32;
constexpr uint32_t seed = 1;

Agreement agreement_of(const GateBench &bench, const RenderSettings &settings,
                       const Reference &reference) {
    RenderSession session = bench.session(settings);
    AgreementPolicy policy;
    policy.alpha /= static_cast<double>(bench.gate.curves.size());
    return test_agreement(render_batches(session, seed, bench.gate.planted.spp, batches),
                          reference.image, policy);
}

std::string describe(const Agreement &agreement) {
    const auto &[value, low, high] = agreement.relative_difference;
    return fmt::format(
        "{} of {} tests reject equality, {} undecided, largest |z| {:.1f}, mean differs by {:+.3f} "
        "% [{:+.3f}, {:+.3f}]",
        agreement.rejected, agreement.tests, agreement.undecided, agreement.largest_z, 100 * value,
        100 * low, 100 * high);
}

CheckLine found_line(const PlantedError &error, bool found, const std::string &detail) {
    return {fmt::format("planted error '{}' in {}: {}: {}", error.name,
                        error.settings.algorithm->name, found ? "found" : "not found", detail),
            found};
}

/// Renders with the planted error and compares the image, or the slope. The check passes if the
/// error is found.
CheckLine find_error(const GateBench &bench, const PlantedError &error,
                     const Reference &reference) {
    const RenderSettings settings = planted_settings(error);
    if (error.by_slope) {
        const CurveDescription curve{settings};
        const StageErrors errors = measure_errors(bench, curve, reference, second_stage_seed,
                                                  bench.gate.convergence.second_stage_renders);
        const CheckLine slope = check_slope(curve.id(), errors, errors, reference);
        return found_line(error, !slope.passed, slope.text);
    }
    const Agreement agreement = agreement_of(bench, settings, reference);
    return found_line(error, !agreement.agrees(), describe(agreement));
}

}  // namespace

std::vector<CheckLine> check_planted_errors(const GateBench &bench, const Reference &reference) {
    const auto &planted = bench.gate.planted;
    std::vector<CheckLine> lines;
    Progress progress("planted errors", bench.gate.curves.size() + planted.errors.size(), "renders",
                      bench.quiet);
    uint64_t done = 0;
    for (const auto &curve : bench.gate.curves) {
        const Agreement agreement = agreement_of(bench, curve.settings, reference);
        const bool tested = agreement.tests > agreement.undecided;
        const char *finding = "differs from the reference";
        if (agreement.agrees()) {
            finding = tested ? "agrees with the reference" : "too few tests are decided";
        }
        lines.push_back({fmt::format("{}: {}: {}", curve.id(), finding, describe(agreement)),
                         agreement.agrees() && tested});
        progress.update(++done);
    }
    for (const auto &error : planted.errors) {
        lines.push_back(find_error(bench, error, reference));
        progress.update(++done);
    }
    return lines;
}

}  // namespace rtrays
