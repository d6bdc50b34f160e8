// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <nlohmann/json_fwd.hpp>

#include "renderer/base/image.h"
#include "renderer/pipeline/film.h"
#include "renderer/pipeline/settings.h"

namespace rtrays {

class Scene;
class DeviceContext;

/// Seconds and counts of one session.
struct RenderStats {
    double compile_seconds =
        0;                   ///< programs built or loaded, and the first enqueue of every kernel
    double bvh_seconds = 0;  ///< device time of the BVH build, or its last update
    double device_seconds =
        0;  ///< device time of all stages of `render` so far, and of the pilot, if there was one
    double wall_seconds =
        0;  ///< wall time of `render` so far; compilation and BVH build come before it
    uint64_t samples = 0;  ///< camera paths; where pixels are stopped: that were traced
    uint64_t rays = 0;     ///< closest-hit and shadow rays of `render` so far
};

/// One scene on one device: compiles the scene and the kernels it needs, accumulates sample ranges
/// in a film and develops it. The image has the same bits whatever the group size, the stream
/// capacity, and however the samples are split into ranges, sessions or merged films.
class RenderSession {
  public:
    /// Throws `Error` when settings contradict each other or the device lacks memory.
    RenderSession(const Scene &scene, const RenderSettings &settings, DeviceContext &device);
    ~RenderSession();
    RenderSession(RenderSession &&) noexcept;

    /// Adds the samples [begin, end) of every pixel to the film. Returns early, at a batch
    /// boundary, once `interrupted()`; the return value is the end of what was rendered.
    /// `on_batch`, where given, is called with that end after each batch. Under convergence control
    /// `begin` is the end of what is there: throws `Error` (bad input) otherwise.
    uint64_t render(uint64_t begin, uint64_t end,
                    const std::function<void(uint64_t)> &on_batch = {});

    /// Whether no path is left to trace: convergence control has stopped all pixels of an image
    /// without light paths.
    bool is_complete() const;

    /// Empties the film and the stats of rendering, and sets another seed; kernels, buffers and BVH
    /// are kept.
    void restart(uint32_t seed);

    /// Likewise, with another limit of scattering events. Throws `Error` (bad input) unless there
    /// is one and is to be one, which kernels know, and of whitted, whose memory depends on it.
    void restart(uint32_t seed, uint32_t max_depth);

    /// Goes on with `scene` as it is now, on an empty film. Kernels are kept; the hierarchy is
    /// built anew or refitted (device.bvh_update). A scene that needs other kernels, or to be
    /// refitted has other numbers of triangles, begins anew.
    void update(const Scene &scene);

    /// The film so far; and its replacement by one that was saved. `restore` throws `Error` (bad
    /// input) when it belongs to another scene, other settings, seed or size.
    FilmState film() const;
    void restore(const FilmState &film);

    /// The developed film with its metadata. Throws `Error` (run failed) when samples were not
    /// finite or out of the film's range.
    Image develop() const;

    RenderStats stats() const;

    /// What `--stats` writes: device, feature mask, programs, stages with seconds and launches,
    /// rays, buffers, bytes per path.
    nlohmann::json report() const;

  private:
    struct State;
    std::unique_ptr<State> state_;
};

/// The attributes of an image developed from `film`: standard names, and `rtrays:` ones for its
/// origin.
void describe_image(Image &image, const FilmState &film);

}  // namespace rtrays
