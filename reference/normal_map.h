// SPDX-License-Identifier: MIT
// Maps of normals and heights, which tilt the shading normals of a material (conventions:
// renderer/scene/stores.h).
#pragma once

#include <optional>
#include <vector>

#include "reference/geometry.h"
#include "reference/math.h"
#include "reference/texture.h"
#include "renderer/scene/stores.h"

namespace rtrays::reference {

/// The map of one material.
class NormalTilt {
  public:
    /// Throws `Error` (bad input) like `Texture`.
    NormalTilt(const NormalMap &map, const TextureArrays &textures);

    bool is_none() const { return map_.kind == NormalMap::Kind::none; }

    /// Returns the tilted normal, unit, on the front of a surface whose shading normal is on the
    /// side of the geometric normal `ng`. Without a direction, the shading normal is returned.
    Vec3 normal(const Parametrization &surface, const Vec3 &ng) const;

    /// Returns the tilted normal that light leaving in direction `wo` sees, on the front. Its tilt
    /// is reversed if wo would be below its horizon. If that does not help, it is `ng`.
    Vec3 normal_for(const Parametrization &surface, const Vec3 &ng, const Vec3 &wo) const;

    /// Returns the share of light from `wi` that passes the microsurface whose normals have the
    /// tilt of `tilted`. `untilted` is the shading normal without the map.
    double shadowing(const Vec3 &tilted, const Vec3 &untilted, const Vec3 &wi) const;

  private:
    Vec3 normal_of_texel(const Parametrization &surface) const;
    Vec3 normal_of_heights(const Parametrization &surface, const Vec3 &ng) const;

    NormalMap map_;
    std::optional<Texture> texture_;
};

/// Returns the maps of all materials, or nothing if there are none.
std::vector<NormalTilt> make_normal_tilts(const MaterialArrays &materials,
                                          const TextureArrays &textures);

}  // namespace rtrays::reference
