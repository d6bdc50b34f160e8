// SPDX-License-Identifier: MIT
// The local frame in which a surface scatters, and the convention for interpolated normals.
//
// The renderer uses the same convention. The shading normal ns is flipped to the side of the
// geometric normal ng. If wo is then on different sides of the two, ng replaces ns. BSDF and cosine
// are those of ns.
//
// A direction wi on different sides of ng and ns contributes nothing. A path that sampled it ends,
// and a light in that direction is ignored. Therefore reflected light leaves on wo's geometric
// side, refracted light leaves on the other side, and no light leaks through a closed surface.
#pragma once

#include "reference/geometry.h"
#include "reference/math.h"
#include "reference/normal_map.h"
#include "reference/texture.h"

namespace rtrays::reference {

/// The scattering frame at a surface point.
struct Shading {
    Frame frame;  ///< z is the shading normal on the surface's front, x along dp/du
    Vec3 geometric_normal;
    TexturePoint at;                   ///< where textures are looked up
    bool bent;                         ///< whether the frame's z differs from the geometric normal
    const NormalTilt *tilt = nullptr;  ///< the map of the material, or nullptr
    Vec3 untilted = Vec3::Zero();      ///< shading normal without the map
    Vec3 tilted = Vec3::Zero();        ///< the normal of the map

    /// Returns the share of light from `wi` that is not shadowed by the map.
    double share(const Vec3 &wi) const {
        return tilt == nullptr ? 1.0 : tilt->shadowing(tilted, untilted, wi);
    }

    /// Returns whether wi, given in both spaces, is on the same side of both normals.
    bool agrees(const Vec3 &wi, const Vec3 &wi_local) const {
        return !bent || geometric_normal.dot(wi) * wi_local.z() > 0.0;
    }
};

/// Returns the parametrization of the surface, with its shading normal flipped or replaced
/// according to the convention above.
Parametrization parametrize_for(const Geometry &geometry, const SurfacePoint &point,
                                const Vec3 &wo);

/// Builds the scattering frame of a surface with a map of normals or heights.
Shading make_tilted_shading(const Geometry &geometry, const SurfacePoint &point, const Vec3 &wo,
                            const NormalTilt &tilt);

/// Builds the scattering frame. `parametrized` tells whether uv and the direction of dp/du are
/// needed, and `tilt` is the map of the material, or nullptr. The simple case is inline, so that
/// the frame stays in registers.
inline Shading make_shading(const Geometry &geometry, const SurfacePoint &point, const Vec3 &wo,
                            bool parametrized, const NormalTilt *tilt = nullptr) {
    if (tilt != nullptr && !tilt->is_none()) {
        return make_tilted_shading(geometry, point, wo, *tilt);
    }
    const Vec3 ng = geometry.normal(point);
    if (!parametrized && !geometry.has_shading_normal(point)) {
        return {Frame(ng), ng, Eigen::Vector2d(Eigen::Vector2d::Zero()), false};
    }
    const Parametrization surface = parametrize_for(geometry, point, wo);
    return {Frame(surface.shading_normal, surface.tangent), ng,
            TexturePoint(surface.uv, surface.colour), surface.shading_normal != ng};
}

}  // namespace rtrays::reference
