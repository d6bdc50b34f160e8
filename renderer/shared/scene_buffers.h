// SPDX-License-Identifier: MIT
// The buffers of a scene. These tables declare them once: the kernels' parameter lists, the host's
// buffers and their bindings derive from them.
#pragma once

#include "bvh_layout.h"
#include "compat.h"
#include "declare.h"

// X(feature, type, name)
#define GEOMETRY_BUFFERS(X)                   \
    X(FEATURE_triangles, BVH_NODE, bvh_nodes) \
    X(FEATURE_triangles, BVH_TRIANGLES, bvh_triangles)

#define BOUNDS_BUFFERS(X) X(FEATURE_shapes, ShapeBounds, shape_bounds)

#define SURFACE_BUFFERS(X)                                       \
    X(FEATURE_triangles, SurfaceTriangle, surface_triangles)     \
    X(FEATURE_smooth_normals, TriangleNormals, triangle_normals) \
    X(FEATURE_texture_coordinates, TriangleUv, triangle_uvs)     \
    X(FEATURE_shapes, ShapeRecord, shapes)

#define MATERIAL_BUFFERS(X)                          \
    X(FEATURE_scattering, MaterialRecord, materials) \
    X(FEATURE_scattering, BxdfRecord, components)    \
    X(FEATURE_textures, TextureRecord, textures)     \
    X(FEATURE_textures, uint, texels)

#define LIGHT_BUFFERS(X)                                       \
    X(FEATURE_lights, LightRecord, lights)                     \
    X(FEATURE_area_lights, EmitterTriangle, emitter_triangles) \
    X(FEATURE_environment, float, environment_texels)          \
    X(FEATURE_environment, uint, environment_ends)

// Parameters of a stage, in this order: buffers of the scene, the stage's own parameters, and the
// stream (stream_counters.h). The lists below end in a comma.
#define BUFFER_PARAMETER(type, name) MAYBE_UNUSED GLOBAL const type *name,
#define X_PARAMETER(feature, type, name) WHEN(feature)(BUFFER_PARAMETER(type, name))
#define SHAPE_COUNT_PARAMETER uint shape_count,
#define GEOMETRY_PARAMETERS                          \
    GEOMETRY_BUFFERS(X_PARAMETER)                    \
    X_PARAMETER(FEATURE_shapes, ShapeRecord, shapes) \
    BOUNDS_BUFFERS(X_PARAMETER) WHEN(FEATURE_shapes)(SHAPE_COUNT_PARAMETER)
// Traversal parameters of a stage that already has the shapes among its surface parameters.
#define TRAVERSAL_PARAMETERS      \
    GEOMETRY_BUFFERS(X_PARAMETER) \
    BOUNDS_BUFFERS(X_PARAMETER) WHEN(FEATURE_shapes)(SHAPE_COUNT_PARAMETER)
#define SURFACE_PARAMETERS SURFACE_BUFFERS(X_PARAMETER)
#define MATERIAL_PARAMETERS MATERIAL_BUFFERS(X_PARAMETER)
#define LIGHT_PARAMETERS LIGHT_BUFFERS(X_PARAMETER) MAYBE_UNUSED LightingRecord lighting,
// The arguments by which a device function receives these parameters.
#define BUFFER_ARGUMENT(type, name) name,
#define X_ARGUMENT(feature, type, name) WHEN(feature)(BUFFER_ARGUMENT(type, name))
#define SHAPE_COUNT_ARGUMENT shape_count,
#define GEOMETRY_ARGUMENTS                          \
    GEOMETRY_BUFFERS(X_ARGUMENT)                    \
    X_ARGUMENT(FEATURE_shapes, ShapeRecord, shapes) \
    BOUNDS_BUFFERS(X_ARGUMENT) WHEN(FEATURE_shapes)(SHAPE_COUNT_ARGUMENT)
#define TRAVERSAL_ARGUMENTS      \
    GEOMETRY_BUFFERS(X_ARGUMENT) \
    BOUNDS_BUFFERS(X_ARGUMENT) WHEN(FEATURE_shapes)(SHAPE_COUNT_ARGUMENT)
#define SURFACE_ARGUMENTS SURFACE_BUFFERS(X_ARGUMENT)
#define MATERIAL_ARGUMENTS MATERIAL_BUFFERS(X_ARGUMENT)
#define LIGHT_ARGUMENTS LIGHT_BUFFERS(X_ARGUMENT) lighting,

// The light vertices (shared/light_vertex.h), if they are stored. The lists end in a comma.
#define VERTEX_BUFFER_PARAMETER GLOBAL uint *vertex_words,
#define VERTEX_BUFFER_ARGUMENT vertex_words,
#define VERTEX_PARAMETERS WHEN(FEATURE_vertex_joins)(VERTEX_BUFFER_PARAMETER)
#define VERTEX_ARGUMENTS WHEN(FEATURE_vertex_joins)(VERTEX_BUFFER_ARGUMENT)

// The stacks of branch vertices (shared/branch.h), if paths branch. The lists end in a comma.
#define BRANCH_BUFFER_PARAMETER GLOBAL uint *branch_words,
#define BRANCH_BUFFER_ARGUMENT branch_words,
#define BRANCH_PARAMETERS WHEN(FEATURE_branches)(BRANCH_BUFFER_PARAMETER)
#define BRANCH_ARGUMENTS WHEN(FEATURE_branches)(BRANCH_BUFFER_ARGUMENT)
