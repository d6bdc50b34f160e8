// SPDX-License-Identifier: MIT
#include "reference/shading.h"

namespace rtrays::reference {

Shading make_detailed_shading(const Geometry &geometry, const SurfacePoint &point, const Vec3 &wo) {
    const Vec3 ng = geometry.normal(point);
    const Parametrization surface = geometry.parametrize(point);
    Vec3 ns = surface.shading_normal;
    if (ns.dot(ng) < 0.0) {
        ns = -ns;
    }
    const bool bent = geometry.has_shading_normal(point) && ns.dot(wo) * ng.dot(wo) > 0.0;
    return {Frame(bent ? ns : ng, surface.tangent), ng, surface.uv, bent};
}

}  // namespace rtrays::reference
