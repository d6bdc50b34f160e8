// SPDX-License-Identifier: MIT
// What an experiment file asks for (schema/experiment.schema.json).
#pragma once

#include <cstdint>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "renderer/base/json.h"
#include "renderer/pipeline/settings.h"

namespace rtrays {

/// A seed's samples are cut into so many batches: eight seeds make the 32 images that a variance
/// takes.
constexpr uint64_t batches_per_seed = 4;

/// One curve: an algorithm with its settings.
struct CurveDescription {
    RenderSettings settings;         ///< size and seed are set by the runner
    std::vector<uint64_t> spp = {};  ///< strictly increasing; of experiments
    std::vector<uint64_t> early_images =
        {};              ///< rungs at which the first seed's image is kept; of experiments
    uint32_t seeds = 0;  ///< seeds 1 .. seeds; of experiments

    /// "path_tracing.mis", "truncated_bdpt.mis,light_paths=auto": names the curve's files.
    std::string id() const;
};

struct ThroughputDescription {
    int repetitions = 0;
    uint64_t spp = 0;  ///< of one repetition
};

/// What experiments and gates have in common; paths are resolved against the file.
struct MeasuredScene {
    std::filesystem::path scene;
    std::filesystem::path reference_folder;
    std::string reference_engine;
    std::vector<CurveDescription> curves;  ///< no two of the same id
    int width = 0, height = 0;             ///< of the film, pixels
};

struct ExperimentDescription : MeasuredScene {
    std::string name, title, thesis, claim;
    double expected_slope = 0, slope_tolerance = 0;
    Json expected_gain;  ///< {"algorithm", "samples", "time"} over path tracing, as the thesis
                         ///< states it, or null
    // of the chosen profile
    std::string profile;
    ThroughputDescription throughput;
    Json settings;       ///< {"integrator.beta": 2, ...} of all curves, besides their own
    std::string source;  ///< the file as written, of the chosen profile
};

/// Reads and checks an experiment; `profile` is "quick", "full", "ci" or "gpu". Throws `Error` (bad
/// input) naming file, key and alternatives.
ExperimentDescription load_experiment(const std::filesystem::path &path,
                                      const std::string &profile);

/// A description file, checked against its schema.
struct DescriptionFile {
    std::filesystem::path path;
    std::string text;
    Json json;

    /// The head of a message about the value at a JSON pointer.
    std::string location(const std::string &pointer) const {
        return json_location(path.string(), text, pointer);
    }

    /// Throws `Error` (bad input) listing the profiles when there is none of that name.
    const Json &profile(const std::string &name) const;

    /// All that the file says of one profile: a run of it does not depend on the others.
    std::string of_profile(const std::string &name) const;

    /// A path that the file gives relative to itself.
    std::filesystem::path resolve(const Json &relative) const;
};

/// Reads a file and checks it against `schema` ("gate.schema.json"). Throws `Error` (bad input)
/// naming file, key and alternatives.
DescriptionFile load_description(const std::filesystem::path &path, const std::string &schema);

/// Fills in "scene", "reference" and "curves" of a file and the film's size. Throws `Error` (bad
/// input) for two curves of one id.
void read_measured_scene(const DescriptionFile &file, const Json &size, MeasuredScene &scene);

/// Throws `Error` (bad input), its message beginning with `location`, unless the sample counts
/// increase.
void require_increasing(const std::vector<uint64_t> &spp, const std::string &location);

/// Applies {"integrator.beta": 2, ...}. Throws as `parse_render_settings` does.
void apply_settings(RenderSettings &settings, const Json &named);

/// Render settings from {"algorithm", "settings": {"integrator.beta": 2, ...}} with the names of
/// `--set`. What is not named keeps the renderer's default. Throws `Error` (bad usage) naming the
/// alternatives.
RenderSettings parse_render_settings(const Json &curve);

}  // namespace rtrays
