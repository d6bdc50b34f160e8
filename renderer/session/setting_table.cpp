// SPDX-License-Identifier: MIT
#include "renderer/session/setting_table.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <charconv>

#include "renderer/base/error.h"
#include "renderer/shared/film_layout.h"

namespace rtrays {

namespace {

using S = RenderSettings;

constexpr uint32_t largest_count = 0x7fffffff;

/// Name of the value that leaves the choice to the device.
constexpr const char *automatic = "auto";

template <typename T, size_t n>
std::vector<std::string> names_of(const Named<T> (&table)[n], std::vector<std::string> names = {}) {
    for (const Named<T> &row : table) {
        names.emplace_back(row.name);
    }
    return names;
}

/// Returns the setting whose values are the rows of a table.
template <typename T, size_t n>
ChoiceSetting choice(T S::*field, const Named<T> (&table)[n]) {
    const auto print = [field, &table](const S &settings) {
        return std::string(name_in(table, settings.*field));
    };
    const auto choose = [field, &table](S &settings, const std::string &name) {
        const std::optional<T> value = find_named(table, name);
        settings.*field = value.value_or(settings.*field);
        return value.has_value();
    };
    return {names_of(table), print, choose};
}

/// Returns the setting whose values are the rows of a table and `automatic`.
template <typename T, size_t n>
ChoiceSetting choice(std::optional<T> S::*field, const Named<T> (&table)[n]) {
    const auto print = [field, &table](const S &settings) {
        return std::string(settings.*field ? name_in(table, *(settings.*field)) : automatic);
    };
    const auto choose = [field, &table](S &settings, const std::string &name) {
        const std::optional<T> value = find_named(table, name);
        const bool known = value || name == automatic;
        settings.*field = known ? value : settings.*field;
        return known;
    };
    return {names_of(table, {automatic}), print, choose};
}

template <typename T>
T parse_number(const Setting &setting, const std::string &text, T low, T high, bool exclusive,
               bool or_zero = false) {
    T value{};
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
    const bool inside = exclusive ? value > low && value < high : value >= low && value <= high;
    if (error != std::errc() || end != text.data() + text.size() ||
        !(inside || (or_zero && value == 0))) {
        throw input_error(fmt::format("{}={}: the value must be {}a number {} {} and {} {}",
                                      setting.name, text, or_zero ? "0 or " : "",
                                      exclusive ? "above" : "of at least", low,
                                      exclusive ? "below" : "at most", high));
    }
    return value;
}

}  // namespace

const std::vector<Setting> &image_setting_table() {
    static const std::vector<Setting> table = {
        {"integrator.strategies", choice(&S::strategies, path_strategies),
         "how camera paths sample light; implicit: they hit emitters; explicit: next-event "
         "estimation (path_tracing); mis: both, with multiple importance sampling"},
        {"integrator.sampler", choice(&S::sampler, samplers),
         "random numbers; independent: pseudorandom; sobol: scrambled Sobol points, stratified "
         "over the samples of a pixel and over light paths; regular: the same points in every "
         "pixel, the first at its centre (always used by ray_casting and whitted, and only by "
         "them)"},
        {"integrator.seen_emitters", choice(&S::seen_emitters, seen_emitters_choices),
         "bdpt, truncated_bdpt: passes that contribute emitters seen directly by the camera; mis: "
         "the camera pass and the light pass, with multiple importance sampling; camera: the "
         "camera pass only"},
        {"integrator.light_paths",
         CountSetting{&S::light_paths,
                      1u << 30,
                      {{"pixels", LIGHT_PATHS_LIKE_PIXELS}, {"auto", LIGHT_PATHS_AUTO}}},
         "number of light paths for one sample of every pixel; pixels: as many as the image has "
         "pixels; auto (truncated_bdpt only): a pilot chooses the most efficient number, "
         "possibly 0, and whether light samples are worth their time"},
        {"integrator.guided_emission", choice(&S::guided_emission, guided_emissions),
         "how light paths select their light and direction; off: by power and cosine; flat: "
         "through tables of directions whose bins are all equal, to test the tables; at most 64 "
         "lights; trained (truncated_bdpt only): through tables that a pilot trains, for at most "
         "64 lights"},
        {"integrator.guided_scattering", choice(&S::guided_scattering, guided_scatterings),
         "how camera paths select their direction behind mirrors and smooth glass; off: by the "
         "material; trained (truncated_bdpt only): half of them by tables of the light that light "
         "paths of a pilot brought there"},
        {"integrator.bdpt_vertices", CountSetting{&S::bdpt_vertices, 64},
         "bdpt: number N of vertices stored per light path; paths of more than N + 1 scattering "
         "events are sampled by the strategies of truncated_bdpt only"},
        {"integrator.beta", NumberSetting{&S::beta, 0.0f, 1e3f},
         "exponent of the power heuristic of multiple importance sampling"},
        {"integrator.termination", choice(&S::termination, terminations),
         "how paths end; roulette: Russian roulette (unbiased); fixed: after max_depth scattering "
         "events (biased); adaptive: when the throughput falls below adaptive_threshold (biased); "
         "ray_casting and whitted use fixed instead of roulette"},
        {"integrator.max_depth", CountSetting{&S::max_depth, largest_count},
         "maximum number of scattering events of a path, 0: no limit (whitted: 8; ray_casting "
         "always uses 1)"},
        {"integrator.max_continuation", NumberSetting{&S::max_continuation, 0.0f, 1.0f},
         "largest probability with which Russian roulette continues a path"},
        {"integrator.roulette_start", NumberSetting{&S::roulette_start, 0.0f, 1e3f, true},
         "at mirrors and smooth glass, throughput below which Russian roulette may end a path; 1: "
         "always (thesis)"},
        {"integrator.roulette_event", CountSetting{&S::roulette_event, largest_count},
         "first scattering event at which Russian roulette may end a path; the thesis has 1"},
        {"integrator.adaptive_threshold", NumberSetting{&S::adaptive_threshold, 0.0f, 1e3f},
         "throughput below which adaptive termination ends a path"},
        {"integrator.light_selection", choice(&S::light_selection, light_selections),
         "selection of a light for next-event estimation or the start of a light path; uniform: "
         "equal probabilities; power: in proportion to the light's power; mixed: mean of both; "
         "independent: next-event estimation samples every light at every vertex, as ray_casting "
         "and whitted always do"},
        {"integrator.sphere_sampling", choice(&S::sphere_sampling, sphere_samplings),
         "how points on sphere lights are sampled; cone: uniformly in the solid angle that the "
         "sphere subtends; area: uniformly on its surface (as in the thesis)"},
        {"integrator.convergence.error", NumberSetting{&S::convergence_error, 0.0f, 1e3f, true},
         "path_tracing, truncated_bdpt: a pixel gets no more camera paths when its mean over half "
         "of its samples differs from its mean over all by less than this relative error (biased; "
         "thesis 3.3.7 uses 0.01 to 0.03), 0: no pixel stops"},
        {"integrator.convergence.interval",
         CountSetting{&S::convergence_interval, FILM_ADDITIONS_AT_ONCE},
         "samples between two convergence checks, an even number"},
        {"integrator.convergence.start",
         CountSetting{&S::convergence_start, FILM_ADDITIONS_AT_ONCE},
         "samples before the first convergence check, an even number"},
    };
    return table;
}

const std::vector<Setting> &device_setting_table() {
    static const std::vector<Setting> table = {
        {"device.group_size", CountSetting{&S::group_size, 4096},
         "work-items per work-group, 0: chosen for the device"},
        {"device.stream_capacity", CountSetting{&S::stream_capacity, 1u << 26},
         "paths in flight, 0: chosen for the device; at most 131072 if light paths are traced"},
        {"device.stream_chunk", CountSetting{&S::stream_chunk, 256},
         "queue entries that a work-item processes, 0: chosen for the device"},
        {"device.path_layout", choice(&S::path_layout, path_layouts),
         "layout of path states in memory; interleaved: array of structures; arrays: structure of "
         "arrays; auto: chosen for the device"},
        {"device.bvh_layout", choice(&S::bvh_layout, bvh_layouts),
         "layout of BVH nodes; bvh2: two children, traversed with a stack; bvh2_stackless: two "
         "children, traversed without a stack; wide8: eight children; auto: chosen for the device"},
        {"device.bvh_builder", choice(&S::bvh_builder, bvh_methods),
         "how the BVH is built; binned_sah: top-down by the binned surface area heuristic; hploc: "
         "bottom-up by clustering (H-PLOC), faster to build"},
        {"device.bvh_bins", choice(&S::bvh_bins, bvh_bins_choices),
         "binned_sah: number of bins per axis"},
        {"device.bvh_axes", choice(&S::bvh_axes, bvh_axes_choices),
         "binned_sah: axes that are binned; widest: only the axis along which a node's centroids "
         "extend furthest"},
        {"device.bvh_update", choice(&S::bvh_update, bvh_updates),
         "how the BVH follows an animated scene; rebuild: it is built at the time of --at; refit: "
         "it is built at time 0 and its bounds are refitted to the time of --at"},
        {"device.pipeline", choice(&S::pipeline, pipelines),
         "wavefront: one kernel per stage; megakernel: one kernel that traces complete paths "
         "(path_tracing only)"},
        {"device.count_rays", choice(&S::count_rays, ray_counts_choices),
         "ray counts in the file of --stats; in_all: totals; by_depth: also for each pass by the "
         "number of scattering events before the ray"},
        {"device.features", choice(&S::features, compiled_features),
         "code that is compiled into the kernels; scene: the features that scene and settings use; "
         "all: every feature"},
    };
    return table;
}

std::string value_text(const RenderSettings &settings, const Setting &setting) {
    if (const auto *named = std::get_if<ChoiceSetting>(&setting.kind)) {
        return named->print(settings);
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

void set_value(RenderSettings &settings, const Setting &setting, const std::string &value) {
    if (const auto *named = std::get_if<ChoiceSetting>(&setting.kind)) {
        if (!named->choose(settings, value)) {
            throw input_error(fmt::format("{}={}: unknown value; the values of {} are: {}",
                                          setting.name, value, setting.name,
                                          fmt::join(named->names, ", ")));
        }
    } else if (const auto *count = std::get_if<CountSetting>(&setting.kind)) {
        const auto special = count->names.find(value);
        settings.*count->field =
            special != count->names.end()
                ? special->second
                : parse_number<uint32_t>(setting, value, 0, count->largest, false);
    } else {
        const auto &number = std::get<NumberSetting>(setting.kind);
        settings.*number.field =
            parse_number<float>(setting, value, number.above, number.below, true, number.or_zero);
    }
}

}  // namespace rtrays
