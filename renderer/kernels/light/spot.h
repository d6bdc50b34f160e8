// SPDX-License-Identifier: MIT
// Spot lights: intensity, and sampling of directions for light paths.
//
// The intensity is constant inside the inner cone. From there it falls linearly with the angle to 0
// at the outer cone (Mitsuba 3's spot). Light paths leave with a density that is constant inside
// the inner cone and falls linearly with the cosine outside. Between the cones, intensity over
// density is within [tan(o / 2) / o, 1] of its value on the axis, where o is the outer angle.
// Weights thus vary by a factor below 2. Angles are stored as versines, 1 - cos, which keep their
// digits in narrow cones.
#pragma once

#include "renderer/shared/compat.h"
#include "renderer/shared/scene_records.h"

/// A direction out of a spot.
typedef struct SpotDirection {
    float versine;  ///< versine of the angle from the axis
    /// 1 inside the inner cone, linear in the versine down to 0 at the outer cone, and 0 outside.
    float profile;
} SpotDirection;

/// Returns the position of `direction` in the spot's cones; it is a unit vector away from the
/// light.
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

/// Returns the intensity in a direction over that on the axis.
DEVICE float spot_share(LightRecord light, SpotDirection spot) {
    if (!(spot.profile > 0.0f)) {
        return 0.0f;
    }
    // (outer - angle) / (outer - inner). The difference of the angles follows without cancellation
    // from that of the versines: cos a - cos b = 2 sin((a + b) / 2) sin((b - a) / 2).
    const float angle = 2.0f * asin(sqrt(0.5f * spot.versine));
    const float half_difference =
        asin(spot.profile * light.versine_range / (2.0f * sin(0.5f * (light.outer_angle + angle))));
    return spot.profile < 1.0f ? min(2.0f * half_difference * light.angle_scale, 1.0f) : 1.0f;
}

/// Returns the density per solid angle of `sample_spot`. The integral of the profile over the inner
/// cone is 2 pi times the inner versine. Between the cones it is pi times the difference of their
/// versines.
DEVICE float spot_pdf_w(LightRecord light, SpotDirection spot) {
    return spot.profile * (INV_PI / (2.0f * light.versine_outer - light.versine_range));
}

/// Samples a direction from a uniform u in [0, 1). The caller samples its azimuth.
DEVICE SpotDirection sample_spot(LightRecord light, float u) {
    const float versine_inner = light.versine_outer - light.versine_range;
    const float mass = u * (2.0f * versine_inner + light.versine_range);
    SpotDirection spot;
    spot.versine = 0.5f * mass;
    spot.profile = 1.0f;
    if (mass >= 2.0f * versine_inner) {
        // The profile has a density of twice its value. Rounding must not make it 0, where the
        // light emits nothing.
        const float below = (mass - 2.0f * versine_inner) / light.versine_range;
        spot.profile = sqrt(max(1.0f - below, 0x1p-24f));
        spot.versine = light.versine_outer - spot.profile * light.versine_range;
    }
    return spot;
}
