// SPDX-License-Identifier: MIT
// Convergence control (thesis 3.3.7): every `interval` samples from `start` on, pixels that have
// converged (kernels/film/convergence.h) get no more camera paths. A pixel that stops by its own
// estimate is biased in general: it stops sooner where it has missed what is rare.
#pragma once

#include <cstdint>
#include <nlohmann/json_fwd.hpp>
#include <string>
#include <vector>

namespace rtrays {

struct ConvergenceRule {
    float error = 0;  ///< relative change from N to 2N samples below which a pixel stops, above 0
    uint32_t interval = 0;  ///< samples between two checks, even
    uint32_t start = 0;     ///< samples of the first check, even

    bool is_check(uint64_t samples) const {
        return samples >= start && (samples - start) % interval == 0;
    }

    /// The first check after that many samples.
    uint64_t next_check(uint64_t samples) const {
        return samples < start ? start : samples + interval - (samples - start) % interval;
    }

    /// "biased by convergence control: error 0.02, interval 50, start 200".
    std::string describe() const;
};

/// What convergence control knows of a film's camera pass, which began at sample 0.
struct ConvergenceState {
    ConvergenceRule rule;
    std::vector<uint64_t> stopped_at;  ///< by pixel: number of samples at which it stopped, 0: live
    std::vector<int64_t>
        half_words;  ///< sums over the samples of even number; per pixel HALF_FILM_PIXEL_WORDS

    /// Samples of a pixel in a film of `samples`.
    uint64_t samples_of(size_t pixel, uint64_t samples) const {
        return stopped_at[pixel] == 0 ? samples : stopped_at[pixel];
    }

    /// Camera paths spent in a film of `samples`.
    uint64_t camera_paths(uint64_t samples) const;

    /// Whether every pixel stopped at a check within `samples`.
    bool is_consistent(uint64_t samples) const;
};

/// {"error", "interval", "start", "camera_paths", "checks": [{"samples", "live": share of the
/// pixels that went on}, ...]}.
nlohmann::json convergence_report(const ConvergenceState &state, uint64_t samples);

}  // namespace rtrays
