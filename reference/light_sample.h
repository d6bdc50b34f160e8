// SPDX-License-Identifier: MIT
#pragma once

#include <optional>

#include "reference/math.h"

namespace rtrays::reference {

/// A direction in which to look for light.
struct LightSample {
    Vec3 wi;      ///< unit, from the shaded point towards the light
    Vec3 target;  ///< end of the shadow segment, off the light's own surface; unused at infinity
    Spectrum radiance;  ///< arriving from there when nothing is in between; of a delta light:
                        ///< irradiance of a plane facing it
    double pdf_w;   ///< per solid angle at the shaded point, selection included; of a delta light
                    ///< the probability of its selection
    bool delta;     ///< cannot be hit by chance: no MIS partner
    bool infinite;  ///< the light is at infinity
};

}  // namespace rtrays::reference
