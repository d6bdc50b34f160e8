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

}  // namespace rtrays::reference
