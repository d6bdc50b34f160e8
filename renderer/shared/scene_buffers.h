// SPDX-License-Identifier: MIT
// The buffers of a scene. These tables declare them once: the kernels' parameters, the members of
// SceneView (kernels/scene_view.h), the host's buffers and their bindings derive from them.
#pragma once

#include "bvh_layout.h"
#include "compat.h"
#include "declare.h"

// X(feature, type, name)

/// The hierarchy, which belongs to the builder.
#define HIERARCHY_BUFFERS(X)                  \
    X(FEATURE_triangles, BVH_NODE, bvh_nodes) \
    X(FEATURE_triangles, BVH_TRIANGLES, bvh_triangles)

/// The shapes, which rays are tested against and which are shaded.
#define SHAPE_BUFFERS(X)                   \
    X(FEATURE_shapes, ShapeRecord, shapes) \
    X(FEATURE_shapes, ShapeBounds, shape_bounds)

/// What decides whether a ray passes a surface that is not opaque (kernels/traversal/opacity.h).
/// `triangle_masks` has an index into `masked_triangles`, or OPAQUE, for each triangle.
#define OPACITY_BUFFERS(X)                               \
    X(FEATURE_opacity, uint, triangle_masks)             \
    X(FEATURE_opacity, MaskedTriangle, masked_triangles) \
    X(FEATURE_opacity, OpacityRecord, opacities)         \
    X(FEATURE_opacity, float, opacity_texels)

/// The triangles for shading, the materials and the lights.
#define SHADING_BUFFERS(X)                                       \
    X(FEATURE_triangles, SurfaceTriangle, surface_triangles)     \
    X(FEATURE_smooth_normals, TriangleNormals, triangle_normals) \
    X(FEATURE_texture_coordinates, TriangleUv, triangle_uvs)     \
    X(FEATURE_vertex_colours, TriangleColours, triangle_colours) \
    X(FEATURE_scattering, MaterialRecord, materials)             \
    X(FEATURE_scattering, BxdfRecord, components)                \
    X(FEATURE_mixtures, MixRecord, mixes)                        \
    X(FEATURE_coated_lambert, float, coat_transmittances)        \
    X(FEATURE_textures, TextureRecord, textures)                 \
    X(FEATURE_textures, uint, texels)                            \
    X(FEATURE_normal_maps, NormalMapRecord, normal_maps)         \
    X(FEATURE_lights, LightRecord, lights)                       \
    X(FEATURE_area_lights, EmitterTriangle, emitter_triangles)   \
    X(FEATURE_environment, float, environment_texels)            \
    X(FEATURE_environment, uint, environment_ends)

/// The guides (shared/guide_layout.h), which belong to a session. They are null where paths are not
/// guided.
#define GUIDE_BUFFERS(X)                             \
    X(FEATURE_guided_emission, uint, emission_guide) \
    X(FEATURE_guided_scattering, uint, scatter_guide)
