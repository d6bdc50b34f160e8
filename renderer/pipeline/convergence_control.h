// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <map>
#include <string>

#include "renderer/pipeline/convergence.h"
#include "renderer/pipeline/stages.h"

namespace rtrays {

/// Convergence control on the device: the half film, the pixels' stopping counts and the list of
/// those that are live. The host learns no more than how many these are.
class ConvergenceControl {
  public:
    /// `camera`: features of the camera pass, whose film `check` is given. All `pixels` are live.
    ConvergenceControl(DeviceContext &device, const ConvergenceRule &rule, uint32_t pixels,
                       FeatureMask camera, uint32_t group_size, const SourceOverlays &overlays);

    const ConvergenceRule &rule() const { return rule_; }
    uint32_t live_count() const { return live_count_; }
    const Buffer<uint32_t> &live_pixels() const {
        return live_pixels_;
    }  ///< ascending; the first `live_count` count
    /// The half film and the list, as the stages of the pass take them: to be bound anew after each
    /// call that changes them.
    StageArguments arguments() const;

    /// All pixels live again, no samples.
    void reset();

    /// Stops the pixels that have converged after `samples` samples. `film` is carried.
    void check(const Buffer<int64_t> &film, uint64_t samples);

    ConvergenceState state() const;
    void restore(const ConvergenceState &state);

    const std::map<std::string, Program> &programs() const { return programs_; }  ///< by file

    template <class Visitor>
    void visit_buffers(const Visitor &visit) const {
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
    std::map<std::string, Program> programs_;
    Kernel stop_converged_, count_live_pixels_, place_live_blocks_, list_live_pixels_;
    uint32_t live_count_ = 0;
};

}  // namespace rtrays
