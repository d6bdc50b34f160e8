// SPDX-License-Identifier: MIT
// Scene records as the device reads them, written by the scene compiler. Plain words only: no float3.
#pragma once

#include "compat.h"

#define NO_EMITTER 0xffffffffu

/// A perspective camera (pinhole). The ray through film position (x, y), in pixels from the top left corner,
/// is corner + x * step_x + y * step_y, before normalization.
typedef struct CameraRecord {
    float position[3];
    float pixel_area;   ///< of one pixel on the plane at unit distance along the axis
    float corner[3];
    uint width;         ///< pixels
    float step_x[3];
    uint height;        ///< pixels
    float step_y[3];
    float padding;
} CameraRecord;

/// What shading needs of a triangle, in the scene's triangle order.
typedef struct SurfaceTriangle {
    float p0[3];
    uint material;
    float p1[3];
    uint emitter;     ///< index into the emitter triangles, NO_EMITTER when it emits nothing
    float p2[3];
    float extent;     ///< largest side of the box around its edges, scene units
    float normal[3];  ///< unit, on the side from which p0, p1, p2 run counter-clockwise; zero when degenerate
    float padding;
} SurfaceTriangle;

/// Reflection of a surface: for now a Lambert reflector, both sides alike.
typedef struct MaterialRecord {
    float reflectance[3];  ///< albedo
    float padding;
} MaterialRecord;

/// A light as the sampler sees it. Diffuse area light on a mesh, emitting from the front side.
typedef struct LightRecord {
    float radiance[3];        ///< W / (sr m^2)
    float selection;          ///< probability that light selection takes this light
    uint selection_end;       ///< this light is taken by random words below this end (and not below its predecessor's)
    uint first_triangle;      ///< its range of emitter triangles
    uint triangle_count;
    uint padding;
} LightRecord;

/// A triangle of a mesh light.
typedef struct EmitterTriangle {
    uint triangle;       ///< scene triangle
    uint light;          ///< index of its light
    uint selection_end;  ///< as in LightRecord, within its light
    float pdf_a;         ///< density per area of a point on it, its light given
} EmitterTriangle;

#ifndef __OPENCL_VERSION__
static_assert(sizeof(CameraRecord) == 64, "layout shared with the device");
static_assert(sizeof(SurfaceTriangle) == 64, "layout shared with the device");
static_assert(sizeof(MaterialRecord) == 16, "layout shared with the device");
static_assert(sizeof(LightRecord) == 32, "layout shared with the device");
static_assert(sizeof(EmitterTriangle) == 16, "layout shared with the device");
#endif
