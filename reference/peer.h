// SPDX-License-Identifier: MIT
// Reference renders by other programs: Mitsuba 3 and Blender's Cycles, driven by
// scripts/rtrays/peers/*_driver.py.
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

/// Renders with another program in batches, each an image with its own seed. The programs report no
/// variance, so the scatter of the batches gives the variance of the mean. A step is a batch; the
/// film counts steps.
class PeerRenderer {
  public:
    /// Exports the scene to `folder`, which is created here and deleted by the destructor. The film
    /// size of the scene must be that of the settings. `engine` is "mitsuba" or "cycles". Throws
    /// `Error` (skipped, exit code 77) if the program is not installed, and `Error` (bad input) for
    /// features that it cannot express.
    PeerRenderer(const Scene &scene, const ReferenceSettings &settings, const std::string &engine,
                 std::filesystem::path folder);
    ~PeerRenderer();

    /// Returns name and version, as in "Mitsuba 3.9.1 llvm_ad_rgb" or "Cycles of Blender 3.4.1,
    /// Sobol".
    const std::string &engine() const;

    /// Returns the samples per pixel of one step.
    uint64_t samples_per_step() const;

    /// Returns the number of steps for at least `samples` samples per pixel. There are at least two
    /// steps, so that their variance is defined.
    uint64_t steps_for(uint64_t samples) const;

    /// Sets the step at which the program ends. Call it before the first `render`, because the
    /// program is started only once.
    void plan(uint64_t last_step) { last_step_ = last_step; }

    /// Adds the steps [begin, end) to the film. `begin` must be the end of the steps that the film
    /// holds. Stops between two steps once `interrupted()`. Returns the end of the rendered steps.
    /// Throws `Error` (run failed) if the program fails or a pixel is not finite.
    uint64_t render(uint64_t begin, uint64_t end);

    uint64_t batch_size() const;  ///< steps between two checks of the clock
    /// Returns the render time that the program reports, plus that of a restored film.
    double seconds() const;
    uint64_t samples() const;  ///< steps in the film
    const Film &film() const;
    void restore(Film film, double seconds);

    /// Returns an image with the channels R, G, B, variance.R, variance.G, variance.B (variances of
    /// the mean) and samples, and the attributes samplesPerPixel and renderTimeSeconds.
    Image develop() const;

  private:
    struct State;
    std::unique_ptr<State> state_;
    uint64_t last_step_ = 0;
};

}  // namespace rtrays::reference
