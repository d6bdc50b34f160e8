// SPDX-License-Identifier: MIT
// A triangle in leaf order, for hierarchies that test one triangle at a time.
#pragma once

#include "renderer/shared/compat.h"

/// A triangle in leaf order with its vertices in place, so that traversal follows no index.
/// Coordinates are stored axis by axis because the triangle test picks its axes by the ray's
/// direction.
typedef struct LeafTriangle {
    float coordinate[3][3];  ///< [x, y, z][vertex 0, 1, 2], in scene units
    uint id;                 ///< index in the scene's list of triangles
    uint padding[2];
} LeafTriangle;

#ifdef __cplusplus
static_assert(sizeof(LeafTriangle) == 48, "as in OpenCL C");
static_assert(offsetof(LeafTriangle, id) == 36, "as in OpenCL C");
#endif
