// SPDX-License-Identifier: MIT
#include "renderer/session/settings.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <charconv>
#include <map>
#include <nlohmann/json.hpp>
#include <sstream>
#include <variant>

#include "renderer/base/error.h"
#include "renderer/bvh/builder.h"
#include "renderer/shared/film_layout.h"

namespace rtrays {

namespace {

// Each setting has one row, from which parsing, printing, help and error messages derive.
struct TextSetting {
    std::string RenderSettings::*field;
    std::vector<std::string> values;
};
struct CountSetting {
    uint32_t RenderSettings::*field;
    uint32_t largest;
    std::map<std::string, uint32_t> names = {};  // names of special values
};
struct NumberSetting {
    float RenderSettings::*field;
    float above;           // exclusive lower bound
    float below;           // exclusive upper bound
    bool or_zero = false;  // 0 is allowed in addition and turns a feature off
};

struct Setting {
    std::string name;
    std::variant<TextSetting, CountSetting, NumberSetting> kind;
    std::string meaning;
};

constexpr uint32_t largest_count = 0x7fffffff;

/// Returns `names` followed by the names of a table's rows.
template <typename Table>
std::vector<std::string> names_of(const Table &table, std::vector<std::string> names = {}) {
    for (const auto &row : table) {
        names.emplace_back(row.name);
    }
    return names;
}

const std::vector<Setting> &setting_table() {
    using S = RenderSettings;
    static const std::vector<Setting> table = {
        {"integrator.strategies", TextSetting{&S::strategies, {"implicit", "explicit", "mis"}},
         "how path_tracing samples light; implicit: paths that hit emitters; explicit: next-event "
         "estimation; mis: both, with multiple importance sampling"},
        {"integrator.sampler", TextSetting{&S::sampler, {"independent", "sobol", "regular"}},
         "random numbers; independent: pseudorandom; sobol: scrambled Sobol points, stratified "
         "over the samples of a pixel and over light paths; regular: the same points in every "
         "pixel, the first at its centre (always used by ray_casting and whitted, and only by "
         "them)"},
        {"integrator.seen_emitters", TextSetting{&S::seen_emitters, {"mis", "camera"}},
         "bdpt, truncated_bdpt: passes that contribute emitters seen directly by the camera; mis: "
         "the camera pass and the light pass, with multiple importance sampling; camera: the "
         "camera pass only"},
        {"integrator.light_paths",
         CountSetting{&S::light_paths,
                      1u << 30,
                      {{"pixels", LIGHT_PATHS_LIKE_PIXELS}, {"auto", LIGHT_PATHS_AUTO}}},
         "number of light paths for one sample of every pixel; pixels: as many as the image has "
         "pixels; auto (truncated_bdpt only): a short pilot render chooses the most efficient "
         "number, possibly 0"},
        {"integrator.bdpt_vertices", CountSetting{&S::bdpt_vertices, 64},
         "bdpt: number N of vertices stored per light path; paths of more than N + 1 scattering "
         "events are sampled by the strategies of truncated_bdpt only"},
        {"integrator.beta", NumberSetting{&S::beta, 0.0f, 1e3f},
         "exponent of the power heuristic of multiple importance sampling"},
        {"integrator.termination", TextSetting{&S::termination, {"roulette", "fixed", "adaptive"}},
         "how paths end; roulette: Russian roulette (unbiased); fixed: after max_depth scattering "
         "events (biased); adaptive: when the throughput falls below adaptive_threshold (biased); "
         "ray_casting and whitted use fixed instead of roulette"},
        {"integrator.max_depth", CountSetting{&S::max_depth, largest_count},
         "maximum number of scattering events of a path, 0: no limit (whitted: 8; ray_casting "
         "always uses 1)"},
        {"integrator.max_continuation", NumberSetting{&S::max_continuation, 0.0f, 1.0f},
         "largest probability with which Russian roulette continues a path"},
        {"integrator.adaptive_threshold", NumberSetting{&S::adaptive_threshold, 0.0f, 1e3f},
         "throughput below which adaptive termination ends a path"},
        {"integrator.light_selection",
         TextSetting{&S::light_selection, {"uniform", "power", "mixed", "independent"}},
         "selection of a light for next-event estimation or the start of a light path; uniform: "
         "equal probabilities; power: in proportion to the light's power; mixed: mean of both; "
         "independent: next-event estimation samples every light at every vertex, as ray_casting "
         "and whitted always do"},
        {"integrator.sphere_sampling", TextSetting{&S::sphere_sampling, {"cone", "area"}},
         "how points on sphere lights are sampled; cone: uniformly in the solid angle that the "
         "sphere subtends; area: uniformly on its surface (as in the thesis)"},
        {"integrator.convergence.error", NumberSetting{&S::convergence_error, 0.0f, 1e3f, true},
         "path_tracing, truncated_bdpt: a pixel gets no more camera paths when its mean over half "
         "of its samples differs from its mean over all by less than this relative error (biased; "
         "thesis 3.3.7 uses 0.01 to 0.03), 0: no pixel stops"},
        {"integrator.convergence.interval",
         CountSetting{&S::convergence_interval, FILM_ADDITIONS_BETWEEN_CARRIES},
         "samples between two convergence checks, an even number"},
        {"integrator.convergence.start",
         CountSetting{&S::convergence_start, FILM_ADDITIONS_BETWEEN_CARRIES},
         "samples before the first convergence check, an even number"},
        {"device.group_size", CountSetting{&S::group_size, 4096},
         "work-items per work-group, 0: chosen for the device"},
        {"device.stream_capacity", CountSetting{&S::stream_capacity, 1u << 26},
         "paths in flight, 0: chosen for the device; at most 131072 if light paths are traced"},
        {"device.stream_chunk", CountSetting{&S::stream_chunk, 256},
         "queue entries that a work-item processes, 0: chosen for the device"},
        {"device.path_layout", TextSetting{&S::path_layout, {"auto", "interleaved", "arrays"}},
         "layout of path states in memory; interleaved: array of structures; arrays: structure of "
         "arrays; auto: chosen for the device"},
        {"device.bvh_layout", TextSetting{&S::bvh_layout, names_of(bvh_layouts, {"auto"})},
         "layout of BVH nodes; bvh2: two children, traversed with a stack; bvh2_stackless: two "
         "children, traversed without a stack; wide8: eight children; auto: chosen for the device"},
        {"device.bvh_builder", TextSetting{&S::bvh_builder, names_of(bvh_methods)},
         "how the BVH is built; binned_sah: top-down by the binned surface area heuristic; hploc: "
         "bottom-up by clustering (H-PLOC), faster to build"},
        {"device.bvh_bins", TextSetting{&S::bvh_bins, {"4", "8", "16", "32"}},
         "binned_sah: number of bins per axis"},
        {"device.bvh_axes", TextSetting{&S::bvh_axes, {"all", "widest"}},
         "binned_sah: axes that are binned; widest: only the axis along which a node's centroids "
         "extend furthest"},
        {"device.bvh_update", TextSetting{&S::bvh_update, {"rebuild", "refit"}},
         "how the BVH follows an animated scene; rebuild: it is built at the time of --at; refit: "
         "it is built at time 0 and its bounds are refitted to the time of --at"},
        {"device.pipeline", TextSetting{&S::pipeline, {"wavefront", "megakernel"}},
         "wavefront: one kernel per stage; megakernel: one kernel that traces complete paths "
         "(path_tracing only)"},
        {"device.count_rays", TextSetting{&S::count_rays, {"in_all", "by_depth"}},
         "ray counts in the file of --stats; in_all: totals; by_depth: also for each pass by the "
         "number of scattering events before the ray"},
        {"device.features", TextSetting{&S::features, {"scene", "all"}},
         "code that is compiled into the kernels; scene: the features that scene and settings use; "
         "all: every feature"},
    };
    return table;
}

/// Breaks a help text into indented lines of at most 100 columns.
std::string wrapped(const std::string &text) {
    constexpr size_t width = 100;
    const std::string indent(6, ' ');
    std::istringstream words(text);
    std::string lines, line = indent, word;
    while (words >> word) {
        if (line.size() > indent.size() && line.size() + 1 + word.size() > width) {
            lines += line + "\n";
            line = indent;
        }
        line += (line.size() > indent.size() ? " " : "") + word;
    }
    return lines + line + "\n";
}

std::string value_text(const RenderSettings &settings, const Setting &setting) {
    if (const auto *text = std::get_if<TextSetting>(&setting.kind)) {
        return settings.*text->field;
    }
    if (const auto *count = std::get_if<CountSetting>(&setting.kind)) {
        for (const auto &[name, value] : count->names) {
            if (settings.*count->field == value) {
                return name;
            }
        }
        return fmt::format("{}", settings.*count->field);
    }
    return fmt::format("{}", settings.*std::get<NumberSetting>(setting.kind).field);
}

template <typename T>
T parse_number(const std::string &assignment, const std::string &text, T low, T high,
               bool exclusive, bool or_zero = false) {
    T value{};
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
    const bool inside = exclusive ? value > low && value < high : value >= low && value <= high;
    if (error != std::errc() || end != text.data() + text.size() ||
        !(inside || (or_zero && value == 0))) {
        throw input_error(fmt::format(
            "{}: the value must be {}a number {} {} and {} {}", assignment, or_zero ? "0 or " : "",
            exclusive ? "above" : "of at least", low, exclusive ? "below" : "at most", high));
    }
    return value;
}

void require_value(const Setting &setting, const TextSetting &text, const std::string &value) {
    if (std::find(text.values.begin(), text.values.end(), value) == text.values.end()) {
        throw input_error(fmt::format("{}={}: unknown value; the values of {} are: {}",
                                      setting.name, value, setting.name,
                                      fmt::join(text.values, ", ")));
    }
}

void require_consistent_convergence(const RenderSettings &settings) {
    if (!has_convergence_control(settings)) {
        return;
    }
    if (!settings.algorithm->stops_pixels) {
        std::vector<std::string> names;
        for (const Algorithm *algorithm : all_algorithms()) {
            if (algorithm->stops_pixels) {
                names.emplace_back(algorithm->name);
            }
        }
        throw input_error(fmt::format(
            "integrator.convergence.error={}: {} does not support convergence control; {} do",
            settings.convergence_error, settings.algorithm->name, fmt::join(names, " and ")));
    }
    if (settings.strategies_apart) {
        throw input_error(
            "integrator.convergence.error: convergence is decided by the full image, which layers "
            "of strategies split; use one of the two");
    }
    for (const auto &[name, samples] : {std::pair("interval", settings.convergence_interval),
                                        std::pair("start", settings.convergence_start)}) {
        if (samples == 0 || samples % 2 != 0) {
            throw input_error(
                fmt::format("integrator.convergence.{}={}: must be even and not 0, because half of "
                            "the samples are compared with all",
                            name, samples));
        }
    }
}

}  // namespace

void apply_setting(RenderSettings &settings, const std::string &assignment) {
    const size_t equals = assignment.find('=');
    const std::string name = assignment.substr(0, equals);
    const auto &table = setting_table();
    const auto found =
        std::find_if(table.begin(), table.end(), [&](const Setting &s) { return s.name == name; });
    if (equals == std::string::npos || found == table.end()) {
        std::vector<std::string> names;
        for (const Setting &setting : table) {
            names.push_back(setting.name);
        }
        throw input_error(fmt::format(
            "{} '{}'; settings are: {}",
            equals == std::string::npos ? "expected NAME=VALUE, got" : "unknown setting",
            equals == std::string::npos ? assignment : name, fmt::join(names, ", ")));
    }
    const std::string value = assignment.substr(equals + 1);
    if (const auto *text = std::get_if<TextSetting>(&found->kind)) {
        require_value(*found, *text, value);
        settings.*text->field = value;
    } else if (const auto *count = std::get_if<CountSetting>(&found->kind)) {
        const auto named = count->names.find(value);
        settings.*count->field =
            named != count->names.end()
                ? named->second
                : parse_number<uint32_t>(assignment, value, 0, count->largest, false);
    } else {
        const auto &number = std::get<NumberSetting>(found->kind);
        settings.*number.field = parse_number<float>(assignment, value, number.above, number.below,
                                                     true, number.or_zero);
    }
}

void require_consistent(const RenderSettings &settings) {
    const Algorithm &algorithm = *settings.algorithm;
    for (const Setting &setting : setting_table()) {
        if (const auto *text = std::get_if<TextSetting>(&setting.kind)) {
            require_value(setting, *text, settings.*text->field);
        }
    }
    if (!algorithm.selects_strategies && settings.strategies != "mis") {
        throw input_error(fmt::format(
            "integrator.strategies={}: {} has fixed strategies; this setting is for path_tracing",
            settings.strategies, algorithm.name));
    }
    if (algorithm.is_random && settings.sampler == "regular") {
        throw input_error(fmt::format(
            "integrator.sampler=regular: {} needs random numbers; use independent or sobol",
            algorithm.name));
    }
    if (!algorithm.is_random && settings.sampler == "sobol") {
        throw input_error(fmt::format(
            "integrator.sampler=sobol: {} draws no random numbers; use regular", algorithm.name));
    }
    if (!algorithm.is_random &&
        (settings.light_selection == "uniform" || settings.light_selection == "power")) {
        throw input_error(fmt::format(
            "integrator.light_selection={}: {} samples every light at every point; use independent",
            settings.light_selection, algorithm.name));
    }
    if (algorithm.light_paths == LightPaths::one_per_camera_path &&
        settings.light_paths != LIGHT_PATHS_LIKE_PIXELS) {
        throw input_error(
            "integrator.light_paths: bdpt traces one light path per camera path; use pixels");
    }
    if (settings.light_paths == LIGHT_PATHS_AUTO && algorithm.light_paths != LightPaths::any) {
        throw input_error(
            fmt::format("integrator.light_paths=auto: not supported by {}; use pixels, a number or "
                        "truncated_bdpt",
                        algorithm.name));
    }
    if (settings.light_paths == 0 && algorithm.light_paths == LightPaths::at_least_one) {
        throw input_error(
            "integrator.light_paths=0: light_tracing needs light paths; use pixels or a number "
            "above 0");
    }
    if (algorithm.light_paths == LightPaths::one_per_camera_path && settings.passes != "all") {
        throw input_error(fmt::format(
            "passes={}: the passes of bdpt share their light paths; use all", settings.passes));
    }
    if (settings.strategies_apart && (settings.variance || settings.passes != "all")) {
        throw input_error(
            "layers of strategies: render all passes and omit the layer 'variance'; the strategies "
            "share "
            "their paths");
    }
    if (settings.pipeline == "megakernel" && !algorithm.has_megakernel) {
        throw input_error(
            fmt::format("device.pipeline=megakernel: supports path_tracing only; {} needs "
                        "device.pipeline=wavefront",
                        algorithm.name));
    }
    if (settings.pipeline == "megakernel" && settings.count_rays == "by_depth") {
        throw input_error(
            "device.count_rays=by_depth: counts rays in the streams between stages; use "
            "device.pipeline=wavefront");
    }
    if (settings.pipeline == "megakernel" && settings.strategies_apart) {
        throw input_error(
            "layers of strategies: not supported by megakernel; use device.pipeline=wavefront");
    }
    if (settings.strategies_apart && !algorithm.is_random) {
        throw input_error(
            fmt::format("layers of strategies: {} has only one strategy", algorithm.name));
    }
    if (algorithm.is_random && settings.termination == "fixed" && settings.max_depth == 0) {
        throw input_error(
            "integrator.termination=fixed: needs a limit; use --set integrator.max_depth=N");
    }
    require_consistent_convergence(settings);
}

RenderSettings with_fixed_choices(RenderSettings settings) {
    const Algorithm &algorithm = *settings.algorithm;
    if (!algorithm.is_random) {
        settings.strategies = "explicit";
        settings.sampler = "regular";
        settings.light_selection = "independent";
        settings.termination = settings.termination == "roulette" ? "fixed" : settings.termination;
    }
    if (algorithm.fixed_depth > 0) {
        settings.max_depth = algorithm.fixed_depth;
    } else if (settings.max_depth == 0) {
        settings.max_depth = algorithm.default_depth;
    }
    return settings;
}

nlohmann::json image_settings(const RenderSettings &requested) {
    const RenderSettings settings = with_fixed_choices(requested);
    nlohmann::json document = {{"algorithm", settings.algorithm->name}};
    for (const Setting &setting : setting_table()) {
        if (setting.name.rfind("integrator.", 0) == 0) {
            document[setting.name] = value_text(settings, setting);
        }
    }
    for (const auto &[path, text] : settings.source_overlays) {
        document["overlays"][path] = text;
    }
    return document;
}

std::vector<std::string> changed_settings(const RenderSettings &settings) {
    const RenderSettings defaults;
    std::vector<std::string> changed;
    for (const Setting &setting : setting_table()) {
        const std::string value = value_text(settings, setting);
        if (setting.name.rfind("integrator.", 0) == 0 && value != value_text(defaults, setting)) {
            changed.push_back(setting.name + "=" + value);
        }
    }
    return changed;
}

std::string describe_settings() {
    const RenderSettings defaults;
    std::string description;
    for (const Setting &setting : setting_table()) {
        const auto *text = std::get_if<TextSetting>(&setting.kind);
        description += fmt::format(
            "  {} = {}{}\n{}", setting.name, value_text(defaults, setting),
            text == nullptr ? "" : fmt::format("  ({})", fmt::join(text->values, " | ")),
            wrapped(setting.meaning));
    }
    return description;
}

bool has_light_pass(const RenderSettings &settings) {
    return settings.algorithm->traces_light_paths() && settings.light_paths != 0;
}

bool has_convergence_control(const RenderSettings &settings) {
    return settings.convergence_error > 0;
}

uint32_t light_paths_per_sample(const RenderSettings &settings) {
    return settings.light_paths != LIGHT_PATHS_LIKE_PIXELS
               ? settings.light_paths
               : static_cast<uint32_t>(settings.width) * static_cast<uint32_t>(settings.height);
}

IntegratorSettings integrator_settings(const RenderSettings &settings) {
    IntegratorSettings numbers{};
    numbers.seed = settings.seed;
    const FeatureMask features = settings_features(settings);
    for (const auto &[feature, bit] :
         {std::pair(Feature::implicit_light, STRATEGY_IMPLICIT),
          std::pair(Feature::explicit_light, STRATEGY_EXPLICIT),
          std::pair(Feature::light_strategy, STRATEGY_LIGHT),
          std::pair(Feature::light_emitters, STRATEGY_LIGHT_EMITTERS)}) {
        numbers.strategies |= features.has(feature) ? bit : 0u;
    }
    numbers.sampler = settings.sampler == "sobol"     ? SAMPLER_SOBOL
                      : settings.sampler == "regular" ? SAMPLER_REGULAR
                                                      : SAMPLER_INDEPENDENT;
    numbers.light_paths = light_paths_per_sample(settings);
    numbers.light_vertices = settings.bdpt_vertices;
    numbers.termination = settings.termination == "roulette"   ? TERMINATION_ROULETTE
                          : settings.termination == "adaptive" ? TERMINATION_ADAPTIVE
                                                               : TERMINATION_FIXED;
    numbers.max_depth = settings.max_depth == 0 ? UNLIMITED_DEPTH : settings.max_depth;
    numbers.beta = settings.beta;
    numbers.max_continuation = settings.max_continuation;
    numbers.adaptive_threshold = settings.adaptive_threshold;
    return numbers;
}

CompileSettings compile_settings(const RenderSettings &settings) {
    const LightSelection selection = settings.light_selection == "uniform" ? LightSelection::uniform
                                     : settings.light_selection == "power" ? LightSelection::power
                                     : settings.light_selection == "independent"
                                         ? LightSelection::independent
                                         : LightSelection::mixed;
    return {selection, settings.sphere_sampling == "area", settings.features == "all",
            !settings.algorithm->is_random};
}

void choose_builder(const RenderSettings &settings, BvhBuildParameters &parameters) {
    for (const NamedBvhMethod &named : bvh_methods) {
        parameters.method = settings.bvh_builder == named.name ? named.method : parameters.method;
    }
    parameters.bins = static_cast<uint32_t>(std::stoul(settings.bvh_bins));
    parameters.axes = settings.bvh_axes == "widest" ? 1 : 3;
}

FeatureMask settings_features(const RenderSettings &settings) {
    const Algorithm &algorithm = *settings.algorithm;
    const bool both_ways = algorithm.traces_camera_paths && has_light_pass(settings);
    return algorithm.features
        .with(Feature::implicit_light,
              algorithm.traces_camera_paths && settings.strategies != "explicit")
        .with(Feature::explicit_light,
              algorithm.traces_camera_paths && settings.strategies != "implicit")
        .with(Feature::light_strategy, both_ways)
        .with(Feature::light_emitters, both_ways && settings.seen_emitters == "mis")
        .with(Feature::roulette, settings.termination == "roulette")
        .with(Feature::adaptive, settings.termination == "adaptive")
        .with(Feature::sobol, settings.sampler != "independent")
        .with(Feature::depth_limit, settings.max_depth != 0)
        .with(Feature::convergence, has_convergence_control(settings))
        .with(Feature::variance, settings.variance);
}

}  // namespace rtrays
