// SPDX-License-Identifier: MIT
// Checks that images agree with the reference, and that errors planted in the kernels are caught.
#include <fmt/format.h>

#include "experiments/harness/core/agreement.h"
#include "experiments/harness/core/rendering.h"
#include "experiments/harness/kinds/gate_checks.h"
#include "renderer/base/progress.h"

namespace rtrays {

namespace {

constexpr uint64_t batches = 32;
constexpr uint32_t seed = 1;

std::vector<Image> batches_of(const GateBench &bench, const RenderSettings &settings) {
    RenderSession session = bench.session(settings);
    return render_batches(session, seed, bench.gate.agreement->spp, batches);
}

Agreement agreement_of(const GateBench &bench, const std::vector<Image> &images,
                       const Reference &reference) {
    AgreementPolicy policy;
    policy.alpha /= static_cast<double>(bench.gate.curves.size());
    return test_agreement(images, reference.image, policy);
}

std::string describe(const Agreement &agreement) {
    const auto &[value, low, high] = agreement.relative_difference;
    return fmt::format(
        "{} of {} tests reject equality, {} undecided, largest |z| {:.1f}, mean differs by {:+.3f} "
        "% [{:+.3f}, {:+.3f}]",
        agreement.rejected, agreement.tests, agreement.undecided, agreement.largest_z, 100 * value,
        100 * low, 100 * high);
}

CheckLine caught_line(const PlantedError &error, bool caught, const std::string &detail) {
    return {fmt::format("planted '{}' in {}: {}caught: {}", error.name,
                        error.settings.algorithm->name, caught ? "" : "not ", detail),
            caught};
}

/// Checks the image of an unchanged curve.
CheckLine check_curve(const GateBench &bench, const CurveDescription &curve,
                      const Reference &reference) {
    const std::vector<Image> images = batches_of(bench, curve.settings);
    const Agreement agreement = agreement_of(bench, images, reference);
    const bool tested = agreement.tests > agreement.undecided;
    const char *finding = "differs from the reference";
    if (agreement.agrees()) {
        finding = tested ? "agrees with the reference" : "too few tests are decided";
    }
    CheckLine line{fmt::format("{}: {}: {}", curve.id(), finding, describe(agreement)),
                   agreement.agrees() && tested};
    if (!line.passed) {
        line.images = {{curve.id(), average_images(images)}, {"reference", reference.image}};
    }
    return line;
}

/// Renders with a planted error and compares the image, or the slope. The check passes if the error
/// is caught.
CheckLine check_planted(const GateBench &bench, const PlantedError &error,
                        const Reference &reference) {
    const RenderSettings settings = planted_settings(error);
    if (error.by_slope) {
        const CurveDescription curve{settings};
        const StageErrors errors = measure_errors(bench, curve, reference, second_stage_seed,
                                                  bench.gate.convergence->second_stage_renders);
        const CheckLine slope = check_slope(curve.id(), errors, errors, reference);
        return caught_line(error, !slope.passed, slope.text);
    }
    const Agreement agreement = agreement_of(bench, batches_of(bench, settings), reference);
    return caught_line(error, !agreement.agrees(), describe(agreement));
}

}  // namespace

std::vector<CheckLine> check_agreement(const GateBench &bench, const Reference &reference) {
    const auto &errors = bench.gate.agreement->planted_errors;
    std::vector<CheckLine> lines;
    Progress progress("agreement", bench.gate.curves.size() + errors.size(), "renders",
                      bench.quiet);
    for (const auto &curve : bench.gate.curves) {
        lines.push_back(check_curve(bench, curve, reference));
        progress.update(lines.size());
    }
    for (const auto &error : errors) {
        lines.push_back(check_planted(bench, error, reference));
        progress.update(lines.size());
    }
    return lines;
}

}  // namespace rtrays
