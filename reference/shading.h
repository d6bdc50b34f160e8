// SPDX-License-Identifier: MIT
// The local frame in which a surface scatters.
//
// Convention of interpolated normals, the same in the renderer: the shading normal ns is turned to
// the side of the geometric normal ng; where wo then still lies on different sides of the two, ng
// takes the place of ns. BSDF and cosine are those of ns. A direction wi on different sides of ng
// and ns contributes nothing, neither when it was sampled (the path ends) nor when a light lies
// there: so what is reflected leaves on wo's geometric side, what is refracted on the other one,
// and no light leaks through a closed surface.
#pragma once

#include "reference/geometry.h"
#include "reference/math.h"

namespace rtrays::reference {

struct Shading {
    Frame frame;  ///< z is the shading normal on the surface's front, x along dp/du
    Vec3 geometric_normal;
    Eigen::Vector2d uv;
    bool bent;  ///< whether the frame's z is not the geometric normal

    /// Whether wi, as given in both spaces, lies on the same side of both normals.
    bool agrees(const Vec3 &wi, const Vec3 &wi_local) const {
        return !bent || geometric_normal.dot(wi) * wi_local.z() > 0.0;
    }
};

/// The surface's parametrization with its shading normal turned and replaced as above.
Parametrization parametrize_for(const Geometry &geometry, const SurfacePoint &point,
                                const Vec3 &wo);

/// `parametrized`: whether uv and the direction of dp/du are asked for. All of the plain case is
/// inline, so that the frame stays in registers.
inline Shading make_shading(const Geometry &geometry, const SurfacePoint &point, const Vec3 &wo,
                            bool parametrized) {
    const Vec3 ng = geometry.normal(point);
    if (!parametrized && !geometry.has_shading_normal(point)) {
        return {Frame(ng), ng, Eigen::Vector2d::Zero(), false};
    }
    const Parametrization surface = parametrize_for(geometry, point, wo);
    return {Frame(surface.shading_normal, surface.tangent), ng, surface.uv,
            surface.shading_normal != ng};
}

}  // namespace rtrays::reference
