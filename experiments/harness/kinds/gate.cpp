// SPDX-License-Identifier: MIT
#include "experiments/harness/kinds/gate.h"

#include <fmt/format.h>

#include <algorithm>
#include <nlohmann/json.hpp>

#include "embedded/experiment_schemas.h"
#include "experiments/harness/kinds/gate_checks.h"
#include "renderer/base/commit.h"
#include "renderer/base/files.h"
#include "renderer/import/load_scene.h"

namespace rtrays {

namespace fs = std::filesystem;

namespace {

Json to_json(const StageErrors &stage) {
    Json json = Json::object();
    for (const auto &[spp, errors] : stage) {
        json[std::to_string(spp)] = errors;
    }
    return json;
}

StageErrors parse_stage(const Json &json) {
    StageErrors stage;
    for (const auto &[spp, errors] : json.items()) {
        stage[std::stoull(spp)] = errors.get<std::vector<double>>();
    }
    return stage;
}

/// Returns whether a curve was measured with these settings. Settings that did not exist when the
/// baseline was measured count as their defaults.
bool same_settings(const Json &stored, const RenderSettings &settings) {
    Json before = image_settings(RenderSettings());
    before.update(stored);
    return before == image_settings(settings);
}

std::string update_command(const GateDescription &gate) {
    return fmt::format("rtrays-experiment run {} --update-baseline", gate.source);
}

Json load_baseline(const GateDescription &gate, const Scene &scene) {
    if (!fs::exists(gate.baseline)) {
        throw Error(ExitCode::reference_missing,
                    fmt::format("the baseline {} does not exist; measure it with:\n  {}",
                                gate.baseline.string(), update_command(gate)));
    }
    const std::string source = gate.baseline.string(), text = read_file(gate.baseline);
    const Json baseline = parse_json(text, source);
    validate_json(baseline,
                  std::string(embedded::experiment_schemas().text("baseline.schema.json")), source,
                  text);
    if (baseline.at("scene_hash") != scene.hash() ||
        baseline.at("size") != Json{gate.width, gate.height}) {
        throw input_error(fmt::format(
            "{} was measured with another version of the scene or another size; update it with:\n  "
            "{}",
            source, update_command(gate)));
    }
    return baseline;
}

std::vector<CheckLine> check_all_curves(const GateBench &bench, const StoredReference &reference,
                                        const Json &baseline) {
    std::vector<CheckLine> lines;
    for (const auto &curve : bench.gate.curves) {
        if (!baseline.at("curves").contains(curve.id())) {
            throw input_error(fmt::format("{} has no curve '{}'; update it with:\n  {}",
                                          bench.gate.baseline.string(), curve.id(),
                                          update_command(bench.gate)));
        }
        const Json &stored = baseline.at("curves").at(curve.id());
        if (!same_settings(stored.at("settings"), curve.settings)) {
            throw input_error(fmt::format(
                "{}: curve '{}' was measured with other settings; update it with:\n  {}",
                bench.gate.baseline.string(), curve.id(), update_command(bench.gate)));
        }
        const CurveBaseline errors{parse_stage(stored.at("first_stage")),
                                   parse_stage(stored.at("second_stage"))};
        for (auto &line : check_convergence(bench, curve, reference.reference, errors)) {
            lines.push_back(std::move(line));
        }
    }
    return lines;
}

/// Prints how an update changes the error of one curve at one sample count.
void print_change(const std::string &id, const std::string &spp, const std::vector<double> &now,
                  const Json &previous) {
    const Json::json_pointer place("/curves/" + id + "/first_stage/" + spp);
    if (!previous.contains(place) || previous.at(place).size() != now.size()) {
        fmt::print("{} at {} spp: RMSE {:.5g} (new)\n", id, spp, median(now));
        return;
    }
    const auto before = previous.at(place).get<std::vector<double>>();
    fmt::print("{} at {} spp: RMSE {:.5g} -> {:.5g} ({:+.2f} %)\n", id, spp, median(before),
               median(now), 100 * paired_error_ratio(now, before).value);
}

/// Prints the entries of the previous baseline that the new one lacks.
void print_dropped(const Json &baseline, const Json &previous) {
    const Json curves = previous.value("curves", Json::object());
    for (const auto &[id, curve] : curves.items()) {
        for (const auto &stage : curve.at("first_stage").items()) {
            if (!baseline.contains(
                    Json::json_pointer("/curves/" + id + "/first_stage/" + stage.key()))) {
                fmt::print("{} at {} spp: dropped\n", id, stage.key());
            }
        }
    }
}

void measure_baseline(const GateBench &bench, const StoredReference &reference) {
    const auto &gate = bench.gate;
    const Json previous = fs::exists(gate.baseline) ? load_json(gate.baseline) : Json::object();
    require_writable(gate.baseline);
    Json baseline = {{"schema_version", 1},
                     {"gate", gate.name},
                     {"commit", version()},
                     {"scene_hash", bench.scenes.scene().hash()},
                     {"reference_spp", reference.description.at("spp")},
                     {"size", {gate.width, gate.height}}};
    for (const auto &curve : gate.curves) {
        const auto first = measure_errors(bench, curve, reference.reference, first_stage_seed,
                                          gate.convergence.renders);
        const auto second = measure_errors(bench, curve, reference.reference, second_stage_seed,
                                           gate.convergence.second_stage_renders);
        baseline["curves"][curve.id()] = {{"settings", image_settings(curve.settings)},
                                          {"first_stage", to_json(first)},
                                          {"second_stage", to_json(second)}};
        for (const auto &[spp, errors] : first) {
            print_change(curve.id(), std::to_string(spp), errors, previous);
        }
    }
    print_dropped(baseline, previous);
    write_file(gate.baseline, baseline.dump(1) + "\n");
    fmt::print("wrote {}\n", gate.baseline.string());
}

class Gate : public Experiment {
  public:
    Gate(const DescriptionFile &file, const RunOptions &options)
        : gate_(read_gate(file)),
          scene_(load_scene(gate_.scene.string())),
          check_(options.check.empty() ? "all" : options.check),
          updates_(options.update_baseline) {
        if (updates_ || wants("convergence") || wants("planted_errors")) {
            reference_ = load_reference(gate_, scene_);
        }
        if (check_ == "bitwise" && !gate_.bitwise) {
            throw input_error(fmt::format("{} has no checks \"bitwise\"", gate_.source));
        }
        if (!updates_ && wants("planted_errors")) {
            require_plantable(gate_.planted.errors);
        }
        if (!updates_ && wants("convergence")) {
            baseline_ = load_baseline(gate_, scene_);
        }
    }

    std::string plan() const override {
        return fmt::format("{}: {}x{}, {} curves, {} planted errors, {}\n", gate_.name, gate_.width,
                           gate_.height, gate_.curves.size(), gate_.planted.errors.size(),
                           updates_ ? "update of the baseline" : "checks: " + check_);
    }

    Json measure(const Bench &bench) const override {
        SharedScenes scenes(scene_, bench.device);
        const GateBench gate_bench{gate_, scenes, bench.quiet};
        if (updates_) {
            measure_baseline(gate_bench, reference_);
            return {{"rows", Json::array()}};
        }
        Json rows = Json::array();
        const auto report = [&](const std::vector<CheckLine> &lines) {
            for (const CheckLine &line : lines) {
                fmt::print("{} {}\n", line.passed ? "ok  " : "FAIL", line.text);
                rows.push_back({{"check", line.text}, {"passed", line.passed}});
            }
        };
        if (gate_.bitwise && wants("bitwise")) {
            report(check_bitwise(gate_bench));
        }
        if (wants("convergence")) {
            report(check_all_curves(gate_bench, reference_, baseline_));
        }
        if (wants("planted_errors")) {
            report(check_planted_errors(gate_bench, reference_.reference));
        }
        return {{"rows", rows}};
    }

    std::optional<bool> passes(const Json &row) const override {
        return row.at("passed").get<bool>();
    }

  private:
    bool wants(const char *check) const { return check_ == "all" || check_ == check; }

    GateDescription gate_;
    Scene scene_;
    std::string check_;
    bool updates_;
    StoredReference reference_;
    Json baseline_;
};

}  // namespace

std::unique_ptr<Experiment> make_gate(const DescriptionFile &file, const RunOptions &options) {
    return std::make_unique<Gate>(file, options);
}

}  // namespace rtrays
