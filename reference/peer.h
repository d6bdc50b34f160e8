// SPDX-License-Identifier: MIT
// References by other renderers: Mitsuba 3 and Blender's Cycles, driven by scripts/*_driver.py.
#pragma once

#include <cstdint>
#include <filesystem>
#include <memory>
#include <string>

#include "reference/film.h"
#include "reference/settings.h"
#include "renderer/base/image.h"
#include "renderer/scene/scene.h"

namespace rtrays::reference {

/// Renders by another program in batches, each an image of its own seed. They state no variance:
/// that of the mean is the batches' scatter. A step is a batch; the film counts steps.
class PeerRenderer {
  public:
    /// Exports the scene, whose film size is that of the settings, to `folder`, which is made, and
    /// deleted at the end. `engine` is "mitsuba" or "cycles". Throws `Error`: skipped (exit code
    /// 77) when the program is not installed, bad input for what it cannot express.
    PeerRenderer(const Scene &scene, const ReferenceSettings &settings, const std::string &engine,
                 std::filesystem::path folder);
    ~PeerRenderer();

    /// "Mitsuba 3.9.1 llvm_ad_rgb", "Cycles of Blender 3.4.1, Sobol".
    const std::string &engine() const;

    /// Samples per pixel of a step.
    uint64_t samples_per_step() const;

    /// Steps that make at least so many samples per pixel; two or more, so that they scatter.
    uint64_t steps_for(uint64_t samples) const;

    /// Where the program is to end, before the first `render`: it is started once.
    void plan(uint64_t last_step) { last_step_ = last_step; }

    /// Adds the steps [begin, end), `begin` being the end of what the film holds already; stops
    /// between two of them once `interrupted()` and returns the end of what was rendered. Throws
    /// `Error` (run failed) when the program fails or a pixel is not finite.
    uint64_t render(uint64_t begin, uint64_t end);

    uint64_t batch_size() const;  ///< steps between two looks at the clock
    double seconds()
        const;  ///< what the program says that its renders took, plus that of a restored film
    uint64_t samples() const;  ///< steps in the film
    const Film &film() const;
    void restore(Film film, double seconds);

    /// R, G, B, variance.R, .G, .B (of the mean), samples; attributes samplesPerPixel,
    /// renderTimeSeconds.
    Image develop() const;

  private:
    struct State;
    std::unique_ptr<State> state_;
    uint64_t last_step_ = 0;
};

}  // namespace rtrays::reference
