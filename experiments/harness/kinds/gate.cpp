// SPDX-License-Identifier: MIT
#include "experiments/harness/kinds/gate.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <nlohmann/json.hpp>
#include <pugixml.hpp>
#include <sstream>

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
                                          gate.convergence->renders);
        const auto second = measure_errors(bench, curve, reference.reference, second_stage_seed,
                                           gate.convergence->second_stage_renders);
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

/// Returns the rows of a gate as test cases of JUnit, which CI systems show.
std::string junit_of(const std::string &name, const Json &rows, size_t failed) {
    pugi::xml_document document;
    pugi::xml_node suite = document.append_child("testsuite");
    suite.append_attribute("name") = name.c_str();
    suite.append_attribute("tests") = rows.size();
    suite.append_attribute("failures") = failed;
    for (const Json &row : rows) {
        const auto check = row.at("check").get<std::string>();
        pugi::xml_node test = suite.append_child("testcase");
        test.append_attribute("classname") =
            fmt::format("{}.{}", name, row.at("group").get<std::string>()).c_str();
        // The text before the findings is the same in every run.
        test.append_attribute("name") = check.substr(0, check.find(": ")).c_str();
        if (!row.at("passed").get<bool>()) {
            test.append_child("failure").append_attribute("message") = check.c_str();
        }
    }
    std::ostringstream text;
    document.save(text);
    return text.str();
}

class Gate : public Experiment {
  public:
    Gate(const DescriptionFile &file, const RunOptions &options)
        : gate_(read_gate(file)),
          scene_(load_scene(gate_.scene.string())),
          check_(options.check),
          save_(options.save),
          updates_(options.update_baseline) {
        for (const auto &[check, is_there] :
             {std::pair("bitwise", gate_.bitwise.has_value()),
              std::pair("convergence", gate_.convergence.has_value()),
              std::pair("agreement", gate_.agreement.has_value())}) {
            if ((check_.empty() || check_ == check) && is_there && !updates_) {
                checks_.emplace_back(check);
            }
        }
        if (updates_ && !gate_.convergence) {
            throw input_error(
                fmt::format("{} has no \"convergence\", which a baseline is for", gate_.source));
        }
        if (!updates_ && checks_.empty()) {
            throw input_error(fmt::format("{} has no checks \"{}\"", gate_.source, check_));
        }
        if (updates_ || wants("convergence") || wants("agreement")) {
            reference_ = load_reference(gate_, scene_);
        }
        if (wants("agreement")) {
            require_plantable(gate_.agreement->planted_errors);
        }
        if (wants("convergence")) {
            baseline_ = load_baseline(gate_, scene_);
        }
    }

    std::string plan() const override {
        return fmt::format("{}: {}x{}, {} curves, {} planted errors, {}\n", gate_.name, gate_.width,
                           gate_.height, gate_.curves.size(),
                           gate_.agreement ? gate_.agreement->planted_errors.size() : 0,
                           updates_ ? "update of the baseline"
                                    : fmt::format("checks: {}", fmt::join(checks_, ", ")));
    }

    Json measure(const Bench &bench) const override {
        SharedScenes scenes(scene_, bench.device);
        const GateBench gate_bench{gate_, scenes, bench.quiet};
        if (updates_) {
            measure_baseline(gate_bench, reference_);
            return {{"rows", Json::array()}};
        }
        Json rows = Json::array();
        save(rows);  // a check that throws leaves no older results
        for (const std::string &check : checks_) {
            for (const CheckLine &line : lines_of(check, gate_bench)) {
                fmt::print("{} {}\n", line.passed ? "ok  " : "FAIL", line.text);
                Json row = {{"group", check}, {"check", line.text}, {"passed", line.passed}};
                for (const auto &[name, image] : line.images) {
                    if (!save_.empty()) {
                        const std::string file = fmt::format("{}.{}.exr", check, name);
                        write_exr(image, save_ / file);
                        row["images"].push_back(file);
                    }
                }
                rows.push_back(std::move(row));
            }
            save(rows);
        }
        return {{"rows", rows}};
    }

    std::optional<bool> passes(const Json &row) const override {
        return row.at("passed").get<bool>();
    }

  private:
    bool wants(const std::string &check) const {
        return std::find(checks_.begin(), checks_.end(), check) != checks_.end();
    }

    std::vector<CheckLine> lines_of(const std::string &check, const GateBench &bench) const {
        if (check == "bitwise") {
            return check_bitwise(bench);
        }
        return check == "convergence" ? check_all_curves(bench, reference_, baseline_)
                                      : check_agreement(bench, reference_.reference);
    }

    /// Writes the checks as JSON and as XML, if wanted.
    void save(const Json &rows) const {
        if (save_.empty()) {
            return;
        }
        create_folder(save_);
        const auto failed = static_cast<size_t>(std::count_if(
            rows.begin(), rows.end(), [](const Json &row) { return !row.at("passed"); }));
        const Json document = {{"gate", gate_.name},
                               {"commit", version()},
                               {"passed", rows.size() - failed},
                               {"failed", failed},
                               {"checks", rows}};
        write_file(save_ / "checks.json", document.dump(1) + "\n");
        write_file(save_ / "checks.xml", junit_of(gate_.name, rows, failed));
    }

    GateDescription gate_;
    Scene scene_;
    std::string check_;                ///< the only one wanted; empty: all
    std::vector<std::string> checks_;  ///< those that run
    fs::path save_;
    bool updates_;
    StoredReference reference_;
    Json baseline_;
};

}  // namespace

std::unique_ptr<Experiment> make_gate(const DescriptionFile &file, const RunOptions &options) {
    return std::make_unique<Gate>(file, options);
}

}  // namespace rtrays
