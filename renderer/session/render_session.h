// SPDX-License-Identifier: MIT
// A render of one scene on one device.
#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <nlohmann/json_fwd.hpp>
#include <vector>

#include "renderer/base/image.h"
#include "renderer/film/film.h"
#include "renderer/session/settings.h"
#include "renderer/shared/light_path_trials.h"

namespace rtrays {

class Scene;
class DeviceContext;
class DeviceScene;
struct DeviceSceneSettings;
struct DeviceInfo;

/// Times and counts of one session. Whatever empties or replaces the film resets them, except those
/// of compilation, BVH and pilot.
struct RenderStats {
    /// Building or loading programs, and the first enqueue of every kernel.
    double compile_seconds = 0;
    /// Device time of the BVH build or of its last update.
    double bvh_seconds = 0;
    /// Device time of all stages of `render` so far, and of the pilot, if there was one.
    double device_seconds = 0;
    /// Wall time of `render` so far and of the pilot, if there was one, without compilation and BVH
    /// build.
    double wall_seconds = 0;
    /// Number of pixel samples: one per pixel and sample of the image, without those of pixels that
    /// convergence control has stopped.
    uint64_t samples = 0;
    /// Closest-hit and shadow rays of `render` so far, and of the pilot, if there was one.
    uint64_t rays = 0;
};

/// What the paths of one pass of a pilot found.
struct TrialPaths {
    std::vector<PathTrials> paths;
    std::vector<TrainingHit> hits;             ///< if the settings have `stores_training_hits`
    double nearest_rays = 0, shadow_rays = 0;  ///< of all of them
};

/// A render of one scene on one device. It compiles the scene and the kernels, accumulates ranges
/// of samples in a film and develops the film. The image has the same bits for every group size and
/// stream capacity, and for every split of the samples into ranges, sessions or merged films.
class RenderSession {
  public:
    /// Compiles the scene and the kernels. `scene` is not kept; `device` must outlive the session.
    /// Throws `Error` when settings contradict each other, when the device has too little memory or
    /// when the scene leaves the algorithm without a pass.
    RenderSession(const Scene &scene, const RenderSettings &settings, DeviceContext &device);

    /// Renders `shared`, a scene that other sessions may share, after updating it to `scene`.
    /// Throws `Error` (bad input) unless its settings equal `device_scene_settings` of these
    /// settings.
    RenderSession(std::shared_ptr<DeviceScene> shared, const Scene &scene,
                  const RenderSettings &settings);
    ~RenderSession();
    RenderSession(RenderSession &&) noexcept;

    /// Adds the samples [begin, end) of every pixel to the film. Returns early, at a batch
    /// boundary, once `interrupted()` (base/progress.h) is true. The return value is the end of the
    /// rendered range. `on_batch`, if given, is called with that end after each batch. With
    /// convergence control, `begin` must be the end of the film's samples; otherwise throws `Error`
    /// (bad input). Throws `Error` (bad input) too if a shared scene has changed since the
    /// session's last update, or if the film has some of the samples already; batches before these
    /// are kept.
    uint64_t render(uint64_t begin, uint64_t end,
                    const std::function<void(uint64_t)> &on_batch = {});

    /// Returns whether no path is left to trace: convergence control has stopped all pixels, and
    /// the session traces no light paths.
    bool is_complete() const;

    /// Empties the film, resets the stats of rendering, and sets another seed. Kernels, buffers and
    /// BVH are kept.
    void restart(uint32_t seed);

    /// Restarts with another seed and another maximum depth. Throws `Error` (bad input) if the old
    /// or the new depth is unlimited (0), because kernels are compiled for one of the two cases.
    /// Throws it too for whitted, whose memory depends on the depth, and for ray_casting, whose
    /// depth is fixed.
    void restart(uint32_t seed, uint32_t max_depth);

    /// Empties the film, whose size is kept, and continues with the current state of `scene`. Only
    /// what has changed is compiled, copied and built again (compile/device_scene.h). If triangles
    /// have moved, the BVH is rebuilt or refitted (device.bvh_update). Kernels are kept unless the
    /// scene requires other features or has another number of lights. After a change of the scene,
    /// every session that shares it must be updated before it renders. Throws `Error` (bad input)
    /// for a scene that the device cannot represent; the session must then be updated successfully
    /// before it renders.
    void update(const Scene &scene);

    /// Empties the film and gives it another size in pixels. Kernels, BVH and scene are kept. If a
    /// pilot has chosen the number of light paths, their number per pixel is kept. Throws `Error`
    /// (bad input) below 1 and above 2^30 pixels, and (run failed) if the device has too little
    /// memory; the size then stays.
    void resize(int width, int height);

    /// Traces the first `count` paths of one pass of a pilot and returns what each found. The
    /// settings must have `light_path_trials`; such a session has no film. There are at most
    /// `TRIAL_SAMPLES` paths for each of `pilot_pixels`.
    TrialPaths trace_trials(PassKind pass, size_t count);

    /// Returns the film so far.
    FilmState film() const;

    /// Returns the settings, with the choices that algorithm, scene and pilot made.
    const RenderSettings &settings() const;

    /// Replaces the film by a saved one. Throws `Error` (bad input) that names the first
    /// difference when it belongs to another scene, other settings, another seed or size.
    void restore(const FilmState &film);

    /// Returns the developed film with its metadata. Throws `Error` (run failed) when samples were
    /// not finite or out of the film's range.
    Image develop() const { return develop(film()); }
    /// Develops a film of this scene and these settings, for instance of several sessions.
    Image develop(const FilmState &film) const;

    /// Returns the times and counts so far.
    RenderStats stats() const;

    /// Returns the document that `--stats` writes: device, features, programs, stages with seconds
    /// and launches, rays, buffers, bytes per path.
    nlohmann::json report() const;

  private:
    struct State;
    std::unique_ptr<State> state_;
};

/// Returns the settings of a scene that sessions with `settings` share on a device.
DeviceSceneSettings device_scene_settings(const RenderSettings &settings, const DeviceInfo &info);

/// Sets the attributes of an image developed from `film`: standard names, and `rtrays:` names for
/// its provenance.
void describe_image(Image &image, const FilmState &film);

}  // namespace rtrays
