// SPDX-License-Identifier: MIT
// Main program of rtrays-experiment, which measures the renderer against references.
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <CLI/CLI.hpp>
#include <filesystem>
#include <iostream>
#include <nlohmann/json.hpp>
#include <vector>

#include "experiments/harness/core/add_curve.h"
#include "experiments/harness/core/compare.h"
#include "experiments/harness/core/experiment.h"
#include "experiments/harness/core/metrics.h"
#include "experiments/harness/core/new_experiment.h"
#include "experiments/harness/core/report.h"
#include "experiments/harness/core/reproduce.h"
#include "experiments/harness/kinds/kinds.h"
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
    ReproduceOptions reproduce;
    NewExperimentOptions create;
    AddCurveOptions add;
    fs::path image, reference;
    bool json = false;
    std::vector<fs::path> images;
    fs::path average;
    std::vector<fs::path> folders;
};

void declare_run(CLI::App &app, RunOptions &options) {
    auto *run = app.add_subcommand("run",
                                   "run an experiment of any kind and write its document to OUT; "
                                   "exit with code 3 if a check or a case fails");
    run->add_option("FILE", options.file, "experiment (JSON)")->required();
    run->add_option("--profile", options.profile,
                    "quick (the default), full, ci, or gpu; each file lists its profiles");
    run->add_option("--out", options.out, "output folder; NAME.PROFILE by default");
    run->add_option("--device", options.device, "OpenCL device, as for rtrays-render");
    run->add_flag("--dry-run", options.dry_run,
                  "check the inputs and print the plan without rendering");
    run->add_flag("--compile", options.compile,
                  "compile the kernels without measuring (curves and stability)");
    run->add_option("--check", options.check,
                    "bitwise, convergence or agreement instead of all checks (gate)")
        ->check(CLI::IsMember({"bitwise", "convergence", "agreement"}));
    run->add_option(
        "--save", options.save,
        "folder for checks.json, checks.xml (JUnit) and images of failed checks (gate)");
    run->add_flag("--update-baseline", options.update_baseline,
                  "measure and replace the baseline without any check (gate)");
    run->add_flag("--quiet", options.quiet, "do not show progress");
}

void declare_reproduce(CLI::App &app, ReproduceOptions &options) {
    auto *reproduce = app.add_subcommand(
        "reproduce",
        "run a collection of experiments and make its report; exit with code 3 if a "
        "check fails. Repeat the command to continue after an interruption");
    reproduce
        ->add_option("COLLECTION", options.collection,
                     "chapter4, or the file of a collection (JSON)")
        ->required();
    reproduce->add_option("--profile", options.profile, "quick or full")->capture_default_str();
    reproduce->add_option("--out", options.out, "output folder; NAME.PROFILE by default");
    reproduce->add_option("--device", options.device, "OpenCL device, as for rtrays-render");
    reproduce->add_flag("--dry-run", options.dry_run, "print the experiments in their order");
    reproduce->add_flag("--quiet", options.quiet, "do not show progress within experiments");
}

void declare_new(CLI::App &app, NewExperimentOptions &options) {
    auto *create = app.add_subcommand(
        "new", "write an experiment for a scene of one's own, to run and to edit");
    create->add_option("SCENE", options.scene, "scene or model file")->required();
    create->add_option("-o,--output", options.file, "file to write; NAME.json by default");
    create->add_flag("--gate", options.is_gate, "write a gate instead");
    create->add_flag("--overwrite", options.overwrite, "replace the file if it exists");
}

void declare_add_curve(CLI::App &app, AddCurveOptions &options) {
    auto *add = app.add_subcommand("add-curve",
                                   "add finished images of another renderer to a run, as a curve");
    add->add_option("DIR", options.run, "folder of a finished run of the kind curves")->required();
    add->add_option("LIST", options.list, "CSV with the columns spp, seed, seconds and image (EXR)")
        ->required();
    add->add_option("--label", options.label, "name of the curve")->required();
}

void declare(CLI::App &app, Arguments &arguments) {
    app.require_subcommand(1);
    app.set_version_flag("--version", program_version("rtrays-experiment"));
    declare_run(app, arguments.run);
    declare_reproduce(app, arguments.reproduce);
    declare_new(app, arguments.create);
    declare_add_curve(app, arguments.add);

    auto *compare = app.add_subcommand("compare", "print the error of image A against reference B");
    compare->add_option("A", arguments.image, "image (OpenEXR)")->required();
    compare->add_option("B", arguments.reference, "reference (OpenEXR)")->required();
    compare->add_flag("--json", arguments.json, "print JSON with the keys of run.json");

    auto *average = app.add_subcommand(
        "average", "average renders with different seeds and estimate the variance of the mean");
    average
        ->add_option("IMAGE", arguments.images,
                     "at least two images (OpenEXR) with equal sample counts")
        ->required();
    average->add_option("-o,--output", arguments.average, "image to write (OpenEXR)")->required();

    auto *report =
        app.add_subcommand("report", "make tables, plots and the report of finished runs");
    report->add_option("DIR", arguments.folders, "folders of finished runs")->required();
}

void write_average(const std::vector<fs::path> &paths, const fs::path &output) {
    require_exr_output(output);
    std::vector<Image> images;
    for (const fs::path &path : paths) {
        images.push_back(read_exr(path));
    }
    write_exr(average_runs(images), output);
}

ExitCode dispatch(const CLI::App &app, const Arguments &arguments) {
    if (app.got_subcommand("run")) {
        return run_experiment(arguments.run, experiment_kinds());
    }
    if (app.got_subcommand("reproduce")) {
        return reproduce(arguments.reproduce, experiment_kinds());
    }
    if (app.got_subcommand("new")) {
        fmt::print("{}", write_new_experiment(arguments.create));
        return ExitCode::ok;
    }
    if (app.got_subcommand("add-curve")) {
        fmt::print("{}\n", add_curve(arguments.add).string());
        return ExitCode::ok;
    }
    if (app.got_subcommand("report")) {
        return static_cast<ExitCode>(make_report(arguments.folders));
    }
    if (app.got_subcommand("compare")) {
        const auto comparison = compare_images(arguments.image, arguments.reference);
        fmt::print("{}", arguments.json ? comparison.dump(2) + "\n" : comparison_text(comparison));
    } else {
        write_average(arguments.images, arguments.average);
    }
    return ExitCode::ok;
}

/// Returns the message of a usage error. Without a known subcommand it lists them.
std::string usage_message(const CLI::App &app, const CLI::ParseError &error) {
    if (!app.get_subcommands().empty()) {
        return fmt::format("{} (see --help)", error.what());
    }
    std::vector<std::string> names;
    for (const CLI::App *subcommand : app.get_subcommands({})) {
        names.push_back(subcommand->get_name());
    }
    return fmt::format("{}; subcommands are: {}; run takes experiments of all kinds (see --help)",
                       error.what(), fmt::join(names, ", "));
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
        throw input_error(usage_message(app, error));
    }
    install_interrupt_handler();
    return dispatch(app, arguments);
}

}  // namespace

int main(int argc, char **argv) {
    return rtrays::run_main("rtrays-experiment", [&] { return run(argc, argv); });
}
