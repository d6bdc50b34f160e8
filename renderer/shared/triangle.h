// SPDX-License-Identifier: MIT
#pragma once

#include "renderer/shared/compat.h"

/// A triangle in leaf order, with its vertices in place: traversal follows no index. Coordinates
/// stand axis by axis because the triangle test picks its axes by the ray's direction.
typedef struct LeafTriangle {
    float coordinate[3][3];  ///< [x, y, z][vertex 0, 1, 2], scene units
    uint id;                 ///< its index in the scene's list of triangles
    uint padding[2];
} LeafTriangle;

#ifdef __cplusplus
static_assert(sizeof(LeafTriangle) == 48, "as in OpenCL C");
static_assert(offsetof(LeafTriangle, id) == 36, "as in OpenCL C");
#endif
