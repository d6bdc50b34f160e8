// SPDX-License-Identifier: MIT
// Scene records in the layout that the device reads, written by the scene compiler. They consist of
// plain words only, without float3.
#pragma once

#include "compat.h"

#define NO_EMITTER 0xffffffffu

/// A perspective camera (pinhole or thin lens) or an orthographic one. The ray through film
/// position (x, y), in pixels from the top left corner, has the direction corner + x * step_x + y *
/// step_y before normalisation. The ray of an orthographic camera begins there, relative to the
/// position.
typedef struct CameraRecord {
    float position[3];
    /// Area of a pixel on the plane at unit distance along the axis; orthographic: of the film.
    float pixel_area;
    float corner[3];
    uint width;  ///< of the film, pixels
    float step_x[3];
    uint height;  ///< pixels
    float step_y[3];
    float aperture_radius;  ///< radius of the lens; 0 for a pinhole
    float axis_x[3];        ///< unit, to the right
    float focus_distance;   ///< distance of the plane in focus, along the axis
    float axis_y[3];        ///< unit, up
    /// Distance from the lens at which camera rays begin; 0 unless the camera is far from the scene
    /// (compile_scene.h). Nothing is nearer to the lens. Float could not resolve the scene in
    /// coordinates of the lens.
    float start_distance;
    float start[3];         ///< position + start_distance * forward, rounded after the sum
    uint orthographic;      ///< 1: all rays have the direction of the axis; otherwise 0
    float start_corner[3];  ///< `corner` without its component along the axis
    uint crop_x;            ///< column of the full picture with which the film begins
    uint crop_y;            ///< row of the full picture with which the film begins
    /// Size of the full picture in pixels. Film positions are those of the full picture.
    uint full_width, full_height;
    uint padding;
} CameraRecord;

/// Triangle data for shading, in the scene's triangle order.
typedef struct SurfaceTriangle {
    float p0[3];
    uint material;
    float p1[3];
    uint emitter;  ///< index of its emitter triangle; NO_EMITTER if it emits nothing
    float p2[3];
    float extent;  ///< largest side of the box around its edges, in scene units
    /// Unit, on the side from which p0, p1, p2 run counter-clockwise; zero if degenerate.
    float normal[3];
    float padding;
} SurfaceTriangle;

/// A material: the range of its components, and flags that apply to all of them.
typedef struct MaterialRecord {
    uint first_component;
    uint component_count;
    uint flags;       ///< MATERIAL_*
    uint normal_map;  ///< index of its NormalMapRecord, if MATERIAL_MAPPED
} MaterialRecord;

/// Refracts: the indices of refraction on its two sides differ, so its sides are distinguished.
#define MATERIAL_BOUNDARY 1u
#define MATERIAL_ONE_SIDED 2u  ///< black from behind
/// All components are deltas: the material cannot be connected to a light.
#define MATERIAL_DELTA 4u
#define MATERIAL_TURNS 8u    ///< anisotropic: its appearance depends on the tangent
#define MATERIAL_MAPPED 16u  ///< a map tilts its shading normals
#define MATERIAL_GUIDED 32u  ///< camera paths may be guided there: opaque, with a diffuse component
/// Reflects by one Lambert component alone, without a Fresnel term or a map of normals.
#define MATERIAL_LAMBERT 64u

/// One atomic BxDF of a material (renderer/scene/stores.h describes each).
typedef struct BxdfRecord {
    uint kind;     ///< BXDF_*
    uint flags;    ///< FRESNEL_*, BXDF_FLAG_*, and above BXDF_MIX_SHIFT the mixture
    uint texture;  ///< index of the texture, or NO_TEXTURE
    /// Sigma for BXDF_OREN_NAYAR, exponent for BXDF_BLINN, and for BXDF_COATED_LAMBERT the share of
    /// light from below that the coat reflects back and that takes the colour of the base;
    /// roughness for BXDF_DISNEY_DIFFUSE.
    float parameter;
    float weight[3];
    float alpha_x;  ///< roughness along the tangent
    /// Fresnel term: relative index of refraction (dielectric: [0], thin plate: [1]) or normal
    /// reflectance (Schlick)
    float eta[3];
    float alpha_y;  ///< roughness across the tangent
    /// Extinction coefficient of a conductor; BXDF_COATED_LAMBERT: factor of the colour
    /// (kernels/bsdf/coat.h); BXDF_DISNEY_DIFFUSE: flatness
    float k[3];
    /// BXDF_COATED_LAMBERT, if rough: first of its COAT_NODES transmittances. With
    /// BXDF_FLAG_ROUGHNESS_TEXTURE: index of that texture
    uint coat_or_roughness;
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
#define BXDF_COATED_LAMBERT 9u
#define BXDF_DISNEY_DIFFUSE 10u
#define BXDF_DISNEY_SHEEN 11u
#define BXDF_DISNEY_CLEARCOAT 12u

#define LEAST_ALPHA 1e-4f  ///< alpha where a texture scales it to less (renderer/scene/stores.h)

#define COAT_NODES 128u  ///< transmittances of a rough coat, at cosines (i / (COAT_NODES - 1))^2

#define FRESNEL_MASK 7u
#define FRESNEL_IDEAL 0u
#define FRESNEL_DIELECTRIC 1u
#define FRESNEL_CONDUCTOR 2u
#define FRESNEL_CONDUCTOR_APPROXIMATE 3u
#define FRESNEL_SCHLICK 4u
#define FRESNEL_THIN_DIELECTRIC 5u
#define BXDF_FLAG_COMPLEMENT 8u           ///< uses 1 - F instead of F
#define BXDF_FLAG_FRESNEL_OF_WO 16u       ///< Fresnel term of wo alone: not symmetric in wi and wo
#define BXDF_FLAG_BECKMANN 32u            ///< Beckmann distribution, otherwise GGX
#define BXDF_FLAG_FRONT_ONLY 64u          ///< black from behind
#define BXDF_FLAG_BACK_ONLY 128u          ///< black from the front
#define BXDF_FLAG_ROUGHNESS_TEXTURE 256u  ///< the luminance of a texture scales the roughness
#define BXDF_FLAG_ROUGHNESS_SQUARED 512u  ///< its square scales alpha
/// The bits from here on are 1 plus the index of the component's MixRecord, or 0.
#define BXDF_MIX_SHIFT 12u

/// The share of a component in a mixture: offset + scale * the luminance of a texture.
typedef struct MixRecord {
    uint texture;  ///< index of the texture
    float offset;
    float scale;
    uint padding;
} MixRecord;

/// A texture: a range of the texel buffer. 8-bit texels have one word each, with R in the lowest
/// byte; float texels have three words.
typedef struct TextureRecord {
    uint first_word;
    uint width;
    uint height;
    uint flags;  ///< TEXTURE_*
    float uv_scale[2];
    float uv_offset[2];
} TextureRecord;

#define TEXTURE_FLOAT 1u  ///< float texels, otherwise 8 bits per channel
#define TEXTURE_SRGB 2u
#define TEXTURE_BILINEAR 4u  ///< bilinear lookup, otherwise nearest
#define TEXTURE_CLAMP 8u     ///< clamped coordinates, otherwise repeated
/// Mirrored coordinates. Comes with TEXTURE_CLAMP, because the neighbours at an edge are the same.
#define TEXTURE_MIRROR 16u
#define TEXTURE_VERTEX_COLOURS 32u  ///< the colours of vertices multiply its texels

/// A map of normals or heights (kernels/bsdf/normal_map.h).
typedef struct NormalMapRecord {
    uint texture;  ///< index of its texture
    float scale;   ///< factor of the heights, or of x and y of the normals
    uint flags;    ///< NORMAL_MAP_*
    uint padding;
} NormalMapRecord;

#define NORMAL_MAP_HEIGHTS 1u        ///< heights, otherwise normals
#define NORMAL_MAP_SHADOWING 2u      ///< shadows light at grazing angles
#define NORMAL_MAP_FOLLOWS_V 4u      ///< y is along dp/dv, otherwise along the normal times dp/du
#define NORMAL_MAP_MIRRORED_BACK 8u  ///< the back looks like the front

/// The opacity of a material (kernels/traversal/opacity.h).
typedef struct OpacityRecord {
    /// Its texels are floats, one word each, in `opacity_texels`. Its width is 0 if the opacity has
    /// no texture.
    TextureRecord texture;
    float opacity;  ///< factor of the texture
    /// Opacities from here on count as 1 and lower ones as 0. If 0, the opacity is the share of
    /// rays that are stopped.
    float cutoff;
    uint padding[2];
} OpacityRecord;

#define OPAQUE 0xffffffffu

/// A triangle whose material is not opaque.
typedef struct MaskedTriangle {
    float uv[3][2];  ///< texture coordinates of the corners
    uint opacity;    ///< index of its OpacityRecord
    uint padding;
} MaskedTriangle;

/// Shading normals and texture coordinates of a triangle's corners. Each has its own buffer, which
/// exists only if a feature reads it.
typedef struct TriangleNormals {
    float normal[3][3];
    uint is_smooth;  ///< 0: the geometric normal applies, and `normal` is undefined
    uint padding[2];
} TriangleNormals;
typedef struct TriangleUv {
    float uv[3][2];
} TriangleUv;

/// Linear colours of a triangle's corners.
typedef struct TriangleColours {
    float colour[3][3];
} TriangleColours;

/// A surface that is not made of triangles, in the object space of ShapeArrays
/// (renderer/scene/stores.h). The cone differs: here its apex is the origin.
typedef struct ShapeRecord {
    float world_from_object[3][4];  ///< affine; the last column is the image of the origin
    float object_from_world[3][3];  ///< inverse of the linear part of world_from_object
    uint kind;                      ///< SHAPE_QUADRIC or SHAPE_JULIA
    uint material;
    uint light;       ///< index of its light; NO_EMITTER if it emits nothing
    uint iterations;  ///< number of iterations of a Julia set
    // Quadric: the surface a (x^2 + y^2) + b z^2 + c z + d = 0 with z in [z_lower, z_upper]. Julia
    // set: (a, b, c, d) is its constant and z_lower the fourth coordinate of the slice. z_upper is
    // the modulus, at least 4, beyond which iterates never return.
    float a, b, c, d;
    float z_lower, z_upper;
    float bound2;  ///< upper bound of x^2 + y^2 + z^2 on the surface; it also clips a disc
    uint uv_kind;  ///< SHAPE_UV_*
    /// (16 u k)^2 with k = |A|_F |M|_F, A = object_from_world and M its inverse (shape_space.h).
    float error2;
    uint opacity;  ///< index of its OpacityRecord, or OPAQUE
    float padding;
} ShapeRecord;

#define SHAPE_QUADRIC 0u
#define SHAPE_JULIA 1u

#define SHAPE_UNBOUNDED 3.40282347e38f  ///< bound2 of a plane: the largest float

#define SHAPE_UV_SPHERE 0u
#define SHAPE_UV_HEIGHT 1u     ///< (phi, z)
#define SHAPE_UV_DEPTH 2u      ///< (phi, z + 1), for the cone
#define SHAPE_UV_SYMMETRIC 3u  ///< (phi, (z + 1) / 2), for the hyperboloid
#define SHAPE_UV_DISC 4u
#define SHAPE_UV_PLANE 5u
#define SHAPE_UV_NONE 6u

#define SHAPE_LANES 8u

/// Bounding balls of eight shapes in world space, one per lane (kernels/geometry/shape_bounds.h).
typedef struct ShapeBounds {
    float centre[3][SHAPE_LANES];  ///< image of the origin of object space
    /// An upper bound of the ball's squared radius; infinite for a plane.
    float bound2[SHAPE_LANES];
    float error2[SHAPE_LANES];  ///< growth of bound2 per squared distance of the ray, for rounding
} ShapeBounds;

/// A light in the form that light sampling reads.
typedef struct LightRecord {
    /// W / (sr m^2), W / sr or W / m^2 (LightArrays); environment: factor of the image.
    float radiance[3];
    float selection;  ///< probability that light sampling at a point selects this light
    /// This light is selected by random words below this end and not below its predecessor's end.
    uint selection_end;
    uint kind;            ///< LIGHT_*
    uint first_triangle;  ///< mesh: first of its emitter triangles; shape: index of the shape
    uint triangle_count;
    /// x, y and z axes of light space, unit. Of discs and meshes: axes about the normal of the disc
    /// or of the largest triangle.
    float axis_x[3];
    float area;  ///< area of a shape
    float axis_y[3];
    float versine_outer;  ///< spot: 1 - cos(outer angle)
    float axis_z[3];
    float versine_range;  ///< spot: cos(inner angle) - cos(outer angle)
    float position[3];
    float outer_angle;         ///< spot: in radians
    float angle_scale;         ///< spot: 1 / (outer angle - inner angle)
    float emission_selection;  ///< probability that a light path starts here
    uint texture;              ///< area lights: index of the factor of `radiance`, or NO_TEXTURE
    /// First word of its table in the emission guide, or NO_GUIDE_TABLE. `light_at` sets it
    /// (kernels/light/emission_guide.h); in memory it is 0.
    uint guide_table;
} LightRecord;

#define LIGHT_MESH 0u
#define LIGHT_DISC 1u
#define LIGHT_SPHERE 2u          ///< sampled uniformly in the cone that it subtends
#define LIGHT_SPHERE_BY_AREA 3u  ///< sampled uniformly by area, as the thesis does
#define LIGHT_POINT 4u
#define LIGHT_SPOT 5u
#define LIGHT_DIRECTIONAL 6u  ///< the kinds from here on are at infinity
#define LIGHT_DOME 7u
#define LIGHT_ENVIRONMENT 8u

/// Data that the lights share.
typedef struct LightingRecord {
    uint light_count;
    uint infinite_light;     ///< index of the single light at infinity; NO_EMITTER if there is none
    float far_distance;      ///< a shadow ray of this length leaves the scene
    uint environment_width;  ///< texels
    uint environment_height;
    /// Radius of a sphere around all bounded surfaces, with a margin; positive.
    float scene_radius;
    float scene_centre[3];        ///< centre of that sphere
    uint plane_end;               ///< no shape from this index on is a plane
    float camera_start_distance;  ///< CameraRecord::start_distance
    uint orthographic_camera;     ///< CameraRecord::orthographic
} LightingRecord;

/// Value of `light_index` by which stage sample_light selects a light at random.
#define SELECT_LIGHT 0xffffffffu

/// A triangle of a mesh light.
typedef struct EmitterTriangle {
    uint triangle;       ///< index of the scene triangle
    uint light;          ///< index of its light
    uint selection_end;  ///< as in LightRecord, among the triangles of its light
    float pdf_a;         ///< conditional density per area of a point on it, given its light
} EmitterTriangle;

#ifndef __OPENCL_VERSION__
static_assert(sizeof(CameraRecord) == 144, "layout shared with the device");
static_assert(sizeof(SurfaceTriangle) == 64, "layout shared with the device");
static_assert(sizeof(MaterialRecord) == 16, "layout shared with the device");
static_assert(sizeof(MixRecord) == 16, "layout shared with the device");
static_assert(sizeof(BxdfRecord) == 64, "layout shared with the device");
static_assert(sizeof(TextureRecord) == 32, "layout shared with the device");
static_assert(sizeof(NormalMapRecord) == 16, "layout shared with the device");
static_assert(sizeof(OpacityRecord) == 48, "layout shared with the device");
static_assert(sizeof(MaskedTriangle) == 32, "layout shared with the device");
static_assert(sizeof(TriangleNormals) == 48, "layout shared with the device");
static_assert(sizeof(TriangleUv) == 24, "layout shared with the device");
static_assert(sizeof(TriangleColours) == 36, "layout shared with the device");
static_assert(sizeof(ShapeRecord) == 144, "layout shared with the device");
static_assert(sizeof(ShapeBounds) == 160, "layout shared with the device");
static_assert(sizeof(LightRecord) == 112, "layout shared with the device");
static_assert(sizeof(LightingRecord) == 48, "layout shared with the device");
static_assert(sizeof(EmitterTriangle) == 16, "layout shared with the device");
#endif
