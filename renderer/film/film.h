// SPDX-License-Identifier: MIT
// The film's state on the host: development to an image, merging, and files.
#pragma once

#include <cstdint>
#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "renderer/base/image.h"
#include "renderer/base/sample_ranges.h"
#include "renderer/compile/pass_kind.h"
#include "renderer/film/convergence.h"

namespace rtrays {

/// Exact sums of a render (shared/film_layout.h), and their origin. They can be saved, resumed and
/// merged without changing a bit of the result.
struct FilmState {
    int width = 0;
    int height = 0;
    bool variance = true;  ///< whether the variances of the means can be developed
    /// Whether they follow from sums of each Sobol sequence, instead of sums of squares.
    bool sequences = false;
    /// Rendered passes, whose images add up.
    std::vector<PassKind> passes = {PassKind::camera};
    /// Light paths per sample of the image, 0 without a light pass.
    uint64_t light_paths = 0;
    uint32_t seed = 0;
    /// What else decides the image, by name: the hash of the scene, and the settings with their
    /// values.
    std::map<std::string, std::string> config;
    SampleRanges ranges;  ///< samples in the film
    /// Device time and wall time of the stages and of the pilot, if there was one.
    double device_seconds = 0;
    double wall_seconds = 0;
    /// Samples that were not finite; they are not in the sums.
    uint64_t non_finite = 0;
    /// Samples of magnitude 2^40 or more; they are not in the sums.
    uint64_t out_of_range = 0;
    /// Words of the sums after carry propagation: pass by pass, FILM_PIXEL_WORDS per pixel.
    std::vector<int64_t> words;
    /// State of convergence control in the camera pass, if it is on.
    std::optional<ConvergenceState> convergence;

    /// Returns the number of samples per pixel. A pixel that convergence control has stopped has
    /// fewer from the camera pass.
    uint64_t samples() const;

    /// Returns the hash of `config`.
    std::string config_hash() const;

    /// Adds a range. Throws `Error` (bad input) when it overlaps a range of the film.
    void add_range(SampleRange range);
};

/// Throws `Error` (run failed) with the numbers of samples that were not finite or out of the
/// film's range, if there are any.
void require_valid(const FilmState &film);

/// Returns an image with these channels: R, G, B; variance.R, .G, .B (estimates of the variance of
/// the mean); samples (camera paths of each pixel); and the images of the passes (camera.R, ...,
/// light.R, ...) if there are several. Means are computed in double from the exact integers, so
/// that their relative error is that of the rounding to float.
///
/// The variances are unbiased estimates for both samplers, and 0 from a single sample. For
/// independent samples they follow from the squares. For Sobol points they follow from the means of
/// the sequences, which are independent and few: a variance has SOBOL_SEQUENCES - 1 degrees of
/// freedom in each pass, so it is precise only as an average over pixels.
///
/// A light path adds to many pixels. The variances of a light pass are those of single pixels;
/// neighbouring pixels are correlated.
Image develop_film(const FilmState &film);

/// A property of films with its values, as text, in two of them.
struct FilmDifference {
    std::string name, first, second;
};

/// Returns the first difference of two films because of which samples of one cannot be added to the
/// other: in size, sums, seed or `config`, or with `compare_passes` in the passes.
std::optional<FilmDifference> find_difference(const FilmState &first, const FilmState &second,
                                              bool compare_passes = true);

/// Adds `other` to `film`: other samples of the same passes, or another pass of the same samples.
/// Throws `Error` (bad input) that names the first difference and both values when the films are
/// not of one render, or when samples are already in the film. With convergence control, all
/// samples from the first on decide where a pixel stops, so that only passes can be merged.
void merge_film(FilmState &film, const FilmState &other);

/// Propagates the carries of the words, after words of several films were added. The sum of up to
/// 2^39 films fits, because a word is below 2^24, except the top one.
void carry_words(FilmState &film);

/// Writes the film to a file: a checksum, a line that names the format, a line of JSON and the
/// words. The write is atomic. Throws `Error` (run failed) that names the path.
void save_film(const FilmState &film, const std::filesystem::path &path);

/// Reads a film that `save_film` wrote. Throws `Error` (bad input) that names the path when the
/// file is missing, not a film, truncated or damaged.
FilmState load_film(const std::filesystem::path &path);

}  // namespace rtrays
