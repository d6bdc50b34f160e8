// SPDX-License-Identifier: MIT
#include "reference/delta_light.h"

namespace rtrays::reference {

std::optional<LightSample> PointLight::sample(const Geometry &, const Vec3 &from, Rng &) const {
    const Vec3 to_light = position_ - from;
    const double distance_squared = to_light.squaredNorm();
    if (!(distance_squared > 0.0)) {
        return std::nullopt;  // `from` is the position of the light: there is no direction
    }
    return LightSample{to_light / std::sqrt(distance_squared),
                       position_,
                       intensity_ / distance_squared,
                       1.0,
                       true,
                       false};
}

std::optional<LightSample> SpotLight::sample(const Geometry &geometry, const Vec3 &from,
                                             Rng &rng) const {
    // The angle comes from sine and cosine, because acos would lose the digits of small angles.
    const Vec3 away = from - position_;
    const double angle = std::atan2(axis_.cross(away).norm(), axis_.dot(away));
    if (angle >= outer_) {
        return std::nullopt;
    }
    const double share = angle <= inner_ ? 1.0 : (outer_ - angle) / (outer_ - inner_);
    return PointLight(position_, share * intensity_).sample(geometry, from, rng);
}

}  // namespace rtrays::reference
