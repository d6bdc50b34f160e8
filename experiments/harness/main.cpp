// SPDX-License-Identifier: MIT
// Main program of rtrays-experiment, which measures the renderer against references.
#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <filesystem>
#include <iostream>
#include <nlohmann/json.hpp>
#include <vector>

#include "experiments/harness/core/compare.h"
#include "experiments/harness/core/metrics.h"
#include "experiments/harness/core/report.h"
#include "experiments/harness/kinds/convergence_control.h"
#include "experiments/harness/kinds/curves.h"
#include "experiments/harness/kinds/gate.h"
#include "experiments/harness/kinds/measurements/measurement.h"
#include "experiments/harness/kinds/scene_agreement.h"
#include "experiments/harness/kinds/stability.h"
#include "renderer/base/commit.h"
#include "renderer/base/error.h"
#include "renderer/base/files.h"
#include "renderer/base/progress.h"

namespace {

using namespace rtrays;

namespace fs = std::filesystem;

/// Arguments of all subcommands.
struct Arguments {
    RunOptions run;
    GateOptions gate;
    AgreeOptions agree;
    ControlOptions control;
    fs::path image, reference;
    bool json = false;
    std::vector<fs::path> runs;
    fs::path average;
    std::vector<fs::path> folders;
};

void declare(CLI::App &app, Arguments &arguments) {
    app.require_subcommand(1);
    app.set_version_flag("--version", program_version("rtrays-experiment"));

    auto *run = app.add_subcommand(
        "run",
        "run an experiment and write OUT/run.json; exit with code 3 if a check or a case fails");
    run->add_option("FILE", arguments.run.experiment, "experiment (JSON)")->required();
    run->add_option("--profile", arguments.run.profile,
                    "quick, full, ci, or gpu (minutes on a GPU; not in all experiments)")
        ->check(CLI::IsMember({"quick", "full", "ci", "gpu"}))
        ->capture_default_str();
    run->add_option("--out", arguments.run.out, "output folder; NAME.PROFILE by default");
    run->add_option("--device", arguments.run.device, "OpenCL device, as for rtrays-render");
    run->add_flag("--dry-run", arguments.run.dry_run,
                  "check the inputs and print the plan without rendering");
    run->add_flag("--compile", arguments.run.compile,
                  "compile the kernels without measuring (curves and stability suites)");
    run->add_flag("--quiet", arguments.run.quiet, "do not show progress");

    auto *compare = app.add_subcommand("compare", "print the error of image A against reference B");
    compare->add_option("A", arguments.image, "image (OpenEXR)")->required();
    compare->add_option("B", arguments.reference, "reference (OpenEXR)")->required();
    compare->add_flag("--json", arguments.json, "print JSON with the keys of run.json");

    auto *average = app.add_subcommand(
        "average", "average renders with different seeds and estimate the variance of the mean");
    average
        ->add_option("IMAGE", arguments.runs,
                     "at least two images (OpenEXR) with equal sample counts")
        ->required();
    average->add_option("-o,--output", arguments.average, "image to write (OpenEXR)")->required();

    auto *report =
        app.add_subcommand("report", "make tables, plots and the report of finished runs");
    report->add_option("DIR", arguments.folders, "folders of finished runs")->required();

    auto *gate = app.add_subcommand(
        "gate", "check the renderer against its stored baseline; exit with code 3 on a regression");
    gate->add_option("FILE", arguments.gate.gate, "gate (JSON)")->required();
    gate->add_option("--check", arguments.gate.check, "bitwise, convergence, planted_errors or all")
        ->check(CLI::IsMember({"bitwise", "convergence", "planted_errors", "all"}))
        ->capture_default_str();
    gate->add_flag("--update-baseline", arguments.gate.update_baseline,
                   "measure and replace the baseline and print the changes, without any check");
    gate->add_option("--device", arguments.gate.device, "OpenCL device, as for rtrays-render");
    gate->add_flag("--quiet", arguments.gate.quiet, "do not show progress");

    auto *agree = app.add_subcommand(
        "agree", "render scenes with renderer and reference; exit with code 3 if they disagree");
    agree->add_option("FILE", arguments.agree.description, "scenes and sample counts (JSON)")
        ->required();
    agree->add_option("--profile", arguments.agree.profile, "quick or full")
        ->check(CLI::IsMember({"quick", "full"}))
        ->capture_default_str();
    agree->add_option("--out", arguments.agree.out, "output folder; NAME.PROFILE by default");
    agree->add_option("--device", arguments.agree.device, "OpenCL device, as for rtrays-render");
    agree->add_flag("--quiet", arguments.agree.quiet, "do not show progress");

    auto *control = app.add_subcommand(
        "control", "measure savings and bias of convergence control against renders without it");
    control
        ->add_option("FILE", arguments.control.description,
                     "scenes, algorithms and error limits (JSON)")
        ->required();
    control->add_option("--profile", arguments.control.profile, "quick or full")
        ->check(CLI::IsMember({"quick", "full"}))
        ->capture_default_str();
    control->add_option("--out", arguments.control.out, "output folder; NAME.PROFILE by default");
    control->add_option("--device", arguments.control.device,
                        "OpenCL device, as for rtrays-render");
    control->add_flag("--quiet", arguments.control.quiet, "do not show progress");
}

ExitCode dispatch(const CLI::App &app, const Arguments &arguments) {
    if (app.got_subcommand("run") && is_stability(arguments.run.experiment)) {
        return run_stability(arguments.run);
    }
    if (app.got_subcommand("run")) {
        ExitCode exit_code = ExitCode::ok;
        const fs::path out = is_measurement(arguments.run.experiment)
                                 ? run_measurement(arguments.run, exit_code)
                                 : run_experiment(arguments.run);
        if (!out.empty()) {
            fmt::print("{}\n", (out / "run.json").string());
        }
        return exit_code;
    } else if (app.got_subcommand("compare")) {
        const auto comparison = compare_images(arguments.image, arguments.reference);
        fmt::print("{}", arguments.json ? comparison.dump(2) + "\n" : comparison_text(comparison));
    } else if (app.got_subcommand("average")) {
        require_exr_output(arguments.average);
        std::vector<Image> images;
        for (const fs::path &path : arguments.runs) {
            images.push_back(read_exr(path));
        }
        write_exr(average_runs(images), arguments.average);
    } else if (app.got_subcommand("report")) {
        return static_cast<ExitCode>(make_report(arguments.folders));
    } else if (app.got_subcommand("control")) {
        fmt::print("{}\n", run_control(arguments.control).string());
    } else if (app.got_subcommand("agree")) {
        return run_agreement(arguments.agree);
    } else {
        return run_gate(arguments.gate);
    }
    return ExitCode::ok;
}

ExitCode run(int argc, char **argv) {
    CLI::App app{
        "Measures the renderer against independent references: errors over samples and time, "
        "speeds, reports and the regression gate."};
    Arguments arguments;
    declare(app, arguments);
    try {
        app.parse(argc, argv);
    } catch (const CLI::Success &help) {
        app.exit(help, std::cout, std::cerr);
        return ExitCode::ok;
    } catch (const CLI::ParseError &error) {
        throw input_error(fmt::format("{} (see --help)", error.what()));
    }
    install_interrupt_handler();
    return dispatch(app, arguments);
}

}  // namespace

int main(int argc, char **argv) {
    return rtrays::run_main("rtrays-experiment", [&] { return run(argc, argv); });
}
