// SPDX-License-Identifier: MIT
#include "experiments/harness/core/new_experiment.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>

#include "experiments/harness/core/description.h"
#include "renderer/base/error.h"
#include "renderer/base/files.h"
#include "renderer/base/shell.h"
#include "renderer/import/load_scene.h"

namespace rtrays {

namespace {

namespace fs = std::filesystem;
using OrderedJson = nlohmann::ordered_json;

/// Pixels of the first experiment and gate, which share a reference.
constexpr double first_pixels = 128 * 128;

/// Returns a size of about `pixels` with the film's proportions.
OrderedJson size_like(const Scene &scene, double pixels) {
    const double width = scene.film_width(), height = scene.film_height();
    const double factor = std::min(1.0, std::sqrt(pixels / (width * height)));
    const auto side = [&](double length) { return std::max(1L, std::lround(factor * length)); };
    return {side(width), side(height)};
}

OrderedJson curve(const char *algorithm, const char *sampler, const char *label) {
    OrderedJson made = {{"algorithm", algorithm}, {"label", label}};
    made["settings"]["integrator.sampler"] = sampler;
    if (std::string(algorithm) == "truncated_bdpt") {
        made["settings"]["integrator.light_paths"] = "auto";
    }
    return made;
}

OrderedJson curves_of(const Scene &scene) {
    return {{"kind", "curves"},
            {"name", file_name_of(scene.name())},
            {"title", scene.name() + ": path tracing and truncated bidirectional path tracing"},
            {"scene", ""},
            {"reference", {{"folder", "references"}, {"engine", "embree"}}},
            {"curves",
             {curve("truncated_bdpt", "independent", "truncated BDPT"),
              curve("truncated_bdpt", "sobol", "truncated BDPT with Sobol points"),
              curve("path_tracing", "sobol", "path tracing with Sobol points"),
              curve("path_tracing", "independent", "path tracing")}},
            {"profiles",
             {{"quick",
               {{"size", size_like(scene, first_pixels)},
                {"spp", {1, 2, 4, 8, 16}},
                {"seeds", 8},
                {"early_images", {4, 16}}}}}}};
}

OrderedJson gate_of(const Scene &scene) {
    OrderedJson curves = OrderedJson::array();
    curves.push_back({{"algorithm", "path_tracing"}});
    return {{"kind", "gate"},
            {"name", file_name_of(scene.name())},
            {"scene", ""},
            {"reference", {{"folder", "references"}, {"engine", "embree"}}},
            {"size", size_like(scene, first_pixels)},
            {"curves", curves},
            {"agreement", {{"spp", 256}}}};
}

}  // namespace

std::string write_new_experiment(const NewExperimentOptions &options) {
    const Scene scene = load_scene(options.scene.string());
    OrderedJson experiment = options.is_gate ? gate_of(scene) : curves_of(scene);
    const std::string name = experiment.at("name");
    const fs::path file = options.file.empty() ? fs::path(name + ".json") : options.file;
    if (fs::exists(file) && !options.overwrite) {
        throw input_error(
            fmt::format("{}: the file exists; --overwrite replaces it", file.string()));
    }
    const fs::path folder = fs::absolute(file).parent_path();
    experiment["scene"] = fs::relative(options.scene, folder).string();
    create_folder(folder);
    write_file(file, experiment.dump(2) + "\n");
    const std::string program = in_shell(sibling_program("rtrays-experiment"));
    const std::string run = fmt::format(
        "wrote {0}\n"
        "  {1} run {2}\n"
        "prints the commands that render its reference, and then {3}",
        file.string(), program, in_shell(file),
        options.is_gate ? "checks\n" : "measures; its page comes from\n");
    return options.is_gate ? run : run + fmt::format("  {} report {}.quick\n", program, name);
}

}  // namespace rtrays
