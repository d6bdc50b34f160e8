// SPDX-License-Identifier: MIT
// The vertices of light paths that full bidirectional path tracing keeps, declared once: layout, access and
// byte count derive from this table. The paths of the chunk of work under way have a row each, of
// `light_vertices` (IntegratorSettings); vertex i of it is the hit after i scattering events.
#pragma once

#include "compat.h"
#include "declare.h"
#include "path_state.h"

// X(feature, type, name), as in path_state.h.
#define LIGHT_VERTEX_FIELDS(X)                                                         \
    X(ALWAYS, uint, hit_primitive) /* NO_VERTEX: nothing there that could be joined */ \
    X(ALWAYS, float, hit_u)                                                            \
    X(ALWAYS, float, hit_v)                                                            \
    X(FEATURE_shapes, float, hit_w)                                                    \
    X(ALWAYS, float3, direction)  /* unit, in which the path arrived */                \
    X(ALWAYS, float3, throughput) /* with which it did */                              \
    X(ALWAYS, float, log_arrival) /* kernels/light/mis.h */                            \
    X(ALWAYS, float, log_strategies)

#define NO_VERTEX 0xffffffffu

#ifdef __OPENCL_VERSION__

enum LightVertexLayout {
#define FIELD_WORDS(type, name) VERTEX_##name, VERTEX_LAST_##name = VERTEX_##name + WORDS_##type - 1,
#define X(feature, type, name) WHEN(feature, FIELD_WORDS(type, name))
    LIGHT_VERTEX_FIELDS(X)
#undef X
#undef FIELD_WORDS
        LIGHT_VERTEX_WORDS
};

typedef struct LightVertex {
#define FIELD_MEMBER(type, name) type name;
#define X(feature, type, name) WHEN(feature, FIELD_MEMBER(type, name))
    LIGHT_VERTEX_FIELDS(X)
#undef X
#undef FIELD_MEMBER
} LightVertex;

/// Where a vertex lies: word w at first[w * stride]. The words of a vertex lie together where those of a path
/// do.
typedef struct LightVertexPlace {
    GLOBAL uint *first;
    ulong stride;
} LightVertexPlace;

/// The row of a path of the batch: its number among all of them, `paths` in every sample, within the chunk.
/// Camera paths and light paths of the same number share it.
DEVICE uint light_vertex_row(uint path, uint sample, uint paths, uint rows) {
    return (sample * paths + path) % rows;
}

/// Vertex `i` of the `per_path` in a row. More words than 2^32 are possible.
DEVICE LightVertexPlace light_vertex_place(GLOBAL uint *vertex_words, uint rows, uint per_path, uint row,
                                           uint i) {
    LightVertexPlace place;
#if PATH_STATE_INTERLEAVED
    place.first = vertex_words + ((ulong)row * per_path + i) * LIGHT_VERTEX_WORDS;
    place.stride = 1;
    (void)rows;
#else
    place.first = vertex_words + (ulong)i * LIGHT_VERTEX_WORDS * rows + row;
    place.stride = rows;
    (void)per_path;
#endif
    return place;
}

DEVICE void clear_light_vertex(LightVertexPlace place) {
    place.first[VERTEX_hit_primitive * place.stride] = NO_VERTEX;
}
DEVICE bool has_light_vertex(LightVertexPlace place) {
    return place.first[VERTEX_hit_primitive * place.stride] != NO_VERTEX;
}

DEVICE float load_vertex_float(LightVertexPlace place, uint word) {
    return as_float(place.first[word * place.stride]);
}
DEVICE void store_vertex_float(LightVertexPlace place, uint word, float value) {
    place.first[word * place.stride] = as_uint(value);
}

#define LOAD_uint(name) vertex.name = place.first[VERTEX_##name * place.stride];
#define LOAD_float(name) vertex.name = load_vertex_float(place, VERTEX_##name);
#define LOAD_float3(name)                                                                                 \
    vertex.name =                                                                                         \
        make_float3(load_vertex_float(place, VERTEX_##name), load_vertex_float(place, VERTEX_##name + 1), \
                    load_vertex_float(place, VERTEX_##name + 2));
DEVICE LightVertex load_light_vertex(LightVertexPlace place) {
    LightVertex vertex;
#define X(feature, type, name) WHEN(feature, LOAD_##type(name))
    LIGHT_VERTEX_FIELDS(X)
#undef X
    return vertex;
}

#define STORE_uint(name) place.first[VERTEX_##name * place.stride] = vertex.name;
#define STORE_float(name) store_vertex_float(place, VERTEX_##name, vertex.name);
#define STORE_float3(name)                                       \
    store_vertex_float(place, VERTEX_##name, vertex.name.x);     \
    store_vertex_float(place, VERTEX_##name + 1, vertex.name.y); \
    store_vertex_float(place, VERTEX_##name + 2, vertex.name.z);
DEVICE void store_light_vertex(LightVertexPlace place, LightVertex vertex) {
#define X(feature, type, name) WHEN(feature, STORE_##type(name))
    LIGHT_VERTEX_FIELDS(X)
#undef X
}

#else

#include "features.h"

namespace rtrays {

/// 4-byte words of a vertex under a feature mask that has `vertex_joins`.
uint32_t light_vertex_words(FeatureMask mask);

}  // namespace rtrays

#endif
