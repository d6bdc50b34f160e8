// SPDX-License-Identifier: MIT
#include "experiments/harness/core/report.h"

#include <fmt/format.h>

#include <nlohmann/json.hpp>
#include <optional>
#include <string>

#include "experiments/harness/core/array_file.h"
#include "experiments/harness/core/description.h"
#include "experiments/harness/core/document.h"
#include "renderer/base/error.h"
#include "renderer/base/files.h"
#include "renderer/base/process.h"
#include "renderer/base/resources.h"

namespace rtrays {

namespace fs = std::filesystem;

namespace {

/// Writes the arrays that the plots of curves read. Other kinds have no images on their pages.
void export_images(const fs::path &folder) {
    const fs::path path = folder / document_name;
    if (!fs::exists(path)) {
        throw input_error(
            fmt::format("{}: no {}; make it with: rtrays-experiment run FILE --out {}",
                        folder.string(), document_name, folder.string()));
    }
    const Json run = parse_document(read_file(path), path.string());
    if (run.at("kind") != "curves") {
        return;
    }
    const auto export_image = [&](const std::string &name, const Json &layers) {
        const Image image = read_exr(folder / name);
        write_array(image, (folder / name).replace_extension(".npy"));
        for (const std::string layer : layers) {
            write_array(image, (folder / name).replace_extension("." + layer + ".npy"), layer);
        }
    };
    const std::string reference = run.at("reference").at("image");
    // A clone has the stored pages and plots without the images.
    if (!fs::exists(folder / reference) && fs::exists(folder / "report.md")) {
        fmt::print(stderr, "{}: no images; the stored plots are used\n", folder.string());
        return;
    }
    export_image(reference, Json::array());
    if (run.contains("first_hits")) {
        export_image(run.at("first_hits").at("image"), Json::array());
    }
    for (const Json &curve : run.at("curves")) {
        export_image(curve.at("image"), curve.at("layers"));
        for (const Json &early : curve.at("early_images")) {
            export_image(early.at("image"), Json::array());
        }
    }
}

/// Runs a program, prints its output and returns its exit code.
int run_program(const std::vector<std::string> &command) {
    Process process(command);
    while (const std::optional<std::string> line = process.read_line()) {
        fmt::print("{}\n", *line);
    }
    const int code = process.wait();
    if (code == 127) {
        throw run_error(
            fmt::format("cannot start {}; install Python and its packages with scripts/install",
                        command.front()));
    }
    return code;
}

}  // namespace

int make_report(const std::vector<fs::path> &runs) {
    load_description(resource_folder() / "experiments/claims.json",
                     "claims.schema.json");  // refused here or not at all
    std::vector<std::string> command{RTRAYS_PYTHON, resource_folder() / "scripts/results",
                                     "report"};
    for (const auto &run : runs) {
        export_images(run);
        command.push_back(run.string());
    }
    return run_program(command);
}

}  // namespace rtrays
