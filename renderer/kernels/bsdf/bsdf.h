// SPDX-License-Identifier: MIT
// The BSDF of a material: evaluation of the sum of its components (thesis (3.51)), and sampling of
// directions.
//
// Directions wi and wo are unit vectors away from the surface; wo leads to where the path came
// from. Densities are per solid angle. The scene loader guarantees that
// - eta > 0;
// - a refracting component has a dielectric or ideal Fresnel term, and an index other than 1 if it
//   is rough;
// - roughness is in [1e-4, 1].
#pragma once

#include "renderer/kernels/bsdf/component.h"
#include "renderer/kernels/bsdf/surface_frame.h"
#include "renderer/shared/compat.h"
#include "renderer/shared/scene_records.h"

/// The value and density of a direction.
typedef struct BsdfValue {
    float3 f_cos;  ///< f |cos(ns, wi)| in 1/sr, without delta components
    /// Density per solid angle of bsdf_sample, without deltas. Departure from thesis, section
    /// 2.7.4: it is summed over all components.
    float pdf_w;
} BsdfValue;

/// A sampled direction, with its weight and density.
typedef struct BsdfSample {
    float3 wi;
    /// f |cos(ns, wi)| / pdf_w over all components except deltas; for a delta: coefficient /
    /// probability.
    float3 weight;
    /// Density per solid angle; 0: nothing was sampled and the path ends; INFINITY: wi is that of a
    /// delta.
    float pdf_w;
    /// Factor (3.40) on radiance that crosses a boundary, included in `weight`; 1 for reflection.
    float scale;
    uint component;     ///< index of the selected component
    float probability;  ///< probability with which it was selected
} BsdfSample;

/// Transforms a unit vector to the frame and normalises it. For narrow lobes at grazing angles the
/// sum wo + wi is short. An error of 1e-7 in either length then shifts its slope by more than that
/// of the direction itself.
DEVICE float3 to_local(SurfaceFrame frame, float3 w) {
    return normalize(make_float3(dot(frame.x, w), dot(frame.y, w), dot(frame.ns, w)));
}

/// Returns whether light may pass between wo and wi. wo is on the front of both normals, and
/// `local_z` is the local height of wi. Light does not pass if wi is on different sides of the
/// geometric and the shading normal, or in the plane of the latter (lobe.h). The test also applies
/// if both normals are equal: rounding can take a grazing direction across the surface, and a path
/// inside a closed mirror would never leave it.
DEVICE bool sides_agree(SurfaceFrame frame, float3 wi, float local_z) {
    return fabs(local_z) >= MIN_COSINE && dot(frame.ng, wi) * local_z > 0.0f;
}

/// Returns whether the material scatters light towards wo at all. A boundary cannot be one-sided,
/// because light passes through it.
DEVICE bool side_scatters(MaterialRecord material, SurfaceFrame frame, float cos_wo) {
    if (FEATURE_one_sided && frame.front == 0u &&
        (material.flags & (MATERIAL_ONE_SIDED | MATERIAL_BOUNDARY)) == MATERIAL_ONE_SIDED) {
        return false;
    }
    if (FEATURE_composite && material.component_count == 0u) {
        return false;
    }
    return cos_wo >= MIN_COSINE;
}

/// Returns whether no channel of a value is positive; NaN counts as black.
DEVICE bool is_black(float3 value) {
    return !(value.x > 0.0f || value.y > 0.0f || value.z > 0.0f);
}

/// Returns whether all components of a material are deltas.
DEVICE bool is_delta_material(MaterialRecord material) {
    return FEATURE_delta && (material.flags & MATERIAL_DELTA) != 0u;
}

/// Returns the share of light from the local direction `wi` that the microsurface of a map lets
/// pass (normal_map.h): the shadowing of GGX (B. Walter et al. 2007) with the roughness of the
/// tilt.
DEVICE float map_shadowing(SurfaceFrame frame, float3 wi) {
    const float cosine = fabs(dot(frame.untilted, wi));
    const float cos2 = cosine * cosine;
    const float alpha2 = frame.shadowing_alpha2;
    const float sum = cosine + sqrt(cos2 + alpha2 * max(1.0f - cos2, 0.0f));
    return alpha2 > 0.0f && sum > 0.0f ? 2.0f * cosine / sum : 1.0f;
}

/// bsdf_evaluate for local directions whose sides agree.
DEVICE BsdfValue bsdf_evaluate_local(PRIVATE const SceneView *scene, MaterialRecord material,
                                     SurfaceFrame frame, float3 wo, float3 wi) {
    BsdfValue value;
    GLOBAL const BxdfRecord *component = scene->components + material.first_component;
    const float eta = component_eta(component, material.flags, frame.front);
    const float3 colour = component_colour(scene, component, frame);
    const Lobe lobe = component_evaluate(scene, component, eta, frame.uv, wo, wi);
    value.pdf_w = lobe.pdf_w;
    value.f_cos = colour *
                  component_fresnel(scene, component, eta, lobe.cosine,
                                    squared_sine_of(lobe.cosine), wo, wi) *
                  lobe.f_cos;
    // A material of one component needs no selection. It ends here with the same bits as in a scene
    // without composite materials.
    if (FEATURE_composite && material.component_count > 1u) {
        float shares = component_share(scene, component, eta, frame.uv, wo, colour);
        value.pdf_w *= shares;
        for (uint i = 1u; i < material.component_count; ++i) {
            GLOBAL const BxdfRecord *other = component + i;
            const float other_eta = component_eta(other, material.flags, frame.front);
            const float3 other_colour = component_colour(scene, other, frame);
            const float share =
                component_share(scene, other, other_eta, frame.uv, wo, other_colour);
            const Lobe other_lobe = component_evaluate(scene, other, other_eta, frame.uv, wo, wi);
            shares += share;
            value.pdf_w += share * other_lobe.pdf_w;
            value.f_cos += other_colour *
                           component_fresnel(scene, other, other_eta, other_lobe.cosine,
                                             squared_sine_of(other_lobe.cosine), wo, wi) *
                           other_lobe.f_cos;
        }
        value.pdf_w = shares > 0.0f ? value.pdf_w / shares : 0.0f;
    }
    if (FEATURE_normal_maps) {
        value.f_cos *= map_shadowing(frame, wi);
    }
    return value;
}

/// Returns f |cos(ns, wi)| and the density of bsdf_sample. Both are 0 if the sides of the geometric
/// and the shading normal disagree.
DEVICE BsdfValue bsdf_evaluate(PRIVATE const SceneView *scene, uint material, SurfaceFrame frame,
                               float3 wi) {
    const MaterialRecord record = scene->materials[material];
    const float3 local_wo = to_local(frame, frame.wo);
    const float3 local_wi = to_local(frame, wi);
    if (!side_scatters(record, frame, local_wo.z) || !sides_agree(frame, wi, local_wi.z) ||
        is_delta_material(record)) {
        BsdfValue nothing;
        nothing.f_cos = make_float3(0.0f, 0.0f, 0.0f);
        nothing.pdf_w = 0.0f;
        return nothing;
    }
    return bsdf_evaluate_local(scene, record, frame, local_wo, local_wi);
}

/// Directions between the horizons of the geometric and the shading normal, on the side of either.
///
/// A frame follows the shading normal unless wo is in such a direction (surface_frame.h). On a
/// camera path, light from such a direction is black, because the sides of the normals disagree. A
/// camera path that ARRIVES from such a direction w scatters in the frame of the geometric normal,
/// however. Light paths must therefore continue in it, although their own frame gives w a density
/// of 0.
///
/// Exchanging both normals by a reflection maps the directions between the horizons to themselves.
/// A light path that samples one of them continues in its mirror image. Other paths do not change.
///
/// Returns whether `w` is such a direction, and sets its mirror image.
DEVICE bool mirror_between_horizons(SurfaceFrame frame, float3 w, PRIVATE float3 *image) {
    if (!FEATURE_smooth_normals) {
        return false;
    }
    const float3 axis = frame.ns - frame.ng;
    const float axis2 = dot(axis, axis);
    // Below 1e-4 radians, rounding hides the axis. A share of 2.5e-9 of all directions is lost.
    if (!(axis2 > 1e-8f) || !(dot(frame.ns, w) * dot(frame.ng, w) < 0.0f)) {
        return false;
    }
    const float3 mirrored = normalize(w - axis * (2.0f * dot(axis, w) / axis2));
    *image = mirrored;
    return dot(frame.ns, mirrored) * dot(frame.ng, mirrored) < 0.0f;
}

/// Returns the density per solid angle with which a light path that arrives from frame.wo continues
/// in direction `w`. It is that of bsdf_sample in a pass of light paths.
DEVICE float light_path_pdf_w(PRIVATE const SceneView *scene, uint material, SurfaceFrame frame,
                              float3 w) {
    float3 image;
    if (!mirror_between_horizons(frame, w, &image)) {
        return bsdf_evaluate(scene, material, frame, w).pdf_w;
    }
    const MaterialRecord record = scene->materials[material];
    const float3 local_wo = to_local(frame, frame.wo);
    const float3 local_image = to_local(frame, image);
    if (!side_scatters(record, frame, local_wo.z) || fabs(local_image.z) < MIN_COSINE ||
        is_delta_material(record)) {
        return 0.0f;
    }
    return bsdf_evaluate_local(scene, record, frame, local_wo, local_image).pdf_w;
}

/// Selects a component in proportion to its share. `probability` is the share over the sum of all
/// shares. Returns false if all shares are 0.
DEVICE bool select_component(PRIVATE const SceneView *scene, MaterialRecord material,
                             SurfaceFrame frame, float3 wo, float select, PRIVATE uint *selected,
                             PRIVATE float *probability) {
    *selected = material.first_component;
    *probability = 1.0f;
    if (!FEATURE_composite || material.component_count == 1u) {
        return true;
    }
    // A single pass over the components: each replaces the selected one with a probability of its
    // share over the sum so far. The remainder of the random number is uniform again.
    float shares = 0.0f, share = 0.0f;
    for (uint i = 0u; i < material.component_count; ++i) {
        const uint index = material.first_component + i;
        GLOBAL const BxdfRecord *component = scene->components + index;
        const float eta = component_eta(component, material.flags, frame.front);
        const float candidate = component_share(scene, component, eta, frame.uv, wo,
                                                component_colour(scene, component, frame));
        if (candidate > 0.0f) {
            shares += candidate;
            const float take_over = candidate / shares;
            if (select < take_over) {
                *selected = index;
                share = candidate;
                select = select / take_over;
            } else {
                select = (select - take_over) / (1.0f - take_over);
            }
        }
    }
    *probability = share / shares;
    return share > 0.0f;
}

/// Returns the sample of a path that ends.
DEVICE BsdfSample no_sample(SurfaceFrame frame) {
    BsdfSample sample;
    sample.wi = frame.ns;
    sample.weight = make_float3(0.0f, 0.0f, 0.0f);
    sample.pdf_w = 0.0f;
    sample.scale = 1.0f;
    sample.component = 0u;
    sample.probability = 0.0f;
    return sample;
}

/// Completes the sample of a light path whose direction sample.wi, `wi` in local coordinates, is
/// between the horizons of the normals. The weight remains 0, because it is that of camera paths.
DEVICE BsdfSample sample_between_horizons(PRIVATE const SceneView *scene, MaterialRecord record,
                                          SurfaceFrame frame, float3 wo, float3 wi,
                                          BsdfSample sample) {
    GLOBAL const BxdfRecord *component = scene->components + sample.component;
    float3 image;
    if (fabs(wi.z) < MIN_COSINE || is_delta(component->kind) ||
        !mirror_between_horizons(frame, sample.wi, &image)) {
        return sample;
    }
    sample.wi = image;
    sample.pdf_w = bsdf_evaluate_local(scene, record, frame, wo, wi).pdf_w;
    return sample;
}

/// Completes `sample`, whose component and probability are set, by a direction of that component,
/// from u and v in [0, 1). `wo` is frame.wo in local coordinates, and its side scatters.
DEVICE BsdfSample sample_component(PRIVATE const SceneView *scene, MaterialRecord record,
                                   SurfaceFrame frame, float3 wo, BsdfSample sample, float u,
                                   float v) {
    GLOBAL const BxdfRecord *component = scene->components + sample.component;
    const float eta = component_eta(component, record.flags, frame.front);
    const float3 wi = component_direction(scene, component, eta, frame.uv, wo, u, v);
    // Normalised, because rounding errors would otherwise grow along the path.
    const float3 world = frame.x * wi.x + frame.y * wi.y + frame.ns * wi.z;
    const float length2 = dot(world, world);
    sample.wi = length2 > 0.0f ? world / sqrt(length2) : frame.ns;
    // A direction on the wrong side of the component is rejected. It must not be taken for a
    // direction of another component, whose density does not include it.
    if ((wi.z < 0.0f) != is_refracting(component->kind)) {
        return sample;
    }
    if (!sides_agree(frame, sample.wi, wi.z)) {
        return FEATURE_from_light ? sample_between_horizons(scene, record, frame, wo, wi, sample)
                                  : sample;
    }
    sample.scale = is_refracting(component->kind) ? refraction_scale(eta) : 1.0f;
    if (is_delta(component->kind)) {
        sample.weight = component_colour(scene, component, frame) *
                        component_fresnel(scene, component, eta, wo.z, squared_sine(wo), wo, wi) /
                        sample.probability;
        sample.weight *= sample.scale;
        if (FEATURE_normal_maps && !FEATURE_from_light) {
            sample.weight *= map_shadowing(frame, wi);
        }
        sample.pdf_w = INFINITY;
        return sample;
    }
    const BsdfValue value = bsdf_evaluate_local(scene, record, frame, wo, wi);
    if (value.pdf_w > 0.0f) {
        sample.pdf_w = value.pdf_w;
        sample.weight = value.f_cos / value.pdf_w;
    }
    return sample;
}

/// Samples a direction from `select`, u and v in [0, 1).
DEVICE BsdfSample bsdf_sample(PRIVATE const SceneView *scene, uint material, SurfaceFrame frame,
                              float select, float u, float v) {
    BsdfSample sample = no_sample(frame);
    const MaterialRecord record = scene->materials[material];
    const float3 wo = to_local(frame, frame.wo);
    if (!side_scatters(record, frame, wo.z) ||
        !select_component(scene, record, frame, wo, select, &sample.component,
                          &sample.probability)) {
        return sample;
    }
    return sample_component(scene, record, frame, wo, sample, u, v);
}

/// Returns the direction of an ideal reflection or refraction, with the coefficient of the delta as
/// its weight. Returns no sample for other kinds of component or past the critical angle.
DEVICE BsdfSample bsdf_delta(PRIVATE const SceneView *scene, MaterialRecord record,
                             SurfaceFrame frame, uint component) {
    BsdfSample sample = no_sample(frame);
    const float3 wo = to_local(frame, frame.wo);
    if (!is_delta(scene->components[component].kind) || !side_scatters(record, frame, wo.z)) {
        return sample;
    }
    sample.component = component;
    sample.probability = 1.0f;
    return sample_component(scene, record, frame, wo, sample, 0.0f, 0.0f);
}
