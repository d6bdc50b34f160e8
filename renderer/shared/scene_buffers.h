// SPDX-License-Identifier: MIT
// The scene's buffers as kernel parameters, declared once: the kernels' parameter lists and the host's bindings
// both come from these tables.
#pragma once

#include "declare.h"

// X(feature, type, name)
#define SURFACE_BUFFERS(X)                                       \
    X(FEATURE_triangles, SurfaceTriangle, surface_triangles)     \
    X(FEATURE_scattering, MaterialRecord, materials)             \
    X(FEATURE_scattering, BxdfRecord, components)

#define LIGHT_BUFFERS(X)                      \
    X(FEATURE_lights, LightRecord, lights)    \
    X(FEATURE_lights, EmitterTriangle, emitter_triangles)

#ifdef __OPENCL_VERSION__

// A stage's parameters: buffers of the scene (these lists end in a comma), its own, and the stream last.
#define BVH_PARAMETERS GLOBAL const BvhNode *bvh_nodes, GLOBAL const LeafTriangle *bvh_triangles,
#define BUFFER_PARAMETER(type, name) GLOBAL const type *name,
#define X_PARAMETER(feature, type, name) WHEN(feature, BUFFER_PARAMETER(type, name))
#define SURFACE_PARAMETERS SURFACE_BUFFERS(X_PARAMETER)
#define LIGHT_PARAMETERS LIGHT_BUFFERS(X_PARAMETER) uint light_count,
// The same as arguments of a device function.
#define BUFFER_ARGUMENT(type, name) name,
#define X_ARGUMENT(feature, type, name) WHEN(feature, BUFFER_ARGUMENT(type, name))
#define SURFACE_ARGUMENTS SURFACE_BUFFERS(X_ARGUMENT)
#define LIGHT_ARGUMENTS LIGHT_BUFFERS(X_ARGUMENT) light_count,
#define STREAM_PARAMETERS GLOBAL uint *path_words, GLOBAL uint *queues, GLOBAL StreamCounters *counters, uint capacity

#endif
