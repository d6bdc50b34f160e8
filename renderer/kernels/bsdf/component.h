// SPDX-License-Identifier: MIT
// One component of a material: its BxDF model, selected under the features of the scene, with
// weight, texture and Fresnel term (thesis (3.52)). renderer/scene/stores.h describes the
// components. Local directions are those of lobe.h.
#pragma once

#include "renderer/kernels/bsdf/blinn.h"
#include "renderer/kernels/bsdf/coat.h"
#include "renderer/kernels/bsdf/diffuse.h"
#include "renderer/kernels/bsdf/disney.h"
#include "renderer/kernels/bsdf/distribution.h"
#include "renderer/kernels/bsdf/fresnel.h"
#include "renderer/kernels/bsdf/ideal.h"
#include "renderer/kernels/bsdf/microfacet.h"
#include "renderer/kernels/bsdf/surface_frame.h"
#include "renderer/kernels/bsdf/ward.h"
#include "renderer/kernels/sampling/hemisphere.h"
#include "renderer/kernels/scene_view.h"
#include "renderer/kernels/texture/texture.h"
#include "renderer/shared/compat.h"
#include "renderer/shared/scene_records.h"

/// Returns the index of refraction beyond the surface over that on wo's side. Only boundaries
/// distinguish their sides; all other materials have the same index from both.
DEVICE float component_eta(GLOBAL const BxdfRecord *component, uint material_flags, uint front) {
    const float eta = component->eta[0];
    return (material_flags & MATERIAL_BOUNDARY) != 0u && front == 0u ? 1.0f / eta : eta;
}

/// Returns the share of a component in its mixture at `uv`. Rounding may take it below 0.
DEVICE float component_mix(PRIVATE const SceneView *scene, GLOBAL const BxdfRecord *component,
                           float2 uv) {
    const uint number = component->flags >> BXDF_MIX_SHIFT;
    if (!FEATURE_mixtures || number == 0u) {
        return 1.0f;
    }
    GLOBAL const MixRecord *mix = scene->mixes + (number - 1u);
    const float luminance =
        rec709_luminance(texture_lookup(scene->textures + mix->texture, scene->texels, uv));
    return max(mix->offset + mix->scale * luminance, 0.0f);
}

/// Returns weight times texture times mix at a point with this frame, for a base below a coat with
/// the light that the coat reflects back; black if the component does not reflect on wo's side.
DEVICE float3 component_colour(PRIVATE const SceneView *scene, GLOBAL const BxdfRecord *component,
                               SurfaceFrame frame) {
    const uint excluded = frame.front != 0u ? BXDF_FLAG_BACK_ONLY : BXDF_FLAG_FRONT_ONLY;
    if (FEATURE_component_sides && (component->flags & excluded) != 0u) {
        return make_float3(0.0f, 0.0f, 0.0f);
    }
    float3 colour = make_float3(component->weight[0], component->weight[1], component->weight[2]);
    if (FEATURE_textures && component->texture != NO_TEXTURE) {
        GLOBAL const TextureRecord *texture = scene->textures + component->texture;
        colour *= texture_lookup(texture, scene->texels, frame.uv);
        if (FEATURE_vertex_colours && (texture->flags & TEXTURE_VERTEX_COLOURS) != 0u) {
            colour *= frame.colour;
        }
    }
    if (FEATURE_coated_lambert && component->kind == BXDF_COATED_LAMBERT) {
        colour = colour_below_coat(component, colour);
    }
    return FEATURE_mixtures ? colour * component_mix(scene, component, frame.uv) : colour;
}

DEVICE bool is_delta(uint kind) {
    return FEATURE_delta && (kind == BXDF_IDEAL_REFLECTION || kind == BXDF_IDEAL_REFRACTION);
}

/// Returns whether the component transmits light: it scatters only to wi below the surface. All
/// other kinds scatter only to wi above it.
DEVICE bool is_refracting(uint kind) {
    return (FEATURE_ideal_refraction && kind == BXDF_IDEAL_REFRACTION) ||
           (FEATURE_microfacet_refraction && kind == BXDF_MICROFACET_REFRACTION);
}

/// Returns the factor of the roughness at `uv`: the luminance of its texture.
DEVICE float roughness_factor(PRIVATE const SceneView *scene, GLOBAL const BxdfRecord *component,
                              float2 uv) {
    if (!FEATURE_roughness_textures || (component->flags & BXDF_FLAG_ROUGHNESS_TEXTURE) == 0u) {
        return 1.0f;
    }
    return rec709_luminance(
        texture_lookup(scene->textures + component->coat_or_roughness, scene->texels, uv));
}

DEVICE Roughness component_roughness(PRIVATE const SceneView *scene,
                                     GLOBAL const BxdfRecord *component, float2 uv) {
    Roughness r;
    r.alpha_x = component->alpha_x;
    r.alpha_y = component->alpha_y;
    r.beckmann = component->flags & BXDF_FLAG_BECKMANN;
    if (FEATURE_roughness_textures && (component->flags & BXDF_FLAG_ROUGHNESS_TEXTURE) != 0u) {
        // The host bounds the product by 1.
        const float factor = roughness_factor(scene, component, uv);
        const bool squared = (component->flags & BXDF_FLAG_ROUGHNESS_SQUARED) != 0u;
        const float scale = squared ? factor * factor : factor;
        r.alpha_x = max(r.alpha_x * scale, LEAST_ALPHA);
        r.alpha_y = max(r.alpha_y * scale, LEAST_ALPHA);
    }
    return r;
}

/// Evaluates the model of a component at `uv`. Returns zero for delta components.
DEVICE Lobe component_evaluate(PRIVATE const SceneView *scene, GLOBAL const BxdfRecord *component,
                               float eta, float2 uv, float3 wo, float3 wi) {
    const uint kind = component->kind;
    if ((FEATURE_lambert && kind == BXDF_LAMBERT) ||
        (FEATURE_coated_lambert && kind == BXDF_COATED_LAMBERT)) {
        return lambert_evaluate(wo, wi);
    }
    if (FEATURE_oren_nayar && kind == BXDF_OREN_NAYAR) {
        return oren_nayar_evaluate(wo, wi, component->parameter);
    }
    if (FEATURE_blinn && kind == BXDF_BLINN) {
        return blinn_evaluate(wo, wi, component->parameter);
    }
    if (FEATURE_ward && kind == BXDF_WARD) {
        return ward_evaluate(wo, wi, component_roughness(scene, component, uv), true);
    }
    if (FEATURE_ward_original && kind == BXDF_WARD_ORIGINAL) {
        return ward_evaluate(wo, wi, component_roughness(scene, component, uv), false);
    }
    if (FEATURE_microfacet_reflection && kind == BXDF_MICROFACET_REFLECTION) {
        return microfacet_reflection_evaluate(wo, wi, component_roughness(scene, component, uv));
    }
    if (FEATURE_microfacet_refraction && kind == BXDF_MICROFACET_REFRACTION) {
        return microfacet_refraction_evaluate(wo, wi, component_roughness(scene, component, uv),
                                              eta);
    }
    if (FEATURE_disney_diffuse && kind == BXDF_DISNEY_DIFFUSE) {
        return disney_diffuse_evaluate(
            wo, wi, component->parameter * roughness_factor(scene, component, uv), component->k[0]);
    }
    if (FEATURE_disney_sheen && kind == BXDF_DISNEY_SHEEN) {
        return disney_sheen_evaluate(wo, wi);
    }
    if (FEATURE_disney_clearcoat && kind == BXDF_DISNEY_CLEARCOAT) {
        return disney_clearcoat_evaluate(wo, wi, component->alpha_x);
    }
    return no_lobe();
}

/// Samples a direction by the component's model from u, v in [0, 1). If there is none, it is on the
/// wrong side of the surface or has z = 0.
DEVICE float3 component_direction(PRIVATE const SceneView *scene,
                                  GLOBAL const BxdfRecord *component, float eta, float2 uv,
                                  float3 wo, float u, float v) {
    const uint kind = component->kind;
    if (FEATURE_blinn && kind == BXDF_BLINN) {
        return blinn_direction(wo, component->parameter, u, v);
    }
    if ((FEATURE_ward && kind == BXDF_WARD) ||
        (FEATURE_ward_original && kind == BXDF_WARD_ORIGINAL)) {
        return ward_direction(wo, component_roughness(scene, component, uv), u, v);
    }
    if (FEATURE_microfacet_reflection && kind == BXDF_MICROFACET_REFLECTION) {
        return microfacet_reflection_direction(wo, component_roughness(scene, component, uv), u, v);
    }
    if (FEATURE_microfacet_refraction && kind == BXDF_MICROFACET_REFRACTION) {
        return microfacet_refraction_direction(wo, component_roughness(scene, component, uv), eta,
                                               u, v);
    }
    if (FEATURE_ideal_reflection && kind == BXDF_IDEAL_REFLECTION) {
        return ideal_reflection_direction(wo);
    }
    if (FEATURE_ideal_refraction && kind == BXDF_IDEAL_REFRACTION) {
        return ideal_refraction_direction(wo, eta);
    }
    if (FEATURE_disney_clearcoat && kind == BXDF_DISNEY_CLEARCOAT) {
        return disney_clearcoat_direction(wo, component->alpha_x, u, v);
    }
    return sample_cosine_hemisphere(u, v);  // diffuse kinds and sheen
}

/// Returns the Fresnel term of the component's weight for wo and wi, or the transmittances of its
/// coat. `cosine` is that of Lobe, `sine2` the square of its sine.
///
/// Diffuse kinds use the product of the terms of both directions, so that they remain reciprocal,
/// unless the material requests the term of wo alone (thesis (3.55)).
DEVICE float3 component_fresnel(PRIVATE const SceneView *scene, GLOBAL const BxdfRecord *component,
                                float eta, float cosine, float sine2, float3 wo, float3 wi) {
    if (FEATURE_coated_lambert && component->kind == BXDF_COATED_LAMBERT) {
        const float transmittance =
            coat_transmittance(scene, component, wo) * coat_transmittance(scene, component, wi);
        return make_float3(transmittance, transmittance, transmittance);
    }
    if (!FEATURE_fresnel) {
        return make_float3(1.0f, 1.0f, 1.0f);
    }
    float3 f = fresnel_term(component, eta, cosine, sine2);
    if ((FEATURE_lambert || FEATURE_oren_nayar) &&
        (component->kind == BXDF_LAMBERT || component->kind == BXDF_OREN_NAYAR) &&
        (component->flags & BXDF_FLAG_FRESNEL_OF_WO) == 0u) {
        f *= fresnel_term(component, eta, wi.z, squared_sine(wi));
    }
    return f;
}

/// Returns the value to which component selection is proportional: the estimated fraction of light
/// from wo that the component scatters, times `colour`, averaged over the channels. It depends only
/// on the geometry at the point, the texture and the Fresnel term (thesis, section 2.7.4). It is
/// exact for deltas, and positive wherever the component is.
///
/// The Fresnel term of a rough boundary applies at the microfacets' normals, which are not known
/// here. The term is therefore blended towards 1/2 by the root of the roughness, as 1 - F grows
/// with the root of the angle near total internal reflection. Thus no direction is selected far too
/// rarely, and contributions remain bounded.
DEVICE float component_share(PRIVATE const SceneView *scene, GLOBAL const BxdfRecord *component,
                             float eta, float2 uv, float3 wo, float3 colour) {
    const bool glossy = FEATURE_blinn || FEATURE_ward || FEATURE_ward_original ||
                        FEATURE_microfacet_reflection || FEATURE_microfacet_refraction ||
                        FEATURE_disney_clearcoat;
    if (FEATURE_fresnel) {
        float3 f = fresnel_term(component, eta, wo.z, squared_sine(wo));
        if (glossy && (component->flags & FRESNEL_MASK) != FRESNEL_IDEAL &&
            component->kind >= BXDF_BLINN) {
            // Blinn's cos^e is as wide as a Gaussian of roughness sqrt(2 / (e + 2)).
            const Roughness r = component_roughness(scene, component, uv);
            const float alpha = component->kind == BXDF_BLINN
                                    ? sqrt(2.0f / (component->parameter + 2.0f))
                                    : min(max(r.alpha_x, r.alpha_y), 1.0f);
            const float s = sqrt(alpha);
            f = f * (1.0f - s) + make_float3(0.5f * s, 0.5f * s, 0.5f * s);
        }
        colour *= f;
    }
    if (FEATURE_coated_lambert && component->kind == BXDF_COATED_LAMBERT) {
        colour *= coat_transmittance(scene, component, wo);
    }
    if (FEATURE_ideal_refraction && component->kind == BXDF_IDEAL_REFRACTION &&
        refracted_cosine(wo.z, squared_sine(wo), eta) <= 0.0f) {
        return 0.0f;
    }
    return (colour.x + colour.y + colour.z) * 0.333333333f;
}
