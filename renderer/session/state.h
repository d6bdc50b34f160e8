// SPDX-License-Identifier: MIT
// The state of a RenderSession: the compiled passes of its algorithm and the buffers they share.
#pragma once

#include <map>
#include <memory>
#include <string>
#include <vector>

#include "renderer/base/clock.h"
#include "renderer/compile/device_scene.h"
#include "renderer/compile/stages.h"
#include "renderer/device/buffer.h"
#include "renderer/device/profiler.h"
#include "renderer/film/convergence_control.h"
#include "renderer/film/film.h"
#include "renderer/integrators/algorithm.h"
#include "renderer/session/pilot.h"
#include "renderer/session/render_session.h"
#include "renderer/shared/branch.h"
#include "renderer/shared/film_layout.h"
#include "renderer/shared/light_vertex.h"
#include "renderer/shared/ray_counts.h"
#include "renderer/shared/stream_counters.h"

namespace rtrays {

/// A compiled pass of the algorithm, with the film that it adds to.
struct CompiledPass : Pass {
    CompiledPass(const Pass &pass, DeviceContext &device, const StreamLayout &layout,
                 const RenderSettings &settings)
        : Pass(pass), stages(device, stages_of(pass), features, layout, settings.source_overlays) {}

    static std::vector<Stage> stages_of(const Pass &pass) {
        std::vector<Stage> list = {Stage::carry_film};
        if (pass.streams) {
            list.push_back(Stage::reset_streams);
        }
        for (const RoundStage &stage : pass.round) {
            list.push_back(stage.stage);
        }
        return list;
    }

    /// Returns whether the stages for the tail of a batch are compiled.
    bool has_tail_stages() const { return !tail.empty() && stages.has(tail.front().stage); }

    /// Returns the integrator's settings for this pass, given those of all passes.
    IntegratorSettings own_settings(IntegratorSettings common) const {
        common.strategies |= adds_hits ? 0u : STRATEGY_HITS_ELSEWHERE;
        return common;
    }

    /// Returns the number of queue entries per path slot.
    uint32_t queues() const {
        if (!streams) {
            return 0;
        }
        return features.has(Feature::from_light) ? LIGHT_QUEUES : CAMERA_QUEUES;
    }

    /// Empties film, ray counts and profile.
    void clear() {
        film.fill(0);
        is_carried = true;
        if (ray_counts.size() > 0) {
            ray_counts.fill(0);
        }
        profile.clear();
    }

    /// Returns the rays of one kind (RAY_*) by depth, up to the last depth that has any.
    std::vector<int64_t> rays_by_depth(size_t ray_kind) const {
        const std::vector<int64_t> all = ray_counts.read();
        const auto first = all.begin() + static_cast<std::ptrdiff_t>(ray_kind * RAY_DEPTHS);
        std::vector<int64_t> rays(first, first + RAY_DEPTHS);
        while (!rays.empty() && rays.back() == 0) {
            rays.pop_back();
        }
        return rays;
    }

    StageSet stages;
    Buffer<int64_t> film;    ///< the words of the film; of a pilot, its PathTrials
    bool is_carried = true;  ///< no samples were added since the carries were propagated
    Buffer<int64_t> ray_counts;
    /// Values to which the index of a light or vertex is bound.
    std::map<StageInput, uint32_t> indices = {{StageInput::light_index, SELECT_LIGHT},
                                              {StageInput::vertex_index, SELECT_LIGHT}};
    std::map<std::string, Profiler::Stage> profile;  ///< profile of the stages in `render`
};

struct RenderSession::State {
    State(std::shared_ptr<DeviceScene> shared, const Scene &graph, const RenderSettings &requested);

    uint64_t pixels() const {
        return static_cast<uint64_t>(settings.width) * static_cast<uint64_t>(settings.height);
    }

    // state.cpp

    /// Updates the scene, unless another session has, and begins its film. Returns false if the
    /// scene now requires other features or has another number of lights.
    bool update(const Scene &graph);

    /// Changes the size of the film, which becomes empty. If the device has too little memory, the
    /// size stays.
    void resize(int width, int height);

    /// Allocates an empty film. `sized` are the settings with its size and its light paths.
    void begin_film(const RenderSettings &sized);

    void allocate_streams();
    void allocate_film();
    void allocate_trials();
    void bind();

    /// Returns what the stages read of the scene, and the camera. Sets `emitters_in_view`.
    StageArguments scene_arguments();

    /// Returns the integrator's settings for a pass. Reads `emitters_in_view`.
    IntegratorSettings settings_of(const CompiledPass &pass) const;

    /// Returns the active camera of the scene, for the film or the window of `settings`.
    CameraRecord camera() const;

    /// Makes the flat guide if the settings ask for it, and copies the guide to the device. Throws
    /// `Error` (bad input) if the guide does not fit the scene.
    void set_guides();

    void set_config();

    /// Throws `Error` (bad input) if the scene has changed since the last update of this session.
    void require_current() const;

    /// Runs a batch without work: the first enqueue of a kernel compiles it for its group size.
    void warm_up();

    /// Empties the film.
    void reset_film();

    /// Resets ranges, times and counters, but not the film.
    void reset_counts();
    double device_seconds() const;

    /// Returns the film's metadata, without its words and the state of its pixels.
    FilmState film_header() const;

    /// Returns the number of 4-byte words of stored light vertices per path in flight.
    uint32_t vertex_words_per_path() const {
        return features.has(Feature::vertex_connections)
                   ? integrator.light_vertices * light_vertex_words(features)
                   : 0;
    }

    /// Returns the number of 4-byte words, per path in flight, of the vertices to which the path
    /// may return to follow further branches.
    uint32_t branch_words_per_path() const {
        return features.has(Feature::branches) ? integrator.max_depth * branch_words(features) : 0;
    }

    uint64_t film_words() const {
        return pixels() * FILM_PIXEL_WORDS(settings.variance, has_sequence_sums(settings));
    }
    uint64_t film_sums() const { return film_words() / FILM_WORDS; }

    /// Returns the number of paths of a pass in one sample of the image.
    uint64_t paths_per_sample(const CompiledPass &pass) const {
        return pass.kind == PassKind::light ? integrator.light_paths : pixels();
    }
    /// Returns the number of paths of a pass in one sample of the image that convergence control
    /// has not stopped.
    uint64_t live_paths_per_sample(const CompiledPass &pass) const {
        return pass.features.has(Feature::convergence) ? convergence->live_count()
                                                       : paths_per_sample(pass);
    }
    /// Returns the number of live paths of all passes.
    uint64_t live_paths_per_sample() const {
        uint64_t paths = 0;
        for (const CompiledPass &pass : passes) {
            paths += live_paths_per_sample(pass);
        }
        return paths;
    }

    // rounds.cpp

    /// Returns the number of samples from `begin` on that are rendered next: one batch, but not
    /// beyond the next convergence check.
    uint64_t batch_size(uint64_t begin, uint64_t end) const;

    /// Throws `Error` (bad input) when `begin` is not the next sample, if convergence control is
    /// on: all earlier samples decide where it stops a pixel.
    void require_next(uint64_t begin, uint64_t end) const;

    /// Renders `count` samples of the image from sample `first` on; with `count` 0, only compiles
    /// all kernels.
    void run_batch(uint64_t first, uint64_t count);

    /// Traces the paths with indices [begin, end) of the batch that starts at sample `first`.
    void run_pass(CompiledPass &pass, uint64_t first, uint32_t begin, uint32_t end);

    /// Compiles the stages for the last few paths of a batch, of which `in_flight` are left, and
    /// runs their first round.
    void add_tail_stages(CompiledPass &pass);

    /// Enqueues a stage. `paths` is the number of paths that a stage of complete paths
    /// (StageItems::paths) traces.
    void enqueue(CompiledPass &pass, Stage stage, uint64_t paths = 0);

    /// Propagates the carries of the film's sums, unless that has been done.
    void carry_film(CompiledPass &pass);

    /// Returns the words of a pass's film after carry propagation.
    std::vector<int64_t> read_film(CompiledPass &pass);

    /// Waits for the device and adds its profile to that of the pass.
    void collect_profile(CompiledPass &pass);

    // report.cpp

    /// Adds the programs, stages and memory of the passes to the document of `--stats`.
    void report_passes(nlohmann::json &report) const;

    /// Adds all buffers to the document.
    void report_buffers(nlohmann::json &report) const;

    std::shared_ptr<DeviceScene> scene;
    uint64_t scene_version;  ///< version of the scene to which the stages are bound
    FeatureMask scene_features;
    uint32_t light_count;
    DeviceContext &device;
    RenderSettings settings;
    Pilot pilot;  ///< empty if the settings needed none
    StreamLayout layout;
    IntegratorSettings integrator;
    FeatureMask features;  ///< union over all passes
    std::vector<CompiledPass> passes;
    std::map<std::string, std::string> config;  ///< `FilmState::config`
    bool emitters_in_view = true;               ///< `emitters_in_view` of the camera and the scene

    Buffer<uint32_t> emission_guide, scatter_guide;
    Buffer<uint32_t> path_words;
    Buffer<uint32_t> vertex_words;
    Buffer<uint32_t> branch_vertices;
    Buffer<uint32_t> queues;
    Buffer<StreamCounters> counters;
    /// Pixels in which the camera paths of a pilot start.
    Buffer<uint32_t> trial_pixels;
    /// Convergence control of the camera pass, if it is on.
    std::unique_ptr<ConvergenceControl> convergence;

    double compile_seconds = 0;
    double wall_seconds = 0;
    uint64_t samples = 0;
    /// Ranges, seconds and error counts of restored or rendered films, without words.
    FilmState ranges;
};

}  // namespace rtrays
