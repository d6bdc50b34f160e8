// SPDX-License-Identifier: MIT
// Emission guides: tables by which light paths select their light and their direction.
//
// The target is the root of the second moment, which has the least variance for a given number of
// paths (Rath et al. 2020, "Variance-aware path guiding"). Bins whose light other strategies find
// better have small moments, because MIS weights are part of a path's value.
#pragma once

#include <cstdint>
#include <vector>

#include "renderer/compile/compile_scene.h"
#include "renderer/shared/guide_layout.h"
#include "renderer/shared/light_path_trials.h"

namespace rtrays {

/// Most lights that a guide supports.
constexpr size_t most_guided_lights = 64;

/// An emission guide in the layout of shared/guide_layout.h. Every bin of a table has words.
struct EmissionGuide {
    std::vector<uint32_t> words;
};

/// Second moments of light paths, by light, in the order of CompiledScene::lights. An entry has
/// GUIDE_BINS moments, by row and column, for a light that takes a table; a single moment for any
/// other; or none if nothing is known. A moment is the mean of y^2 over paths that start there,
/// where y is the MIS-weighted contribution of a path to the image, times the probability with
/// which its light was selected, times g of its bin. It thus does not depend on the guide under
/// which the paths were traced. A bin without paths has the moment 0.
using EmissionMoments = std::vector<std::vector<double>>;

/// Returns whether a guide supports the number of lights.
bool supports_guide(const CompiledScene &scene);

/// Returns whether a light of `scene` takes a table: discs, spheres, point lights, and meshes whose
/// triangles all have the same normal.
bool takes_guide_table(const CompiledScene &scene, size_t light);

/// Returns whether training can improve a guide: the scene must have a light, at most as many as a
/// guide supports, and a single light must take a table.
bool is_trainable(const CompiledScene &scene);

/// Throws `Error` (bad input) that says why, unless a guide `is_trainable`.
void require_trainable(const CompiledScene &scene);

/// Returns the second moments of light paths under a guide, in a trial. Few paths say little about
/// a bin, so the mean of a prior counts as 8 more paths there: the mean over the bin and its eight
/// neighbours, where the light's mean counts as 8 paths. A light without paths has no moments.
/// Contributions that are not finite count as 0; renders report them.
EmissionMoments emission_moments(const CompiledScene &scene, const std::vector<PathTrials> &paths,
                                 size_t trial);

/// Returns the guide with the emission's usual selection of lights, and a table of equal bins for
/// every light that takes one. Throws `Error` (bad input) if there are too many lights.
EmissionGuide flat_guide(const CompiledScene &scene);

/// Returns the guide for given moments. In a light's table, a bin has 3/4 of its probability in
/// proportion to the root of its moment, and 1/4 uniformly. A light is selected with 3/4 of its
/// probability in proportion to the mean of these roots over its bins, and 1/4 as usual. Lights
/// without moments keep their usual probability, and so do all if all moments are 0. Throws `Error`
/// (bad input) if there are too many lights, if the number of moments is wrong, and if a moment is
/// negative or not finite.
EmissionGuide make_guide(const CompiledScene &scene, const EmissionMoments &moments);

/// Throws `Error` (bad input) unless the guide is one for the lights of `scene`: their number, and
/// tables for those that take one.
void require_guide_for(const CompiledScene &scene, const EmissionGuide &guide);

}  // namespace rtrays
