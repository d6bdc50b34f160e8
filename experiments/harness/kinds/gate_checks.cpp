// SPDX-License-Identifier: MIT
#include "experiments/harness/kinds/gate_checks.h"
#include "experiments/harness/core/rendering.h"

#include <fmt/format.h>

#include <cmath>
#include <cstring>

#include "renderer/base/progress.h"

namespace rtrays {

namespace {

bool same_bits(const Image &a, const Image &b) {
    if (a.channels().size() != b.channels().size() || a.pixel_count() != b.pixel_count()) {
        return false;
    }
    for (size_t c = 0; c < a.channels().size(); ++c) {
        const auto &left = a.channels()[c], &right = b.channels()[c];
        if (left.name != right.name || std::memcmp(left.values.data(), right.values.data(),
                                                   left.values.size() * sizeof(float)) != 0) {
            return false;
        }
    }
    return true;
}

/// Bitwise checks of one curve.
class BitwiseCheck {
  public:
    BitwiseCheck(const GateBench &bench, const CurveDescription &curve)
        : bench_(bench),
          curve_(curve),
          spp_(bench.gate.bitwise->spp),
          original_(render(curve.settings, spp_)) {}

    std::vector<CheckLine> run() {
        const auto &bitwise = *bench_.gate.bitwise;
        compare("second run", render(curve_.settings, spp_));
        for (uint32_t size : bitwise.group_sizes) {
            RenderSettings settings = curve_.settings;
            settings.group_size = size;
            compare(fmt::format("group size {}", size), render(settings, spp_));
        }
        for (uint32_t capacity : bitwise.stream_capacities) {
            RenderSettings settings = curve_.settings;
            settings.stream_capacity = capacity;
            compare(fmt::format("stream capacity {}", capacity), render(settings, spp_));
        }
        compare(fmt::format("split at sample {}", bitwise.split),
                render(curve_.settings, bitwise.split));
        compare_merges();
        RenderSettings other = curve_.settings;
        other.seed += 1;
        const bool differs = !same_bits(original_, render(other, spp_));
        lines_.push_back(
            {fmt::format("{}, another seed: {} image", curve_.id(), differs ? "different" : "same"),
             differs});
        return lines_;
    }

  private:
    /// Renders the samples [0, split) and then [split, spp), which may be empty.
    Image render(const RenderSettings &settings, uint64_t split) {
        RenderSession session = bench_.session(settings);
        render_whole(session, 0, split);
        render_whole(session, split, spp_);
        return session.develop();
    }

    FilmState film(uint64_t begin, uint64_t end) {
        RenderSession session = bench_.session(curve_.settings);
        render_whole(session, begin, end);
        return session.film();
    }

    void compare(const std::string &what, const Image &image) {
        const bool same = same_bits(original_, image);
        CheckLine line{
            fmt::format("{}, {}: {} bits", curve_.id(), what, same ? "same" : "different"), same};
        if (!same) {
            line.images = {{curve_.id(), original_}, {curve_.id() + ", " + what, image}};
        }
        lines_.push_back(std::move(line));
    }

    void compare_merges() {
        const uint64_t split = bench_.gate.bitwise->split;
        const FilmState head = film(0, split), tail = film(split, spp_);
        FilmState forward = head, backward = tail;
        merge_film(forward, tail);
        merge_film(backward, head);
        compare("merged films", develop_film(forward));
        compare("merged films in the other order", develop_film(backward));
    }

    const GateBench &bench_;
    const CurveDescription &curve_;
    uint64_t spp_;
    Image original_;
    std::vector<CheckLine> lines_;
};

/// An undecided comparison of the second stage fails.
CheckLine describe(const std::string &pair, const Interval &change, const char *stage,
                   GateDecision decision) {
    return {fmt::format("{}: RMSE {:+.2f} % from the baseline, 99.9 % bounds [{:+.2f}, {:+.2f}], "
                        "{}: {}",
                        pair, 100 * change.value, 100 * change.low, 100 * change.high, stage,
                        to_string(decision)),
            decision == GateDecision::pass};
}

const std::vector<double> &stored(const StageErrors &stage, uint64_t spp, int renders,
                                  const std::string &pair) {
    const auto found = stage.find(spp);
    if (found == stage.end() || found->second.size() != static_cast<size_t>(renders)) {
        throw input_error(fmt::format(
            "the baseline does not have {} errors for {}; update it (--update-baseline)", renders,
            pair));
    }
    return found->second;
}

/// Returns the errors by seed and sample count, with the reference's noise subtracted.
std::vector<std::vector<double>> unbiased_ladders(const StageErrors &stage,
                                                  const Reference &reference) {
    std::vector<std::vector<double>> ladders(stage.begin()->second.size());
    for (const auto &[spp, errors] : stage) {
        for (size_t k = 0; k < ladders.size(); ++k) {
            ladders[k].push_back(
                std::sqrt(unbiased_mse(errors.at(k) * errors.at(k), reference.noise_mse)));
        }
    }
    return ladders;
}

std::vector<double> ladder_spp(const StageErrors &stage) {
    std::vector<double> spp;
    for (const auto &entry : stage) {
        spp.push_back(static_cast<double>(entry.first));
    }
    return spp;
}

}  // namespace

CheckLine check_slope(const std::string &curve, const StageErrors &errors,
                      const StageErrors &baseline, const Reference &reference) {
    const double bias =
        slope_bias_of_scatter(ladder_spp(baseline), unbiased_ladders(baseline, reference));
    const Interval slope = convergence_slope(
        ladder_spp(errors), unbiased_ladders(errors, reference), slope_confidence, slope_resamples);
    const bool judged = std::abs(bias) <= largest_slope_bias,
               passed = slope.low <= -0.5 && -0.5 <= slope.high;
    std::string text = fmt::format("{}: slope {:.4f}, interval [{:.4f}, {:.4f}]", curve,
                                   slope.value, slope.low, slope.high);
    text += judged ? (passed ? " contains -1/2" : " does not contain -1/2")
                   : fmt::format(
                         ", not judged: scatter in the baseline alone shifts the slope by "
                         "{:+.2f}",
                         bias);
    return {text, passed || !judged};
}

RenderSession GateBench::session(RenderSettings settings) const {
    settings.width = gate.width;
    settings.height = gate.height;
    return scenes.session(settings);
}

std::vector<CheckLine> check_bitwise(const GateBench &bench) {
    std::vector<CheckLine> lines;
    Progress progress("bitwise", bench.gate.curves.size(), "curves", bench.quiet);
    for (size_t i = 0; i < bench.gate.curves.size(); ++i) {
        for (auto &line : BitwiseCheck(bench, bench.gate.curves[i]).run()) {
            lines.push_back(std::move(line));
        }
        progress.update(i + 1);
    }
    return lines;
}

StageErrors measure_errors(const GateBench &bench, const CurveDescription &curve,
                           const Reference &reference, uint32_t first_seed, int renders) {
    StageErrors errors;
    RenderSession session = bench.session(curve.settings);
    Progress progress(curve.id(), static_cast<uint64_t>(renders), "renders", bench.quiet);
    for (int k = 0; k < renders; ++k) {
        session.restart(first_seed + static_cast<uint32_t>(k));
        uint64_t done = 0;
        for (uint64_t spp : bench.gate.convergence->spp) {
            render_whole(session, done, spp);
            done = spp;
            const ErrorMetrics error = compute_metrics(session.develop(), reference.image);
            if (noise_dominates(error.mse, reference.noise_mse)) {
                throw run_error(
                    fmt::format("{} at {} spp: the reference's own noise exceeds 10 % of the mean "
                                "squared error; the reference needs at least {:.1f} times the "
                                "samples",
                                curve.id(), spp, missing_samples(error.mse, reference.noise_mse)));
            }
            errors[spp].push_back(error.rmse);
        }
        progress.update(static_cast<uint64_t>(k) + 1);
    }
    return errors;
}

std::vector<CheckLine> check_convergence(const GateBench &bench, const CurveDescription &curve,
                                         const Reference &reference,
                                         const CurveBaseline &baseline) {
    const auto &rule = *bench.gate.convergence;
    const auto pair_name = [&](uint64_t spp) {
        return fmt::format("{} at {} spp", curve.id(), spp);
    };
    std::vector<CheckLine> lines;
    std::vector<uint64_t> undecided;
    const StageErrors first =
        measure_errors(bench, curve, reference, first_stage_seed, rule.renders);
    for (uint64_t spp : rule.spp) {
        const auto pair = pair_name(spp);
        const Interval change = paired_error_ratio(
            first.at(spp), stored(baseline.first_stage, spp, rule.renders, pair));
        const GateDecision decision = decide_gate(change);
        if (decision == GateDecision::undecided) {
            undecided.push_back(spp);
        } else {
            lines.push_back(describe(pair, change, "first stage", decision));
        }
    }
    CheckLine slope = check_slope(curve.id(), first, baseline.first_stage, reference);
    if (!undecided.empty() || !slope.passed) {
        const StageErrors second =
            measure_errors(bench, curve, reference, second_stage_seed, rule.second_stage_renders);
        for (uint64_t spp : undecided) {
            const auto pair = pair_name(spp);
            const Interval change = paired_error_ratio(
                second.at(spp),
                stored(baseline.second_stage, spp, rule.second_stage_renders, pair));
            lines.push_back(describe(pair, change, "second stage", decide_gate(change)));
        }
        if (!slope.passed) {
            const std::string first_stage = slope.text;
            slope = check_slope("in the second stage", second, baseline.second_stage, reference);
            slope.text = first_stage + "; " + slope.text;
        }
    }
    lines.push_back(slope);
    return lines;
}

}  // namespace rtrays
