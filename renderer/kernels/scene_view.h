// SPDX-License-Identifier: MIT
// The scene as device functions see it: one record of pointers, which a kernel fills at its entry.
//
// A kernel receives the buffers that it needs as parameters: TRACING_PARAMETERS for rays,
// SHADING_PARAMETERS for materials and lights, or SCENE_PARAMETERS for both. Its first line is
//
//     const SceneView scene = SHADING_VIEW;
//
// with the view of the same name. Device functions receive `PRIVATE const SceneView *scene`. A
// pointer is null if its feature is off or if the kernel has no parameter for it. All functions are
// inlined, so the record costs nothing.
#pragma once

#include "renderer/shared/compat.h"
#include "renderer/shared/scene_buffers.h"
#include "renderer/shared/scene_records.h"

/// Pointers to the buffers of the scene (shared/scene_buffers.h) and its records by value.
typedef struct SceneView {
#define X(feature, type, name) GLOBAL const type *name;
    HIERARCHY_BUFFERS(X)
    OPACITY_BUFFERS(X)
    SHAPE_BUFFERS(X)
    SHADING_BUFFERS(X)
    GUIDE_BUFFERS(X)
#undef X
    uint shape_count;
    LightingRecord lighting;
} SceneView;

#ifdef __OPENCL_VERSION__

#define BUFFER_PARAMETER(type, name) GLOBAL const type *name,
#define X_PARAMETER(feature, type, name) WHEN(feature)(BUFFER_PARAMETER(type, name))
#define TRACING_PARAMETERS         \
    HIERARCHY_BUFFERS(X_PARAMETER) \
    OPACITY_BUFFERS(X_PARAMETER) SHAPE_BUFFERS(X_PARAMETER) uint shape_count
#define SHADING_PARAMETERS       \
    SHAPE_BUFFERS(X_PARAMETER)   \
    SHADING_BUFFERS(X_PARAMETER) \
    GUIDE_BUFFERS(X_PARAMETER) uint shape_count, LightingRecord lighting
#define SCENE_PARAMETERS           \
    HIERARCHY_BUFFERS(X_PARAMETER) \
    OPACITY_BUFFERS(X_PARAMETER)   \
    SHADING_PARAMETERS

#define BUFFER_INITIALISER(type, name) .name = name,
#define X_INITIALISER(feature, type, name) WHEN(feature)(BUFFER_INITIALISER(type, name))
#define SHADING_MEMBERS            \
    SHAPE_BUFFERS(X_INITIALISER)   \
    SHADING_BUFFERS(X_INITIALISER) \
    GUIDE_BUFFERS(X_INITIALISER).shape_count = shape_count, .lighting = lighting
#define TRACING_MEMBERS HIERARCHY_BUFFERS(X_INITIALISER) OPACITY_BUFFERS(X_INITIALISER)
// clang-format off
#define TRACING_VIEW \
    { TRACING_MEMBERS SHAPE_BUFFERS(X_INITIALISER) .shape_count = shape_count }
#define SHADING_VIEW { SHADING_MEMBERS }
#define SCENE_VIEW { TRACING_MEMBERS SHADING_MEMBERS }
// clang-format on

#endif
