// SPDX-License-Identifier: MIT
// LightSample, a direction towards a light sampled for an explicit connection.
#pragma once

#include <optional>

#include "reference/math.h"

namespace rtrays::reference {

/// A direction sampled towards a light.
struct LightSample {
    Vec3 wi;      ///< unit, from the shaded point towards the light
    Vec3 target;  ///< end of the shadow ray, off the light's surface; unused at infinity
    /// Radiance arriving from the light if nothing is in between; for a delta light, the irradiance
    /// of a plane facing it.
    Spectrum radiance;
    /// Density per solid angle at the shaded point, including the selection; for a delta light, the
    /// selection probability.
    double pdf_w;
    bool delta;     ///< a path cannot hit the light, so there is no MIS partner
    bool infinite;  ///< the light is at infinity
};

}  // namespace rtrays::reference
