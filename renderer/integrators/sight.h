// SPDX-License-Identifier: MIT
// What an algorithm sees: classes of light paths, and how well its strategies sample each of them.
#pragma once

#include <array>

#include "renderer/base/named.h"

namespace rtrays {

/// Classes of light paths. Point, spot and directional lights are delta lights: no path hits them.
enum class PathClass {
    area_lights,
    infinite_lights,
    direct_light,
    infinite_light_outside,
    diffuse_reflection,
    mirrors,
    caustics,
    delta_light_caustics,
    mirrored_caustics,
    mirrored_delta_light_caustics,
    mirrored_light_of_delta_light_caustics,
    nearly_specular,
};

/// Descriptions of the classes. Paths are written from the camera E to the light L. S is an ideal
/// mirror or smooth glass, D is any other surface, G is a nearly specular one, and dots are any
/// number of further vertices S and D. A path belongs to the last class whose pattern and lights
/// are its own.
inline constexpr Named<PathClass> path_classes[] = {
    {PathClass::area_lights, "E L: area lights seen directly"},
    {PathClass::infinite_lights, "E L: lights at infinity seen directly (dome, environment)"},
    {PathClass::direct_light, "E D L: direct light"},
    {PathClass::infinite_light_outside,
     "E D L: light from infinity on a plane, outside the bounding sphere of all other surfaces"},
    {PathClass::diffuse_reflection, "E D ... D L: light from surface to surface"},
    {PathClass::mirrors, "E S ... L: what the camera sees in mirrors and smooth glass"},
    {PathClass::caustics, "E D ... S L: caustics of lights that a path can hit"},
    {PathClass::delta_light_caustics,
     "E D ... S L: caustics of point, spot and directional lights"},
    {PathClass::mirrored_caustics,
     "E S ... D ... S L: a mirror image of a caustic, of lights that a path can hit"},
    {PathClass::mirrored_delta_light_caustics,
     "E S ... D ... S L: a mirror image of a caustic of point, spot and directional lights"},
    {PathClass::mirrored_light_of_delta_light_caustics,
     "E S ... D D ... S L: a mirror image of what a caustic of such lights illuminates"},
    {PathClass::nearly_specular, "E G ... L: what the camera sees in nearly specular surfaces"}};

/// Whether an algorithm samples a class of paths. `in_practice_not`: it does, but with so large a
/// variance that the image of usual numbers of samples misses most of them.
enum class Visibility { no, in_part, in_practice_not, yes };

/// Cells of the table of docs/algorithms.md.
inline constexpr Named<Visibility> visibilities[] = {
    {Visibility::no, ""},
    {Visibility::in_part, "in part"},
    {Visibility::in_practice_not, "in practice not"},
    {Visibility::yes, "x"}};

/// Visibility of every class of paths.
class Sight {
  public:
    /// Returns the sight of an algorithm that sees every class.
    static constexpr Sight everything() {
        Sight sight;
        for (Visibility &seen : sight.seen_) {
            seen = Visibility::yes;
        }
        return sight;
    }

    constexpr Sight with(PathClass path, Visibility seen = Visibility::yes) const {
        Sight changed = *this;
        changed.seen_[static_cast<size_t>(path)] = seen;
        return changed;
    }
    constexpr Sight without(PathClass path) const { return with(path, Visibility::no); }

    constexpr Visibility of(PathClass path) const { return seen_[static_cast<size_t>(path)]; }

  private:
    std::array<Visibility, std::size(path_classes)> seen_{};
};

}  // namespace rtrays
