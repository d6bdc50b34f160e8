// SPDX-License-Identifier: MIT
#include "reference/shading.h"

namespace rtrays::reference {

Parametrization parametrize_for(const Geometry &geometry, const SurfacePoint &point,
                                const Vec3 &wo) {
    const Vec3 ng = geometry.normal(point);
    Parametrization surface = geometry.parametrize(point);
    Vec3 &ns = surface.shading_normal;
    if (ns.dot(ng) < 0.0) {
        ns = -ns;
    }
    if (!(ns.dot(wo) * ng.dot(wo) > 0.0)) {
        ns = ng;
    }
    return surface;
}

Shading make_tilted_shading(const Geometry &geometry, const SurfacePoint &point, const Vec3 &wo,
                            const NormalTilt &tilt) {
    const Vec3 ng = geometry.normal(point);
    Parametrization surface = geometry.parametrize(point);
    if (surface.shading_normal.dot(ng) < 0.0) {
        surface.shading_normal = -surface.shading_normal;
    }
    return {Frame(tilt.normal_for(surface, ng, wo), surface.tangent),
            ng,
            TexturePoint(surface.uv, surface.colour),
            true,
            &tilt,
            surface.shading_normal,
            tilt.normal(surface, ng)};
}

}  // namespace rtrays::reference
