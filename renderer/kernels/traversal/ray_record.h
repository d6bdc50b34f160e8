// SPDX-License-Identifier: MIT
// Records of the kernels in trace_rays.cl, shared with the host.
#pragma once

#include "renderer/shared/compat.h"

/// A ray of trace_rays.cl. Distances are in lengths of `direction`.
typedef struct RayRecord {
    float origin[3];
    float t_max;  ///< exclusive; may be infinite
    float direction[3];
    uint padding;
} RayRecord;

/// Traversal work of one ray.
typedef struct RayWork {
    uint nodes;      ///< number of nodes whose boxes were tested
    uint triangles;  ///< number of triangles tested
} RayWork;

#ifdef __cplusplus
static_assert(sizeof(RayRecord) == 32, "as in OpenCL C");
#endif
