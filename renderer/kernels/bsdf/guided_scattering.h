// SPDX-License-Identifier: MIT
// Guided scattering: behind a mirror or glass, camera paths follow the light that light paths have
// found there.
//
// Where R of MIS (11) is 0, no light path can be joined to the camera: x_1 is a delta. Neither the
// weights of light paths nor R then depend on how the camera path goes on. This tail of the path
// may scatter by any density of its vertex. A cell of a scatter guide (shared/guide_layout.h) has a
// density g over the directions, from the light that arrived there in a pilot. The tail scatters
// with
//
//   p^C = (1 - s) p + s g,  s = GUIDE_SHARE
//
// per solid angle, where p is the density of the material. p^C replaces p in p_I, in explicit paths
// too, MIS (7).
//
// p^C is at least (1 - s) p, so that no weight grows by more than 1 / (1 - s). Where p is 0, no
// path continues.
//
// Sources: H. W. Jensen, "Importance driven path tracing using the photon map", 1995; J. Vorba et
// al., "On-line learning of parametric mixture models for light transport simulation", ACM TOG
// 33(4), 2014. Departure: only tails are guided, so that light paths need no guide.
#pragma once

#include "renderer/kernels/bsdf/bsdf.h"
#include "renderer/kernels/sampling/guide_table.h"
#include "renderer/kernels/sampling/hemisphere.h"

/// s, the share of directions that a guide samples.
#define GUIDE_SHARE 0.5f

/// Returns the side of a surface with the unit normal `n` (shared/guide_layout.h).
DEVICE uint guide_side(float3 n) {
    const float3 size = fabs(n);
    if (size.x > size.y && size.x > size.z) {
        return n.x < 0.0f ? 1u : 0u;
    }
    if (size.y > size.z) {
        return n.y < 0.0f ? 3u : 2u;
    }
    return n.z < 0.0f ? 5u : 4u;
}

/// Returns the table of the cell at a point of a side, or NO_GUIDE_TABLE.
DEVICE uint guide_cell(GLOBAL const uint *guide, float3 point, uint side) {
    uint node = guide[side];
    for (;;) {
        const uint link = guide[node] >> GUIDE_LINK_BITS;
        const uint axis = guide[node] & ((1u << GUIDE_LINK_BITS) - 1u);
        if (axis == GUIDE_LEAF) {
            return link;
        }
        const float at = axis == 0u ? point.x : axis == 1u ? point.y : point.z;
        node = at < as_float(guide[node + 1u]) ? link : link + GUIDE_NODE_WORDS;
    }
}

/// Returns p^C of direction `wi`, where `pdf_w` is p; p without a table.
DEVICE float guided_pdf_w(PRIVATE const SceneView *scene, uint table, float pdf_w, float3 wi) {
    if (!FEATURE_guided_scattering || table == NO_GUIDE_TABLE || !(pdf_w > 0.0f)) {
        return pdf_w;
    }
    const float g =
        guide_bin_density(scene->scatter_guide, table, sphere_bin(wi)) * (0.25f * INV_PI);
    return (1.0f - GUIDE_SHARE) * pdf_w + GUIDE_SHARE * g;
}

/// Samples a direction in proportion to p^C, by the words of BLOCK_SCATTER. Sets `by_material` to p
/// over p^C.
DEVICE BsdfSample sample_guided(PRIVATE const SceneView *scene, uint material, SurfaceFrame frame,
                                uint table, uint4 words, PRIVATE float *by_material) {
    const float select = uniform_float(words.w);
    const float u = uniform_float(words.x), v = uniform_float(words.y);
    *by_material = 1.0f;
    if (!FEATURE_guided_scattering || table == NO_GUIDE_TABLE) {
        return bsdf_sample(scene, material, frame, select, u, v);
    }
    BsdfSample sample;
    if (select < GUIDE_SHARE) {
        const GuideSample square = sample_table(scene->scatter_guide, table, words.x, words.y);
        sample = no_sample(frame);
        sample.wi = sample_uniform_sphere(square.u, square.v);
        const BsdfValue value = bsdf_evaluate(scene, material, frame, sample.wi);
        sample.pdf_w = value.pdf_w;
        sample.weight = value.pdf_w > 0.0f ? value.f_cos / value.pdf_w : value.f_cos;
    } else {
        sample = bsdf_sample(scene, material, frame, (select - GUIDE_SHARE) / (1.0f - GUIDE_SHARE),
                             u, v);
    }
    if (!(sample.pdf_w > 0.0f)) {
        return sample;
    }
    if (sample.pdf_w < INFINITY) {
        const float pdf_w = guided_pdf_w(scene, table, sample.pdf_w, sample.wi);
        *by_material = sample.pdf_w / pdf_w;
        sample.pdf_w = pdf_w;
    } else {
        *by_material = 1.0f / (1.0f - GUIDE_SHARE);
        sample.probability *= 1.0f - GUIDE_SHARE;
    }
    sample.weight *= *by_material;
    return sample;
}
