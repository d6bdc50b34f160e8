// SPDX-License-Identifier: MIT
// Fresnel terms: the reflected fraction of unpolarised light.
//
// `cosine` is that of the angle of incidence, in [0, 1], and `sine2` the square of its sine.
// Sources: thesis (3.26)-(3.30); Born and Wolf 1999, section 14.2, for the exact conductor (derived
// in S. Lagarde, "Memo on Fresnel equations", 2013). Numerators of the form (x - y)^2 are not
// expanded, so that they cannot be negative.
#pragma once

#include "renderer/shared/compat.h"
#include "renderer/shared/scene_records.h"

/// Returns the squared sine of a local direction. squared_sine_of takes the cosine if the direction
/// is not known.
DEVICE float squared_sine(float3 w) {
    return w.x * w.x + w.y * w.y;
}
DEVICE float squared_sine_of(float cosine) {
    return (1.0f - cosine) * (1.0f + cosine);
}

/// Returns the cosine on the other side of a smooth boundary, or -1 at total internal reflection.
/// `cosine` and `sine2` are those on this side; `eta` is the index of refraction on the other side
/// over that on this side.
///
/// cos_t^2 = (eta^2 - s^2) / eta^2 = ((eta - 1) (eta + 1) + c^2) / eta^2. If the critical angle is
/// below 45 degrees, s has more digits than c near that angle: from within a high index, one ulp of
/// c corresponds to many ulps of the grazing angle outside. Otherwise the last form does not
/// cancel, even if eta is close to 1 or c close to 0. Near the critical angle the rounding of the
/// input alone decides; all callers see the same decision.
DEVICE float refracted_cosine(float cosine, float sine2, float eta) {
    const float scaled =
        eta * eta < 0.5f ? eta * eta - sine2 : (eta - 1.0f) * (eta + 1.0f) + cosine * cosine;
    return scaled > 0.0f ? min(sqrt(scaled) / eta, 1.0f) : -1.0f;
}

/// Returns the exact term of a dielectric, thesis (3.26) and (3.27); 1 at total internal
/// reflection. Denominators are positive because one of the cosines is.
DEVICE float fresnel_dielectric(float cosine, float sine2, float eta) {
    const float cos_t = refracted_cosine(cosine, sine2, eta);
    if (cos_t < 0.0f) {
        return 1.0f;
    }
    const float parallel = (eta * cosine - cos_t) / (eta * cosine + cos_t);
    const float perpendicular = (cosine - eta * cos_t) / (cosine + eta * cos_t);
    return 0.5f * (parallel * parallel + perpendicular * perpendicular);
}

/// Returns the exact term of a conductor with complex index eta + i k relative to the medium in
/// front, for eta > 0 and both up to 1e8.
///
/// With a + i b = sqrt((eta + i k)^2 - sin^2):
///
///   R_perpendicular = ((a - c)^2 + b^2) / ((a + c)^2 + b^2)
///   R_parallel = R_perpendicular ((a c - s^2)^2 + b^2 c^2) / ((a c + s^2)^2 + b^2 c^2).
DEVICE float fresnel_conductor(float cosine, float eta, float k) {
    const float cos2 = cosine * cosine;
    const float sin2 = max(1.0f - cos2, 0.0f);
    // Real part of eta^2 - k^2 - sin^2 + 2 i eta k, exact near eta = 1.
    const float re = (eta - 1.0f) * (eta + 1.0f) - k * k + cos2;
    const float im = eta * k;  // half the imaginary part
    const float modulus = sqrt(re * re + 4.0f * im * im);
    // The square root is taken of the sum that does not cancel; the other part follows from a b =
    // im.
    const float root = sqrt(0.5f * (modulus + fabs(re)));
    const float other = root > 0.0f ? im / root : 0.0f;
    const float a = re >= 0.0f ? root : other;
    const float b2 = re >= 0.0f ? other * other : root * root;
    const float denominator = (a + cosine) * (a + cosine) + b2;
    if (!(denominator > 0.0f)) {
        return 1.0f;  // at grazing incidence on an index of 1, as for dielectrics
    }
    const float perpendicular = ((a - cosine) * (a - cosine) + b2) / denominator;
    const float ac = a * cosine;
    const float ratio =
        ((ac - sin2) * (ac - sin2) + b2 * cos2) / ((ac + sin2) * (ac + sin2) + b2 * cos2);
    return 0.5f * perpendicular * (1.0f + ratio);
}

/// Returns the approximate term of a conductor, thesis (3.28). It differs from the exact term by up
/// to 0.006 for metals, and by more if eta^2 + k^2 is small.
DEVICE float fresnel_conductor_approximate(float cosine, float eta, float k) {
    const float kc = k * cosine;
    const float parallel = ((eta * cosine - 1.0f) * (eta * cosine - 1.0f) + kc * kc) /
                           ((eta * cosine + 1.0f) * (eta * cosine + 1.0f) + kc * kc);
    const float perpendicular =
        ((eta - cosine) * (eta - cosine) + k * k) / ((eta + cosine) * (eta + cosine) + k * k);
    return 0.5f * (parallel + perpendicular);
}

/// Returns Schlick's approximation, thesis (3.29); r0 is the reflectance at normal incidence.
DEVICE float fresnel_schlick(float cosine, float r0) {
    const float m = max(1.0f - cosine, 0.0f);
    const float m2 = m * m;
    return r0 + (1.0f - r0) * (m2 * m2 * m);
}

/// Returns the fraction that a thin plate reflects, with all reflections between its two parallel
/// surfaces: R + T^2 R (1 + R^2 + ...) = 2 R / (1 + R). `eta` is the index of the plate over that
/// around it.
DEVICE float fresnel_thin_dielectric(float cosine, float sine2, float eta) {
    const float f = fresnel_dielectric(cosine, sine2, eta);
    return 2.0f * f / (1.0f + f);
}

/// Returns F, or 1 - F, of a component's weight, per channel. `eta` is the relative index of a
/// dielectric (component_eta). Dielectrics are reciprocal: a ray and its refraction have the same F
/// on either side.
DEVICE float3 fresnel_term(GLOBAL const BxdfRecord *component, float eta, float cosine,
                           float sine2) {
    float3 f = make_float3(1.0f, 1.0f, 1.0f);
    const float c = min(fabs(cosine), 1.0f);
    const uint flags = component->flags;
    const uint kind = flags & FRESNEL_MASK;
    if (FEATURE_fresnel_dielectric && kind == FRESNEL_DIELECTRIC) {
        const float value = fresnel_dielectric(c, sine2, eta);
        f = make_float3(value, value, value);
    } else if (FEATURE_fresnel_conductor && kind == FRESNEL_CONDUCTOR) {
        f = make_float3(fresnel_conductor(c, component->eta[0], component->k[0]),
                        fresnel_conductor(c, component->eta[1], component->k[1]),
                        fresnel_conductor(c, component->eta[2], component->k[2]));
    } else if (FEATURE_fresnel_conductor_approximate && kind == FRESNEL_CONDUCTOR_APPROXIMATE) {
        f = make_float3(fresnel_conductor_approximate(c, component->eta[0], component->k[0]),
                        fresnel_conductor_approximate(c, component->eta[1], component->k[1]),
                        fresnel_conductor_approximate(c, component->eta[2], component->k[2]));
    } else if (FEATURE_fresnel_schlick && kind == FRESNEL_SCHLICK) {
        f = make_float3(fresnel_schlick(c, component->eta[0]),
                        fresnel_schlick(c, component->eta[1]),
                        fresnel_schlick(c, component->eta[2]));
    } else if (FEATURE_fresnel_thin_dielectric && kind == FRESNEL_THIN_DIELECTRIC) {
        const float value = fresnel_thin_dielectric(c, sine2, component->eta[1]);
        f = make_float3(value, value, value);
    } else {
        return f;  // FRESNEL_IDEAL: 1, with or without complement
    }
    return (flags & BXDF_FLAG_COMPLEMENT) != 0u ? make_float3(1.0f, 1.0f, 1.0f) - f : f;
}
