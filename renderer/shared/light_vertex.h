// SPDX-License-Identifier: MIT
// The vertices of light paths that full bidirectional path tracing keeps, declared once: layout,
// access and byte count derive from this table. The paths of the chunk of work under way have a row
// each, of `light_vertices` (IntegratorSettings); vertex i of it is the hit after i scattering
// events.
#pragma once

#include "compat.h"
#include "declare.h"
#include "path_state.h"
#include "word_place.h"

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
#define FIELD_WORDS(type, name) \
    VERTEX_##name, VERTEX_LAST_##name = VERTEX_##name + WORDS_##type - 1,
#define X(feature, type, name) WHEN(feature)(FIELD_WORDS(type, name))
    LIGHT_VERTEX_FIELDS(X)
#undef X
#undef FIELD_WORDS
        LIGHT_VERTEX_WORDS
};

typedef struct LightVertex {
#define FIELD_MEMBER(type, name) type name;
#define X(feature, type, name) WHEN(feature)(FIELD_MEMBER(type, name))
    LIGHT_VERTEX_FIELDS(X)
#undef X
#undef FIELD_MEMBER
} LightVertex;

/// The row of a path of the batch: its number among all of them, `paths` in every sample, within
/// the chunk. Camera paths and light paths of the same number share it.
DEVICE uint light_vertex_row(uint path, uint sample, uint paths, uint rows) {
    return (sample * paths + path) % rows;
}

/// Vertex `i` of the `per_path` in a row.
DEVICE WordPlace light_vertex_place(GLOBAL uint *vertex_words, uint rows, uint per_path, uint row,
                                    uint i) {
    return record_place(vertex_words, LIGHT_VERTEX_WORDS, rows, per_path, row, i);
}

DEVICE void clear_light_vertex(WordPlace place) {
    store_uint(place, VERTEX_hit_primitive, NO_VERTEX);
}
DEVICE bool has_light_vertex(WordPlace place) {
    return load_uint(place, VERTEX_hit_primitive) != NO_VERTEX;
}

DEVICE LightVertex load_light_vertex(WordPlace place) {
    LightVertex vertex;
#define FIELD_LOAD(type, name) vertex.name = load_##type(place, VERTEX_##name);
#define X(feature, type, name) WHEN(feature)(FIELD_LOAD(type, name))
    LIGHT_VERTEX_FIELDS(X)
#undef X
#undef FIELD_LOAD
    return vertex;
}

DEVICE void store_light_vertex(WordPlace place, LightVertex vertex) {
#define FIELD_STORE(type, name) store_##type(place, VERTEX_##name, vertex.name);
#define X(feature, type, name) WHEN(feature)(FIELD_STORE(type, name))
    LIGHT_VERTEX_FIELDS(X)
#undef X
#undef FIELD_STORE
}

#else

#include "features.h"

namespace rtrays {

/// 4-byte words of a vertex under a feature mask that has `vertex_joins`.
uint32_t light_vertex_words(FeatureMask mask);

}  // namespace rtrays

#endif
