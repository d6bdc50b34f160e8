// SPDX-License-Identifier: MIT
#include "renderer/film/convergence_control.h"

#include "renderer/shared/film_layout.h"
#include "renderer/shared/live_pixels.h"

namespace rtrays {

ConvergenceControl::ConvergenceControl(DeviceContext &device, const ConvergenceRule &rule,
                                       uint32_t pixels, FeatureMask camera, uint32_t group_size,
                                       const SourceOverlays &overlays)
    : rule_(rule),
      pixels_(pixels),
      half_film_(device, "half_film", size_t{pixels} * HALF_FILM_PIXEL_WORDS),
      stopped_at_(device, "stopped_at", pixels),
      live_pixels_(device, "live_pixels", pixels),
      live_blocks_(device, "live_blocks", LIVE_BLOCKS(pixels)),
      live_total_(device, "live_total", 1),
      program_(device, {"kernels/stop_converged.cl", "kernels/list_live_pixels.cl"},
               camera.defines(), overlays) {
    stop_converged_ = Kernel(program_, "stop_converged", group_size);
    count_live_pixels_ = Kernel(program_, "count_live_pixels", group_size);
    place_live_blocks_ = Kernel(program_, "place_live_blocks", 1);
    list_live_pixels_ = Kernel(program_, "list_live_pixels", group_size);
    reset();
}

StageArguments ConvergenceControl::arguments() const {
    return {{StageInput::half_film, {half_film_}},
            {StageInput::live_pixels, {live_pixels_, live_count_}}};
}

void ConvergenceControl::reset() {
    half_film_.fill(0);
    stopped_at_.fill(0);
    list_live_pixels();
}

void ConvergenceControl::check(const Buffer<int64_t> &film, uint64_t samples) {
    stop_converged_.bind(
        {film, half_film_, live_pixels_, live_count_, stopped_at_, rule_.error, samples});
    stop_converged_.enqueue(live_count_);
    list_live_pixels();
}

void ConvergenceControl::list_live_pixels() {
    count_live_pixels_.bind({stopped_at_, pixels_, live_blocks_});
    count_live_pixels_.enqueue(LIVE_BLOCKS(pixels_));
    place_live_blocks_.bind({pixels_, live_blocks_, live_total_});
    place_live_blocks_.enqueue(1);
    list_live_pixels_.bind({stopped_at_, pixels_, live_blocks_, live_pixels_});
    list_live_pixels_.enqueue(LIVE_BLOCKS(pixels_));
    live_count_ = live_total_.read().front();
}

ConvergenceState ConvergenceControl::state() const {
    return {rule_, stopped_at_.read(), half_film_.read()};
}

void ConvergenceControl::restore(const ConvergenceState &state) {
    stopped_at_.write(state.stopped_at);
    half_film_.write(state.half_words);
    list_live_pixels();
}

}  // namespace rtrays
