// SPDX-License-Identifier: MIT
// The paths at the entries of the active queue, for stages that shade hits, with prefetching on a
// CPU.
//
// Hits are scattered over the scene. A CPU processes the entries of a chunk one after the other, so
// it prefetches the data of the next entries. path_at prefetches the path three entries ahead. One
// entry later its triangle is known, and another entry later its texels.
#pragma once

#include "renderer/kernels/geometry/surface_hit.h"
#include "renderer/kernels/path/path_at.h"
#include "renderer/kernels/scene_view.h"
#include "renderer/kernels/stream.h"
#include "renderer/kernels/texture/texture.h"
#include "renderer/shared/path_state.h"

/// Prefetches a record, which may begin on one cache line and end on the next.
#define PREFETCH_RECORD(record) \
    PREFETCH(record);           \
    PREFETCH((GLOBAL const uint *)((record) + 1) - 1)

/// Prefetches the records that triangle_hit reads.
DEVICE void prefetch_triangle(PRIVATE const SceneView *scene, uint triangle) {
    PREFETCH_RECORD(scene->surface_triangles + triangle);
    if (FEATURE_smooth_normals) {
        PREFETCH_RECORD(scene->triangle_normals + triangle);
    }
    if (FEATURE_texture_coordinates) {
        PREFETCH_RECORD(scene->triangle_uvs + triangle);
    }
    if (FEATURE_vertex_colours) {
        PREFETCH_RECORD(scene->triangle_colours + triangle);
    }
}

/// Prefetches the texels of a lookup: the first of each row, next to which the second usually is.
DEVICE void prefetch_texture(GLOBAL const TextureRecord *texture, GLOBAL const uint *texels,
                             float2 uv) {
    const uint clamped = texture->flags & TEXTURE_CLAMP;
    const uint words = (texture->flags & TEXTURE_FLOAT) != 0u ? 3u : 1u;
    const float2 at = texture_position(texture, uv);
    const TexelPair columns = texel_pair(at.x, texture->width, clamped);
    const TexelPair rows = texel_pair(at.y, texture->height, clamped);
    GLOBAL const uint *column = texels + texture->first_word + words * columns.first;
    PREFETCH(column + words * rows.first * texture->width);
    PREFETCH(column + words * rows.second * texture->width);
}

/// Prefetches the texels that the components of a material read at `uv`.
DEVICE void prefetch_texels(PRIVATE const SceneView *scene, uint material, float2 uv) {
    GLOBAL const BxdfRecord *component =
        scene->components + scene->materials[material].first_component;
    GLOBAL const BxdfRecord *end = component + scene->materials[material].component_count;
    for (; component < end; ++component) {
        if (component->texture != NO_TEXTURE) {
            prefetch_texture(scene->textures + component->texture, scene->texels, uv);
        }
        if (FEATURE_roughness_textures && (component->flags & BXDF_FLAG_ROUGHNESS_TEXTURE) != 0u) {
            prefetch_texture(scene->textures + component->coat_or_roughness, scene->texels, uv);
        }
    }
    if (FEATURE_normal_maps && (scene->materials[material].flags & MATERIAL_MAPPED) != 0u) {
        GLOBAL const NormalMapRecord *map =
            scene->normal_maps + scene->materials[material].normal_map;
        prefetch_texture(scene->textures + map->texture, scene->texels, uv);
    }
}

/// Returns the active path at entry i, for a stage that reads the hit primitive.
DEVICE Path hit_path_at(PRIVATE const SceneView *scene, Stream stream, uint i, uint end) {
    GLOBAL const uint *queue = active_queue(stream);
    if (PREFETCHES && FEATURE_triangles) {
        const uint triangle = get_hit_primitive(path_in(stream, queue[min(i + 2u, end - 1u)]));
        if ((triangle & SHAPE_BIT) == 0u) {
            prefetch_triangle(scene, triangle);
        }
    }
    return path_at(stream, queue, i, end);
}

/// Returns the active path at entry i, for a stage that evaluates the material of the hit.
DEVICE Path shaded_path_at(PRIVATE const SceneView *scene, Stream stream, uint i, uint end) {
    if (PREFETCHES && FEATURE_triangles && FEATURE_textures && FEATURE_scattering) {
        const Path next = path_in(stream, active_queue(stream)[min(i + 1u, end - 1u)]);
        const uint triangle = get_hit_primitive(next);
        if ((triangle & SHAPE_BIT) == 0u) {
            const SurfaceHit hit = triangle_hit(scene, triangle, get_hit_u(next), get_hit_v(next));
            prefetch_texels(scene, hit.material, hit.uv);
        }
    }
    return hit_path_at(scene, stream, i, end);
}
