// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "renderer/base/image.h"
#include "renderer/pipeline/convergence.h"

namespace rtrays {

/// A half-open range of sample indices.
struct SampleRange {
    uint64_t begin;
    uint64_t end;

    bool operator==(const SampleRange &other) const {
        return begin == other.begin && end == other.end;
    }
};

/// The exact sums of a render on the host (shared/film_layout.h): what is saved, resumed and merged
/// bit by bit.
struct FilmState {
    int width = 0;
    int height = 0;
    bool variance = true;  ///< squares are kept
    std::vector<std::string> passes = {
        "camera"};             ///< of the algorithm, whose images add up: "camera", "light"
    uint64_t light_paths = 0;  ///< of the light pass, per sample
    uint32_t seed = 0;
    std::string config;  ///< hash of scene and settings: films of different configs never mix
    std::vector<SampleRange>
        ranges;                 ///< of samples in the film, sorted, disjoint, adjacent ones joined
    double device_seconds = 0;  ///< of the stages
    double wall_seconds = 0;
    uint64_t non_finite = 0;     ///< samples that were not added
    uint64_t out_of_range = 0;   ///< likewise, of 2^40 or more in magnitude
    std::vector<int64_t> words;  ///< carried; pass by pass, per pixel FILM_PIXEL_WORDS
    std::optional<ConvergenceState> convergence;  ///< of the camera pass, where pixels are stopped

    /// Number of samples per pixel; where pixels are stopped: of those that were not, and of the
    /// light pass.
    uint64_t samples() const;

    /// Adds a range; throws `Error` (bad input) when it overlaps one that is there.
    void add_range(SampleRange range);
};

/// Throws `Error` (run failed) naming the number of samples that were not finite or out of the
/// film's range.
void require_valid(const FilmState &film);

/// R, G, B; variance.R, .G, .B (of the mean, from the squares); samples, camera paths of each
/// pixel; and camera.R, ..., light.R, ... where there are two passes. Sums are taken in double from
/// the exact integers: the mean's relative error is that of its rounding to float.
///
/// A light path adds to many pixels: its variances are those of the pixels by themselves, and
/// neighbours go together.
Image develop_film(const FilmState &film);

/// Adds `other` into `film`: other samples of the same passes, or another pass of the same samples.
/// Throws `Error` (bad input) when size, seed, config or layout differ, or what is there already
/// would be added again. Where convergence control stops a pixel depends on all its samples from
/// the first on: of such films only passes can be merged.
void merge_film(FilmState &film, const FilmState &other);

/// The film's file: a checksum, a line that names the format, a line of JSON and the words; written
/// whole or not at all. Throws `Error` (run failed) naming the path.
void save_film(const FilmState &film, const std::filesystem::path &path);

/// Throws `Error` (bad input) naming the path when it is missing, not a film, truncated or damaged.
FilmState load_film(const std::filesystem::path &path);

}  // namespace rtrays
