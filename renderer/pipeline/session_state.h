// SPDX-License-Identifier: MIT
// What a RenderSession holds: the passes of its algorithm, compiled, and all buffers they share.
#pragma once

#include <algorithm>
#include <chrono>
#include <map>
#include <memory>
#include <string>
#include <vector>

#include "renderer/bvh/builder.h"
#include "renderer/bvh/refit.h"
#include "renderer/device/buffer.h"
#include "renderer/device/profiler.h"
#include "renderer/integrators/algorithm.h"
#include "renderer/pipeline/compile_scene.h"
#include "renderer/pipeline/convergence_control.h"
#include "renderer/pipeline/film.h"
#include "renderer/pipeline/pilot.h"
#include "renderer/pipeline/render_session.h"
#include "renderer/pipeline/scene_buffers.h"
#include "renderer/pipeline/stages.h"
#include "renderer/shared/branch.h"
#include "renderer/shared/film_layout.h"
#include "renderer/shared/light_vertex.h"
#include "renderer/shared/ray_counts.h"
#include "renderer/shared/stream_counters.h"

namespace rtrays {

using Clock = std::chrono::steady_clock;

inline double seconds_since(Clock::time_point start) {
    return std::chrono::duration<double>(Clock::now() - start).count();
}

/// A pass of the algorithm, compiled, with the film it adds to.
struct CompiledPass {
    CompiledPass(const Pass &pass, DeviceContext &device, const StreamLayout &layout,
                 const RenderSettings &settings)
        : name(pass.name),
          features(pass.features),
          round(pass.round),
          adds_hits(pass.adds_hits),
          streams(pass.streams),
          last_paths(pass.last_paths),
          splats(static_cast<uint64_t>(std::count_if(
              round.begin(), round.end(),
              [](const RoundStage &stage) { return stage.name == "splat_unblocked"; }))),
          stages(device, stage_names(pass), pass.features, layout, settings.source_overlays) {}

    static std::vector<std::string> stage_names(const Pass &pass) {
        std::vector<std::string> names = {"carry_film"};
        if (pass.streams) {
            names.emplace_back("reset_streams");
        }
        for (const RoundStage &stage : pass.round) {
            names.push_back(stage.name);
        }
        return names;
    }

    /// Whether the stages of the last few paths of a batch are compiled.
    bool has_last_stages() const {
        return !last_paths.empty() && stages.has(last_paths.front().name);
    }

    /// The integrator's numbers for this pass.
    IntegratorSettings numbers(IntegratorSettings of_all) const {
        of_all.strategies |= adds_hits ? 0u : STRATEGY_HITS_ELSEWHERE;
        return of_all;
    }

    /// Empties what rendering added to.
    void clear() {
        film.fill(0);
        if (ray_counts.size() > 0) {
            ray_counts.fill(0);
        }
        additions = 0;
        profile.clear();
    }

    /// Rays of one kind (RAY_*) by depth, up to the last depth that has any.
    std::vector<int64_t> rays_by_depth(size_t kind) const {
        const std::vector<int64_t> all = ray_counts.read();
        const auto first = all.begin() + static_cast<std::ptrdiff_t>(kind * RAY_DEPTHS);
        std::vector<int64_t> rays(first, first + RAY_DEPTHS);
        while (!rays.empty() && rays.back() == 0) {
            rays.pop_back();
        }
        return rays;
    }

    std::string name;
    FeatureMask features;
    std::vector<RoundStage> round;
    bool adds_hits;
    bool streams;
    std::vector<RoundStage> last_paths;
    uint64_t splats;  ///< that a path in flight adds in a round, at most
    StageSet stages;
    Buffer<int64_t> film;
    Buffer<int64_t> ray_counts;
    uint32_t chosen = SELECT_LIGHT;                  ///< what StageInput::chosen is bound to
    uint64_t additions = 0;                          ///< to one pixel since the last carry, at most
    std::map<std::string, Profiler::Stage> profile;  ///< of the stages of `render`
};

struct RenderSession::State {
    State(const Scene &scene, const RenderSettings &requested, DeviceContext &device_context);

    uint64_t pixels() const {
        return static_cast<uint64_t>(settings.width) * static_cast<uint64_t>(settings.height);
    }

    // session_state.cpp

    /// Takes over what has moved; false where the scene needs other kernels.
    bool update(const Scene &scene);

    void build_bvh(const MeshArrays &meshes);

    /// By device.bvh_update.
    void update_bvh(const MeshArrays &meshes);
    void allocate();
    void bind();

    /// The first enqueue of a kernel compiles it for its group size: a batch without work does
    /// that.
    void warm_up();

    void reset_film();
    double device_seconds() const;

    /// Metadata of the film without its words.
    FilmState film_header() const;

    /// 4-byte words of the light vertices that are kept for every path in flight.
    uint32_t vertex_words_per_path() const {
        return features.has(Feature::vertex_joins)
                   ? numbers.light_vertices * light_vertex_words(features)
                   : 0;
    }

    /// Likewise of the vertices to which each path in flight may come back.
    uint32_t branch_words_per_path() const {
        return features.has(Feature::branches) ? numbers.max_depth * branch_words(features) : 0;
    }

    uint64_t film_words() const { return pixels() * FILM_PIXEL_WORDS(settings.variance); }
    uint64_t film_sums() const { return film_words() / FILM_WORDS; }

    /// Paths of a pass in one sample of the image.
    uint64_t paths_per_sample(const CompiledPass &pass) const {
        return pass.name == "light" ? numbers.light_paths : pixels();
    }
    /// Of these, those that are still traced.
    uint64_t live_paths_per_sample(const CompiledPass &pass) const {
        return pass.features.has(Feature::convergence) ? convergence->live_count()
                                                       : paths_per_sample(pass);
    }
    uint64_t live_paths_per_sample() const {
        uint64_t paths = 0;
        for (const CompiledPass &pass : passes) {
            paths += live_paths_per_sample(pass);
        }
        return paths;
    }

    // session_rounds.cpp

    /// How many of the samples from `begin` on are rendered next: a batch, up to the next check.
    uint64_t batch_size(uint64_t begin, uint64_t end) const;

    /// Where convergence control stops a pixel depends on all samples before. Throws `Error` (bad
    /// input).
    void require_next(uint64_t begin, uint64_t end) const;

    /// Renders `count` samples of the image from `first` on.
    void run_batch(uint64_t first, uint64_t count);

    /// Traces the paths from `begin` to `end` of the batch that starts at sample `first`.
    void run_pass(CompiledPass &pass, uint64_t first, uint32_t begin, uint32_t end);

    /// Compiles the stages of the last few paths of a batch, of which `in_flight` are left, and
    /// runs their first round.
    void add_last_stages(CompiledPass &pass, uint64_t in_flight);

    /// `paths`: what a stage that traces whole paths is to trace.
    void enqueue(CompiledPass &pass, const std::string &name, uint64_t paths = 0);
    void carry_film(CompiledPass &pass);

    /// Carries the film's sums if so many additions to one pixel would not fit any more.
    void make_room(CompiledPass &pass, uint64_t additions);

    /// The words of a pass' film, carried.
    std::vector<int64_t> read_film(CompiledPass &pass);
    void collect_profile(CompiledPass &pass);

    DeviceContext &device;
    RenderSettings settings;
    Pilot pilot;  ///< by which the number of light paths was chosen, if one was
    StreamLayout layout;
    IntegratorSettings numbers;
    CompiledScene compiled;
    FeatureMask features;  ///< of all passes
    std::vector<CompiledPass> passes;
    std::string scene_hash;
    std::string config;

    std::unique_ptr<BvhBuilder> bvh_builder;
    std::unique_ptr<BvhRefitter> bvh_refitter;  ///< since the hierarchy was last refitted
    Bvh bvh;
    std::map<std::string, Profiler::Stage> bvh_stages;
    SceneBuffers scene_buffers;
    Buffer<uint32_t> path_words;
    Buffer<uint32_t> vertex_words;
    Buffer<uint32_t> branch_vertices;
    Buffer<uint32_t> queues;
    Buffer<StreamCounters> counters;
    std::unique_ptr<ConvergenceControl>
        convergence;  ///< of the camera pass, where pixels are stopped

    double compile_seconds = 0;
    double bvh_wall_seconds = 0;
    double wall_seconds = 0;
    uint64_t samples = 0;
    FilmState ranges;  ///< ranges, seconds and errors of films restored or rendered; no words
};

}  // namespace rtrays
