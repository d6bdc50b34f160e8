// SPDX-License-Identifier: MIT
// Scene records as the device reads them, written by the scene compiler. Plain words only: no
// float3.
#pragma once

#include "compat.h"

#define NO_EMITTER 0xffffffffu

/// A perspective camera: pinhole or thin lens. The ray through film position (x, y), in pixels from
/// the top left corner, is corner + x * step_x + y * step_y, before normalization.
typedef struct CameraRecord {
    float position[3];
    float pixel_area;  ///< of one pixel on the plane at unit distance along the axis
    float corner[3];
    uint width;  ///< pixels
    float step_x[3];
    uint height;  ///< pixels
    float step_y[3];
    float aperture_radius;  ///< of the lens; 0 for a pinhole
    float axis_x[3];        ///< unit, to the right
    float focus_distance;   ///< of the plane in focus, along the axis
    float axis_y[3];        ///< unit, up
    float padding;
} CameraRecord;

/// What shading needs of a triangle, in the scene's triangle order.
typedef struct SurfaceTriangle {
    float p0[3];
    uint material;
    float p1[3];
    uint emitter;  ///< index into the emitter triangles, NO_EMITTER when it emits nothing
    float p2[3];
    float extent;     ///< largest side of the box around its edges, scene units
    float normal[3];  ///< unit, on the side from which p0, p1, p2 run counter-clockwise; zero when
                      ///< degenerate
    float padding;
} SurfaceTriangle;

/// The components of a material, and what holds for all of them.
typedef struct MaterialRecord {
    uint first_component;
    uint component_count;
    uint flags;  ///< MATERIAL_*
    uint padding;
} MaterialRecord;

#define MATERIAL_BOUNDARY \
    1u  ///< refracts: the indices on its two sides differ, its sides are told apart
#define MATERIAL_ONE_SIDED 2u  ///< black from behind
#define MATERIAL_DELTA 4u      ///< all components are deltas: there is nothing to join to a light
#define MATERIAL_TURNS 8u      ///< looks different when the tangent turns: anisotropic

/// One atomic BxDF of a material (renderer/scene/stores.h says what each is).
typedef struct BxdfRecord {
    uint kind;        ///< BXDF_*
    uint flags;       ///< FRESNEL_*, BXDF_FLAG_*
    uint texture;     ///< NO_TEXTURE for none
    float parameter;  ///< sigma of BXDF_OREN_NAYAR, exponent of BXDF_BLINN
    float weight[3];
    float alpha_x;  ///< roughness along the tangent
    float eta[3];   ///< Fresnel: relative index of refraction (dielectric: [0]) or reflectance
                    ///< (Schlick)
    float alpha_y;  ///< roughness across the tangent
    float k[3];     ///< extinction coefficient of a conductor
    float padding;
} BxdfRecord;

#define NO_TEXTURE 0xffffffffu

#define BXDF_LAMBERT 0u
#define BXDF_OREN_NAYAR 1u
#define BXDF_IDEAL_REFLECTION 2u
#define BXDF_IDEAL_REFRACTION 3u
#define BXDF_BLINN 4u
#define BXDF_WARD 5u
#define BXDF_WARD_ORIGINAL 6u
#define BXDF_MICROFACET_REFLECTION 7u
#define BXDF_MICROFACET_REFRACTION 8u

#define FRESNEL_MASK 7u
#define FRESNEL_IDEAL 0u
#define FRESNEL_DIELECTRIC 1u
#define FRESNEL_CONDUCTOR 2u
#define FRESNEL_CONDUCTOR_APPROXIMATE 3u
#define FRESNEL_SCHLICK 4u
#define BXDF_FLAG_COMPLEMENT 8u      ///< 1 - F
#define BXDF_FLAG_FRESNEL_OF_WO 16u  ///< not symmetric in wi and wo
#define BXDF_FLAG_BECKMANN 32u       ///< else GGX

/// A texture: a range of the texel buffer. 8-bit texels take one word each (R in the lowest byte),
/// float texels three.
typedef struct TextureRecord {
    uint first_word;
    uint width;
    uint height;
    uint flags;  ///< TEXTURE_*
    float uv_scale[2];
    float uv_offset[2];
} TextureRecord;

#define TEXTURE_FLOAT 1u  ///< else 8 bits
#define TEXTURE_SRGB 2u
#define TEXTURE_BILINEAR 4u  ///< else nearest
#define TEXTURE_CLAMP 8u     ///< else repeat

/// Shading normals and texture coordinates of a triangle's corners, each in a buffer that exists
/// where needed.
typedef struct TriangleNormals {
    float normal[3][3];
    uint is_smooth;  ///< 0: the geometric normal holds, the others say nothing
    uint padding[2];
} TriangleNormals;
typedef struct TriangleUv {
    float uv[3][2];
} TriangleUv;

/// A surface that is not made of triangles, in the object space of the record: that of ShapeArrays,
/// but for the cone, whose apex is the origin here.
typedef struct ShapeRecord {
    float world_from_object[3][4];  ///< affine; the last column is where the origin goes
    float object_from_world[3][3];  ///< inverse of its linear part
    uint kind;                      ///< SHAPE_QUADRIC or SHAPE_JULIA
    uint material;
    uint light;       ///< index into the lights, NO_EMITTER when it emits nothing
    uint iterations;  ///< of a Julia set
    // Quadric: the surface a (x^2 + y^2) + b z^2 + c z + d = 0 with z in [z_lower, z_upper].
    // Julia set: its constant in (a, b, c, d), the fourth coordinate of the slice in z_lower, and
    // in z_upper the modulus from which iterates never come back, at least 4.
    float a, b, c, d;
    float z_lower, z_upper;
    float bound2;  ///< x^2 + y^2 + z^2 of the surface's points is at most this (which clips a disc)
    uint uv_kind;  ///< SHAPE_UV_*
    float error2;  ///< (16 u k)^2, k = |A|_F |M|_F of A = object_from_world and its inverse M:
                   ///< shape_space.h
    float padding[2];
} ShapeRecord;

#define SHAPE_QUADRIC 0u
#define SHAPE_JULIA 1u

#define SHAPE_UNBOUNDED 3.40282347e38f  ///< bound2 of a plane: the largest float

#define SHAPE_UV_SPHERE 0u
#define SHAPE_UV_HEIGHT 1u     ///< (phi, z)
#define SHAPE_UV_DEPTH 2u      ///< (phi, z + 1): the cone
#define SHAPE_UV_SYMMETRIC 3u  ///< (phi, (z + 1) / 2): the hyperboloid
#define SHAPE_UV_DISC 4u
#define SHAPE_UV_PLANE 5u
#define SHAPE_UV_NONE 6u

#define SHAPE_LANES 8u

/// Balls in world space around eight shapes, lane by lane (kernels/geometry/shape_bounds.h).
typedef struct ShapeBounds {
    float centre[3][SHAPE_LANES];  ///< where the origin of object space goes
    float bound2[SHAPE_LANES];     ///< more than the ball's squared radius; infinite for a plane
    float error2[SHAPE_LANES];     ///< by how much of its squared distance that grows: rounding
} ShapeBounds;

/// A light as the sampler sees it.
typedef struct LightRecord {
    float radiance[3];    ///< W / (sr m^2), W / sr or W / m^2 (LightArrays); environment: factor of
                          ///< the image
    float selection;      ///< probability that light selection takes this light, seen from a point
    uint selection_end;   ///< this light is taken by random words below this end (and not below its
                          ///< predecessor's)
    uint kind;            ///< LIGHT_*
    uint first_triangle;  ///< mesh: its range of emitter triangles. Shape: index of the shape
    uint triangle_count;
    float axis_x[3];  ///< x, y and z axes of light space, unit
    float area;       ///< of a shape
    float axis_y[3];
    float versine_outer;  ///< of a spot: 1 - cos(outer angle)
    float axis_z[3];
    float versine_range;  ///< of a spot: cos(inner angle) - cos(outer angle)
    float position[3];
    float outer_angle;         ///< of a spot, radians
    float angle_scale;         ///< of a spot: 1 / (outer angle - inner angle)
    float emission_selection;  ///< probability that a light path starts here
    float padding[2];
} LightRecord;

#define LIGHT_MESH 0u
#define LIGHT_DISC 1u
#define LIGHT_SPHERE 2u          ///< sampled by the cone it subtends
#define LIGHT_SPHERE_BY_AREA 3u  ///< sampled uniformly by area, as the thesis does
#define LIGHT_POINT 4u
#define LIGHT_SPOT 5u
#define LIGHT_DIRECTIONAL 6u  ///< from here on: at infinity
#define LIGHT_DOME 7u
#define LIGHT_ENVIRONMENT 8u

/// What the lights have in common.
typedef struct LightingRecord {
    uint light_count;
    uint infinite_light;     ///< index of the one light at infinity, NO_EMITTER for none
    float far_distance;      ///< a shadow ray of that length leaves the scene
    uint environment_width;  ///< texels
    uint environment_height;
    float scene_radius;     ///< of a sphere around all bounded surfaces, with a margin; positive
    float scene_centre[3];  ///< of that sphere
    uint plane_end;         ///< from this index on no shape is a plane
    uint padding[2];
} LightingRecord;

/// `chosen` of stage sample_light: the light is selected at random.
#define SELECT_LIGHT 0xffffffffu

/// A triangle of a mesh light.
typedef struct EmitterTriangle {
    uint triangle;       ///< scene triangle
    uint light;          ///< index of its light
    uint selection_end;  ///< as in LightRecord, within its light
    float pdf_a;         ///< density per area of a point on it, its light given
} EmitterTriangle;

#ifndef __OPENCL_VERSION__
static_assert(sizeof(CameraRecord) == 96, "layout shared with the device");
static_assert(sizeof(SurfaceTriangle) == 64, "layout shared with the device");
static_assert(sizeof(MaterialRecord) == 16, "layout shared with the device");
static_assert(sizeof(BxdfRecord) == 64, "layout shared with the device");
static_assert(sizeof(TextureRecord) == 32, "layout shared with the device");
static_assert(sizeof(TriangleNormals) == 48, "layout shared with the device");
static_assert(sizeof(TriangleUv) == 24, "layout shared with the device");
static_assert(sizeof(ShapeRecord) == 144, "layout shared with the device");
static_assert(sizeof(ShapeBounds) == 160, "layout shared with the device");
static_assert(sizeof(LightRecord) == 112, "layout shared with the device");
static_assert(sizeof(LightingRecord) == 48, "layout shared with the device");
static_assert(sizeof(EmitterTriangle) == 16, "layout shared with the device");
#endif
