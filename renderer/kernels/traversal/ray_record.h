// SPDX-License-Identifier: MIT
#pragma once

#include "renderer/shared/compat.h"

/// A ray of trace_rays.cl. Distances count in lengths of `direction`.
typedef struct RayRecord {
    float origin[3];
    float t_max;  ///< exclusive; may be infinite
    float direction[3];
    uint padding;
} RayRecord;

/// What tracing one ray took.
typedef struct RayWork {
    uint nodes;      ///< nodes whose boxes were tested
    uint triangles;  ///< triangles tested
} RayWork;

#ifdef __cplusplus
static_assert(sizeof(RayRecord) == 32, "as in OpenCL C");
#endif
