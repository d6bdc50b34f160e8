// SPDX-License-Identifier: MIT
// Convergence control on the device.
#pragma once

#include <cstdint>
#include <string>

#include "renderer/compile/stages.h"
#include "renderer/film/convergence.h"

namespace rtrays {

/// Convergence control on the device: the half film, the sample counts at which pixels stopped, and
/// the list of live pixels. The host reads back only the number of live pixels.
class ConvergenceControl {
  public:
    /// Creates the state with all `pixels` live. `camera` is the feature mask of the camera pass,
    /// whose film is passed to `check`.
    ConvergenceControl(DeviceContext &device, const ConvergenceRule &rule, uint32_t pixels,
                       FeatureMask camera, uint32_t group_size, const SourceOverlays &overlays);

    const ConvergenceRule &rule() const { return rule_; }
    uint32_t live_count() const { return live_count_; }
    /// Returns the live pixels in ascending order; only the first `live_count()` entries are valid.
    const Buffer<uint32_t> &live_pixels() const { return live_pixels_; }

    /// Returns the half film and the list as arguments for the stages of the pass. They must be
    /// bound again after every call that changes them.
    StageArguments arguments() const;

    /// Makes all pixels live and removes all samples.
    void reset();

    /// Stops the pixels that have converged after `samples` samples. `film` must be normalised by
    /// carry propagation.
    void check(const Buffer<int64_t> &film, uint64_t samples);

    /// Reads the state back from the device.
    ConvergenceState state() const;

    /// Replaces the state.
    void restore(const ConvergenceState &state);

    const Program &program() const { return program_; }

    /// Calls visit(buffer) for every buffer.
    template <typename Visit>
    void visit_buffers(const Visit &visit) const {
        visit(half_film_);
        visit(stopped_at_);
        visit(live_pixels_);
        visit(live_blocks_);
        visit(live_total_);
    }

  private:
    void list_live_pixels();

    ConvergenceRule rule_;
    uint32_t pixels_;
    Buffer<int64_t> half_film_;
    Buffer<uint64_t> stopped_at_;
    Buffer<uint32_t> live_pixels_;
    Buffer<uint32_t> live_blocks_;
    Buffer<uint32_t> live_total_;
    Program program_;
    Kernel stop_converged_, count_live_pixels_, place_live_blocks_, list_live_pixels_;
    uint32_t live_count_ = 0;
};

}  // namespace rtrays
