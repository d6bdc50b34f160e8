// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <map>
#include <memory>
#include <nlohmann/json_fwd.hpp>
#include <string>

#include "renderer/base/image.h"

namespace rtrays {

class Scene;
class DeviceContext;

/// Everything a render depends on besides the scene and the device. Field names and enum names are those
/// of `--set integrator.NAME=VALUE` and `--set device.NAME=VALUE`.
struct RenderSettings {
    std::string algorithm = "path_tracing";
    int width = 0;   ///< 0: the scene's film size
    int height = 0;
    uint32_t seed = 1;
    // integrator.*
    std::string strategies = "mis";         ///< implicit | explicit | mis
    float beta = 2.0f;                      ///< exponent of the power heuristic
    std::string termination = "roulette";   ///< roulette | fixed | adaptive
    int max_depth = 0;                      ///< scattering events, 0: no limit
    std::string light_selection = "mixed";  ///< uniform | power | mixed
    // device.*
    uint32_t group_size = 0;                ///< 0: the device's default
    uint32_t stream_capacity = 0;           ///< 0: the device's default
    std::string features = "scene";         ///< scene | all
};

/// Seconds and counts of one session, from profiling events and counters.
struct RenderStats {
    double compile_seconds = 0;  ///< program build and first enqueue
    double bvh_seconds = 0;      ///< device time of the BVH build
    double device_seconds = 0;   ///< device time of all stages of `render` so far
    double wall_seconds = 0;     ///< wall time of `render` so far, compile and BVH build apart
    uint64_t samples = 0;        ///< camera paths
};

/// One scene on one device: compiles the scene and the kernels it needs, accumulates sample ranges in a
/// film and develops it. `render(0, n)` gives the same bits however the range is split.
class RenderSession {
  public:
    RenderSession(const Scene &scene, const RenderSettings &settings, DeviceContext &device);
    ~RenderSession();

    /// Adds the samples [begin, end) of every pixel to the film. Returns early, at a batch boundary, once
    /// `interrupted()`; the return value is the end of what was rendered.
    uint64_t render(uint64_t begin, uint64_t end);

    /// Empties the film and sets another seed; kernels, buffers and BVH are kept.
    void restart(uint32_t seed);

    /// R, G, B, variance.R, .G, .B (of the mean), samples. Throws `Error` (run failed) when non-finite or
    /// out-of-range samples were met, naming their number.
    Image develop() const;

    RenderStats stats() const;

    /// The document of `--stats`: feature mask, kernels, stage times, launches, bytes, bytes per path.
    nlohmann::json report() const;

  private:
    struct State;
    std::unique_ptr<State> state_;
};

}  // namespace rtrays
