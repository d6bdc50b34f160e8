// SPDX-License-Identifier: MIT
#include "renderer/pipeline/settings.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <charconv>
#include <map>
#include <nlohmann/json.hpp>
#include <variant>

#include "renderer/base/error.h"
#include "renderer/bvh/builder.h"
#include "renderer/shared/film_layout.h"

namespace rtrays {

namespace {

// One row per setting serves parsing, printing, help and errors.
struct TextSetting {
    std::string RenderSettings::*field;
    std::vector<std::string> values;
};
struct CountSetting {
    uint32_t RenderSettings::*field;
    uint32_t largest;
    std::map<std::string, uint32_t> names = {};  // of special values
};
struct NumberSetting {
    float RenderSettings::*field;
    float above;  // exclusive bounds
    float below;
    bool or_zero = false;  // which then turns something off
};

struct Setting {
    std::string name;
    std::variant<TextSetting, CountSetting, NumberSetting> kind;
    std::string meaning;
};

constexpr uint32_t largest_count = 0x7fffffff;

/// The names of a table, after those given.
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
         "how light is found"},
        {"integrator.sampler", TextSetting{&S::sampler, {"independent", "sobol", "regular"}},
         "random numbers; sobol: stratified over the samples of a pixel, and over light paths; "
         "regular: the same points in "
         "every pixel, the first in its centre, for ray_casting and whitted, which take no others"},
        {"integrator.seen_emitters", TextSetting{&S::seen_emitters, {"mis", "camera"}},
         "bdpt, truncated_bdpt: emitters seen directly by both passes, or by camera paths alone"},
        {"integrator.light_paths",
         CountSetting{&S::light_paths,
                      1u << 30,
                      {{"pixels", LIGHT_PATHS_LIKE_PIXELS}, {"auto", LIGHT_PATHS_AUTO}}},
         "per sample of the image; pixels: as many as those; auto, of truncated_bdpt: as many as "
         "pay, or none, by a pilot"},
        {"integrator.bdpt_vertices", CountSetting{&S::bdpt_vertices, 64},
         "of bdpt: vertices kept of each light path; paths of more scattering events than that and "
         "one have the strategies "
         "of truncated_bdpt"},
        {"integrator.beta", NumberSetting{&S::beta, 0.0f, 1e3f}, "exponent of the power heuristic"},
        {"integrator.termination", TextSetting{&S::termination, {"roulette", "fixed", "adaptive"}},
         "how paths end; fixed (at max_depth) and adaptive are biased; whitted takes roulette for "
         "fixed"},
        {"integrator.max_depth", CountSetting{&S::max_depth, largest_count},
         "scattering events, 0: no limit (of whitted: 8)"},
        {"integrator.max_continuation", NumberSetting{&S::max_continuation, 0.0f, 1.0f},
         "largest continuation probability of roulette"},
        {"integrator.adaptive_threshold", NumberSetting{&S::adaptive_threshold, 0.0f, 1e3f},
         "throughput below which adaptive termination stops"},
        {"integrator.light_selection",
         TextSetting{&S::light_selection, {"uniform", "power", "mixed", "independent"}},
         "probability of a light; independent: all of them at every vertex, as always in "
         "ray_casting and whitted"},
        {"integrator.sphere_sampling", TextSetting{&S::sphere_sampling, {"cone", "area"}},
         "how sphere lights are sampled from a point; area is the thesis' choice"},
        {"integrator.convergence.error", NumberSetting{&S::convergence_error, 0.0f, 1e3f, true},
         "path_tracing, truncated_bdpt: pixels whose mean changes by less, in proportion, from N "
         "to 2N samples get no more "
         "camera paths (biased; thesis 3.3.7: 0.01 to 0.03); 0: all go on"},
        {"integrator.convergence.interval",
         CountSetting{&S::convergence_interval, FILM_ADDITIONS_BETWEEN_CARRIES},
         "samples between two checks of that"},
        {"integrator.convergence.start",
         CountSetting{&S::convergence_start, FILM_ADDITIONS_BETWEEN_CARRIES},
         "samples of the first check"},
        {"device.group_size", CountSetting{&S::group_size, 4096},
         "work-items per group, 0: by device"},
        {"device.stream_capacity", CountSetting{&S::stream_capacity, 1u << 26},
         "paths in flight, 0: by device; 131072 at most where light paths are traced"},
        {"device.stream_chunk", CountSetting{&S::stream_chunk, 256},
         "queue entries per work-item, 0: by device"},
        {"device.path_layout", TextSetting{&S::path_layout, {"auto", "interleaved", "arrays"}},
         "path states in memory"},
        {"device.bvh_layout", TextSetting{&S::bvh_layout, names_of(bvh_layouts, {"auto"})},
         "nodes of two children, traversed with a stack or without, or of eight; auto: by device"},
        {"device.bvh_builder", TextSetting{&S::bvh_builder, names_of(bvh_methods)},
         "binned_sah: top down, by bins; hploc: bottom up, by clustering, faster to build"},
        {"device.bvh_bins", TextSetting{&S::bvh_bins, {"4", "8", "16", "32"}},
         "on an axis, of binned_sah"},
        {"device.bvh_axes", TextSetting{&S::bvh_axes, {"all", "widest"}},
         "that are binned, of binned_sah; widest: the one along which the triangles of a node lie "
         "widest"},
        {"device.bvh_update", TextSetting{&S::bvh_update, {"rebuild", "refit"}},
         "what a scene that has moved does to its hierarchy; refit: that of time 0 is fitted to "
         "the time of --at"},
        {"device.pipeline", TextSetting{&S::pipeline, {"wavefront", "megakernel"}},
         "a kernel for every block, or one that traces whole paths, of path_tracing"},
        {"device.count_rays", TextSetting{&S::count_rays, {"in_all", "by_depth"}},
         "what --stats says of rays; by_depth: also by the scattering events before, pass by pass"},
        {"device.features", TextSetting{&S::features, {"scene", "all"}}, "what is compiled in"},
    };
    return table;
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
            exclusive ? "above" : "from", low, exclusive ? "below" : "to", high));
    }
    return value;
}

/// What an algorithm is made of.
struct Algorithm {
    std::string name;
    bool from_camera;
    bool from_light;
    bool draws;  ///< random numbers
    bool stops;  ///< pixels that have converged, if asked to
};

const std::vector<Algorithm> &algorithm_table() {
    static const std::vector<Algorithm> table = {
        {"ray_casting", true, false, false, false}, {"whitted", true, false, false, false},
        {"path_tracing", true, false, true, true},  {"light_tracing", false, true, true, false},
        {"bdpt", true, true, true, false},          {"truncated_bdpt", true, true, true, true},
    };
    return table;
}

const Algorithm &algorithm_of(const RenderSettings &settings) {
    const auto &table = algorithm_table();
    const auto found = std::find_if(table.begin(), table.end(), [&](const Algorithm &a) {
        return a.name == settings.algorithm;
    });
    if (found == table.end()) {
        throw input_error(fmt::format("no algorithm '{}'; there are: {}", settings.algorithm,
                                      fmt::join(algorithm_names(), ", ")));
    }
    return *found;
}

void require_value(const Setting &setting, const TextSetting &text, const std::string &value) {
    if (std::find(text.values.begin(), text.values.end(), value) == text.values.end()) {
        throw input_error(fmt::format("{}={}: the values of {} are {}", setting.name, value,
                                      setting.name, fmt::join(text.values, ", ")));
    }
}

void require_consistent_convergence(const RenderSettings &settings) {
    if (!has_convergence_control(settings)) {
        return;
    }
    if (!algorithm_of(settings).stops) {
        std::vector<std::string> names;
        for (const Algorithm &algorithm : algorithm_table()) {
            if (algorithm.stops) {
                names.push_back(algorithm.name);
            }
        }
        throw input_error(
            fmt::format("integrator.convergence.error={}: {} does not stop pixels; {} do",
                        settings.convergence_error, settings.algorithm, fmt::join(names, " and ")));
    }
    if (settings.strategies_apart) {
        throw input_error(
            "integrator.convergence.error: pixels are stopped by their image, which layers of "
            "strategies do not hold whole");
    }
    for (const auto &[name, samples] : {std::pair("interval", settings.convergence_interval),
                                        std::pair("start", settings.convergence_start)}) {
        if (samples == 0 || samples % 2 != 0) {
            throw input_error(
                fmt::format("integrator.convergence.{}={}: must be even and not 0, since half of "
                            "the samples are compared "
                            "with all",
                            name, samples));
        }
    }
}

}  // namespace

const std::vector<std::string> &algorithm_names() {
    static const std::vector<std::string> names = [] {
        std::vector<std::string> list;
        for (const Algorithm &algorithm : algorithm_table()) {
            list.push_back(algorithm.name);
        }
        return list;
    }();
    return names;
}

void apply_setting(RenderSettings &settings, const std::string &assignment) {
    const size_t equals = assignment.find('=');
    const std::string name = assignment.substr(0, equals);
    const auto &table = setting_table();
    const auto found =
        std::find_if(table.begin(), table.end(), [&](const Setting &s) { return s.name == name; });
    if (equals == std::string::npos || found == table.end()) {
        throw input_error(fmt::format("'{}' is no setting; settings are NAME=VALUE with:\n{}",
                                      assignment, describe_settings()));
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
    const bool draws = algorithm_of(settings).draws;
    for (const Setting &setting : setting_table()) {
        if (const auto *text = std::get_if<TextSetting>(&setting.kind)) {
            require_value(setting, *text, settings.*text->field);
        }
    }
    if (settings.algorithm != "path_tracing" && settings.strategies != "mis") {
        throw input_error(fmt::format("integrator.strategies={}: {} has strategies of its own",
                                      settings.strategies, settings.algorithm));
    }
    if (draws && settings.sampler == "regular") {
        throw input_error(
            fmt::format("integrator.sampler=regular: {} needs random numbers, independent or sobol",
                        settings.algorithm));
    }
    if (!draws && settings.sampler == "sobol") {
        throw input_error(fmt::format(
            "integrator.sampler=sobol: {} draws no random numbers; its samples are regular",
            settings.algorithm));
    }
    if (!draws && (settings.light_selection == "uniform" || settings.light_selection == "power")) {
        throw input_error(fmt::format(
            "integrator.light_selection={}: {} draws no light, it joins every point to all of them",
            settings.light_selection, settings.algorithm));
    }
    if (settings.algorithm == "bdpt" && settings.light_paths != LIGHT_PATHS_LIKE_PIXELS) {
        throw input_error(
            "integrator.light_paths: bdpt joins every camera path to a light path of its own");
    }
    if (settings.light_paths == LIGHT_PATHS_AUTO && settings.algorithm != "truncated_bdpt") {
        throw input_error(
            fmt::format("integrator.light_paths=auto: {} has no choice; truncated_bdpt has",
                        settings.algorithm));
    }
    if (settings.light_paths == 0 && settings.algorithm == "light_tracing") {
        throw input_error("integrator.light_paths=0: light_tracing has nothing else");
    }
    if (settings.algorithm == "bdpt" && settings.passes != "all") {
        throw input_error(fmt::format(
            "the passes of bdpt share their light paths and are not rendered apart: '{}'",
            settings.passes));
    }
    if (settings.strategies_apart && (settings.variance || settings.passes != "all")) {
        throw input_error(
            "layers of strategies go with all passes and without variance: the strategies share "
            "their paths");
    }
    if (settings.pipeline == "megakernel" && settings.algorithm != "path_tracing") {
        throw input_error(
            fmt::format("device.pipeline=megakernel traces path_tracing alone; {} needs "
                        "device.pipeline=wavefront",
                        settings.algorithm));
    }
    if (settings.pipeline == "megakernel" && settings.count_rays == "by_depth") {
        throw input_error(
            "device.count_rays=by_depth counts what is in the streams of "
            "device.pipeline=wavefront");
    }
    if (settings.pipeline == "megakernel" && settings.strategies_apart) {
        throw input_error("layers of strategies need device.pipeline=wavefront");
    }
    if (settings.strategies_apart && !draws) {
        throw input_error(fmt::format("layers of strategies: {} has but one", settings.algorithm));
    }
    if (draws && settings.termination == "fixed" && settings.max_depth == 0) {
        throw input_error(
            "integrator.termination=fixed needs a limit: --set integrator.max_depth=N");
    }
    require_consistent_convergence(settings);
}

RenderSettings with_fixed_choices(RenderSettings settings) {
    if (!algorithm_of(settings).draws) {
        settings.strategies = "explicit";
        settings.sampler = "regular";
        settings.light_selection = "independent";
        settings.termination = settings.termination == "roulette" ? "fixed" : settings.termination;
        settings.max_depth = settings.algorithm == "ray_casting" ? 1
                             : settings.max_depth == 0           ? 8
                                                                 : settings.max_depth;
    }
    return settings;
}

nlohmann::json image_settings(const RenderSettings &requested) {
    const RenderSettings settings = with_fixed_choices(requested);
    nlohmann::json document = {{"algorithm", settings.algorithm}};
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
            "  {} = {}  {}{}\n", setting.name, value_text(defaults, setting), setting.meaning,
            text == nullptr ? "" : fmt::format(" ({})", fmt::join(text->values, " | ")));
    }
    return description;
}

std::string scheduled_algorithm(const RenderSettings &settings) {
    return settings.algorithm == "truncated_bdpt" && settings.light_paths == 0 ? "path_tracing"
                                                                               : settings.algorithm;
}

bool has_light_pass(const RenderSettings &settings) {
    return algorithm_of(settings).from_light && settings.light_paths != 0;
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
    return {settings.width,
            settings.height,
            selection,
            settings.sphere_sampling == "area",
            settings.features == "all",
            !algorithm_of(settings).draws};
}

void choose_builder(const RenderSettings &settings, BvhBuildParameters &parameters) {
    for (const NamedBvhMethod &named : bvh_methods) {
        parameters.method = settings.bvh_builder == named.name ? named.method : parameters.method;
    }
    parameters.bins = static_cast<uint32_t>(std::stoul(settings.bvh_bins));
    parameters.axes = settings.bvh_axes == "widest" ? 1 : 3;
}

FeatureMask settings_features(const RenderSettings &settings) {
    const Algorithm &algorithm = algorithm_of(settings);
    const bool both_ways = algorithm.from_camera && has_light_pass(settings);
    return FeatureMask()
        .with(Feature::implicit_light, algorithm.from_camera && settings.strategies != "explicit")
        .with(Feature::explicit_light, algorithm.from_camera && settings.strategies != "implicit")
        .with(Feature::light_strategy, both_ways)
        .with(Feature::vertex_joins, settings.algorithm == "bdpt")
        .with(Feature::branches, settings.algorithm == "whitted")
        .with(Feature::light_emitters, both_ways && settings.seen_emitters == "mis")
        .with(Feature::roulette, settings.termination == "roulette")
        .with(Feature::adaptive, settings.termination == "adaptive")
        .with(Feature::sobol, settings.sampler != "independent")
        .with(Feature::depth_limit, settings.max_depth != 0)
        .with(Feature::convergence, has_convergence_control(settings))
        .with(Feature::variance, settings.variance);
}

}  // namespace rtrays
