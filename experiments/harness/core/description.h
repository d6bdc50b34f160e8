// SPDX-License-Identifier: MIT
// Reads files that describe experiments, and the parts that several kinds share.
#pragma once

#include <cstdint>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <vector>

#include "renderer/base/json.h"
#include "renderer/session/settings.h"

namespace rtrays {

/// Another renderer whose images are a curve.
struct OtherRenderer {
    std::string engine;                  ///< "mitsuba", "cycles" or "command"
    std::string variant;                 ///< of Mitsuba
    uint32_t roulette_start = 0;         ///< scattering event from which Mitsuba's roulette acts
    std::vector<std::string> command{};  ///< of "command"; see curve_source.h
};

/// A curve: an algorithm with its settings, or another renderer. `spp`, `early_images` and `seeds`
/// are set for experiments only.
struct CurveDescription {
    RenderSettings settings;         ///< size and seed are set by the runner
    std::vector<uint64_t> spp = {};  ///< strictly increasing
    /// Sample counts at which the first seed's image is kept.
    std::vector<uint64_t> early_images = {};
    uint32_t seeds = 0;                       ///< seeds are 1 .. seeds
    std::string label = {};                   ///< name on pages; empty: from the id
    std::optional<OtherRenderer> other = {};  ///< then the settings do not count

    /// Returns the identifier that names the curve's files: "path_tracing.mis",
    /// "truncated_bdpt.mis,light_paths=auto", "mitsuba.llvm_ad_rgb,roulette_start=5", "cycles" or
    /// "command.my_renderer".
    std::string id() const;
};

/// Common part of experiments and gates. Paths are resolved against the description file.
struct MeasuredScene {
    std::filesystem::path scene;
    std::filesystem::path reference_folder;
    std::string reference_engine;
    std::vector<CurveDescription> curves;  ///< with distinct ids
    int width = 0, height = 0;             ///< film size, pixels
};

/// A description file.
struct DescriptionFile {
    std::filesystem::path path;
    std::string text;
    Json json;

    /// Returns the beginning of a message about the value at a JSON pointer.
    std::string location(const std::string &pointer) const {
        return json_location(path.string(), text, pointer);
    }

    /// Returns a profile. Throws `Error` (bad input) listing the profiles if the name is unknown.
    const Json &profile(const std::string &name) const;

    /// Returns the profile of a run that names none: "quick", or the only one.
    std::string default_profile() const;

    /// Returns the file's text with one profile alone. A run does not depend on other profiles.
    std::string of_profile(const std::string &name) const;

    /// Resolves a path that is given relative to the file.
    std::filesystem::path resolve(const Json &relative) const;

    /// Returns the scene files of a profile's "scenes", names without ".json" relative to the
    /// file's "folder". "features/*" names all scenes of a folder, in alphabetical order.
    std::vector<std::filesystem::path> scenes(const Json &profile) const;
};

/// Reads a file. Throws `Error` (bad input) naming the file and the line if it is not JSON.
DescriptionFile read_description(const std::filesystem::path &path);

/// Checks a file against `schema` ("gate.schema.json"). Throws `Error` (bad input) naming the file,
/// the key and the alternatives.
void require_schema(const DescriptionFile &file, const std::string &schema);

/// Reads a file and checks it against `schema`. Throws like `read_description` and
/// `require_schema`.
DescriptionFile load_description(const std::filesystem::path &path, const std::string &schema);

/// Fills `scene` from a file's "scene", "reference" and "curves" and from the film size. Throws
/// `Error` (bad input) if two curves have the same id.
void read_measured_scene(const DescriptionFile &file, const Json &size, MeasuredScene &scene);

/// Throws `Error` (bad input) with a message that begins with `location` unless the sample counts
/// increase strictly.
void require_increasing(const std::vector<uint64_t> &spp, const std::string &location);

/// Applies settings by name: {"integrator.beta": 2, ...}. Throws as `parse_render_settings` does.
void apply_settings(RenderSettings &settings, const Json &named);

/// Returns a name of lower-case letters, digits and underscores, for files.
std::string file_name_of(const std::string &text);

/// Reads render settings from {"algorithm", "settings": {"integrator.beta": 2, ...}} with the names
/// of `--set`. Settings that are not named keep the renderer's defaults. Throws `Error` (bad input)
/// naming the alternatives.
RenderSettings parse_render_settings(const Json &curve);

}  // namespace rtrays
