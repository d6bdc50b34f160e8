// SPDX-License-Identifier: MIT
// Spots: full intensity inside the inner cone, from there a linear fall with the angle to 0 at the
// outer one (Mitsuba 3's spot).
//
// Light paths leave with a density that is constant inside the inner cone and falls linearly with
// the cosine outside: between the cones intensity over density lies within [tan(o / 2) / o, 1] of
// its value on the axis, o the outer angle, so weights vary by less than 2. Angles are held as
// versines, 1 - cos, which keep their digits in narrow cones.
#pragma once

#include "renderer/shared/compat.h"
#include "renderer/shared/scene_records.h"

#if FEATURE_spot_lights

/// A direction out of a spot.
typedef struct SpotDirection {
    float versine;  ///< of the angle from the axis
    float profile;  ///< 1 inside the inner cone, from there to the outer one linear in the versine,
                    ///< 0 outside
} SpotDirection;

/// `direction` is unit, away from the light.
DEVICE SpotDirection spot_direction(LightRecord light, float3 direction) {
    const float3 axis = make_float3(-light.axis_z[0], -light.axis_z[1], -light.axis_z[2]);
    const float cosine = dot(axis, direction);
    const float3 across = cross(axis, direction);
    SpotDirection spot;
    // sin^2 = versine (1 + cos). Cones are no wider than a hemisphere.
    spot.versine = cosine > 0.0f ? dot(across, across) / (1.0f + cosine) : 1.0f - cosine;
    spot.profile = min(max((light.versine_outer - spot.versine) / light.versine_range, 0.0f), 1.0f);
    return spot;
}

/// Intensity over that on the axis.
DEVICE float spot_share(LightRecord light, SpotDirection spot) {
    if (!(spot.profile > 0.0f)) {
        return 0.0f;
    }
    // (outer - angle) / (outer - inner). The difference of the angles without cancellation, from
    // that of the versines: cos a - cos b = 2 sin((a + b) / 2) sin((b - a) / 2).
    const float angle = 2.0f * asin(sqrt(0.5f * spot.versine));
    const float half_difference =
        asin(spot.profile * light.versine_range / (2.0f * sin(0.5f * (light.outer_angle + angle))));
    return spot.profile < 1.0f ? min(2.0f * half_difference * light.angle_scale, 1.0f) : 1.0f;
}

#if FEATURE_from_light || FEATURE_light_strategy

/// Density per solid angle of `sample_spot`: its integral over the inner cone is 2 pi inner
/// versine, over the rest pi times the versines between the cones.
DEVICE float spot_pdf_w(LightRecord light, SpotDirection spot) {
    return spot.profile * (INV_PI / (2.0f * light.versine_outer - light.versine_range));
}

/// The angle of a sampled direction from the axis; u is uniform in [0, 1).
DEVICE SpotDirection sample_spot(LightRecord light, float u) {
    const float versine_inner = light.versine_outer - light.versine_range;
    const float mass = u * (2.0f * versine_inner + light.versine_range);
    SpotDirection spot;
    spot.versine = 0.5f * mass;
    spot.profile = 1.0f;
    if (mass >= 2.0f * versine_inner) {
        // The profile has density twice itself. Rounding must not bring it to 0, where there is no
        // light.
        const float below = (mass - 2.0f * versine_inner) / light.versine_range;
        spot.profile = sqrt(max(1.0f - below, 0x1p-24f));
        spot.versine = light.versine_outer - spot.profile * light.versine_range;
    }
    return spot;
}

#endif

#endif
