// SPDX-License-Identifier: MIT
// Convergence control: when pixels stop, and the state that decides it.
//
// Every `interval` samples from `start` on, pixels that have converged (kernels/film/convergence.h)
// get no more camera paths (thesis 3.3.7). A pixel that stops by its own estimate is biased in
// general: it stops sooner if it has missed rare contributions.
#pragma once

#include <cstdint>
#include <nlohmann/json_fwd.hpp>
#include <string>
#include <vector>

namespace rtrays {

/// Parameters of convergence control, and the checks that follow from them.
struct ConvergenceRule {
    /// Relative change from N to 2N samples below which a pixel stops, above 0.
    float error = 0;
    /// Samples between two checks, even.
    uint32_t interval = 0;
    /// Samples before the first check, even.
    uint32_t start = 0;

    /// Returns whether a check takes place after `samples` samples.
    bool is_check(uint64_t samples) const {
        return samples >= start && (samples - start) % interval == 0;
    }

    /// Returns the sample count of the first check after `samples`.
    uint64_t next_check(uint64_t samples) const {
        return samples < start ? start : samples + interval - (samples - start) % interval;
    }

    /// Returns a description: "biased by convergence control: error 0.02, interval 50, start 200".
    std::string describe() const;
};

/// State of convergence control for a film's camera pass, which began at sample 0.
struct ConvergenceState {
    ConvergenceRule rule;
    /// Number of samples at which each pixel stopped, 0 for a live pixel.
    std::vector<uint64_t> stopped_at;
    /// Sums over the samples with even index, HALF_FILM_PIXEL_WORDS per pixel.
    std::vector<int64_t> half_words;

    /// Returns the number of samples of a pixel in a film of `samples` samples.
    uint64_t samples_of(size_t pixel, uint64_t samples) const {
        return stopped_at[pixel] == 0 ? samples : stopped_at[pixel];
    }

    /// Returns the number of camera paths traced for a film of `samples` samples.
    uint64_t camera_paths(uint64_t samples) const;

    /// Returns whether every stopped pixel stopped at a check within `samples`.
    bool is_consistent(uint64_t samples) const;
};

/// Returns {"error", "interval", "start", "camera_paths", "checks": [{"samples", "live"}, ...]},
/// where "live" is the fraction of pixels that continue after the check.
nlohmann::json convergence_report(const ConvergenceState &state, uint64_t samples);

}  // namespace rtrays
