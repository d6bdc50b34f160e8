// SPDX-License-Identifier: MIT
// Opacities of materials: whether a surface stops a ray.
//
// A surface of opacity a stops a ray with probability a. Embree may offer a primitive twice during
// one traversal, and in any order. The decision is therefore a function of the primitive and of a
// key, which is drawn for each ray.
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "reference/math.h"
#include "reference/texture.h"
#include "renderer/scene/stores.h"

namespace rtrays::reference {

/// The opacity of one material.
class Opacity {
  public:
    /// Throws `Error` (bad input) like `Texture`.
    Opacity(const MaterialOpacity &opacity, const TextureArrays &textures);

    bool is_opaque() const { return opaque_; }

    /// Returns the opacity at `uv`, which is 0 or 1 if there is a cutoff. The luminance of a
    /// texture's colour counts.
    double at(const Eigen::Vector2d &uv) const;

  private:
    bool opaque_ = true;
    double value_ = 1.0;
    double cutoff_ = 0.0;
    std::optional<Texture> texture_;
};

/// Returns the opacities of all materials, or nothing if all are opaque.
std::vector<Opacity> make_opacities(const MaterialArrays &materials, const TextureArrays &textures);

/// Returns whether a surface stops the ray with this key. `primitive` and `hit`, the number of
/// earlier hits with it, make decisions independent. An opacity of 1 or 0 is exact.
bool is_stopped(double opacity, uint64_t key, uint32_t primitive, uint32_t hit);

}  // namespace rtrays::reference
