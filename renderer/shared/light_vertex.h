// SPDX-License-Identifier: MIT
// The vertices of light paths that full bidirectional path tracing stores.
//
// The table declares the record once: layout, access and size derive from it. Each path of the
// current chunk of work has a row of `light_vertices` vertices (IntegratorSettings). Vertex i of a
// row is the hit after i scattering events.
#pragma once

#include "compat.h"
#include "declare.h"
#include "path_state.h"
#include "word_place.h"

// X(feature, type, name), as in path_state.h. `hit_primitive` is NO_VERTEX if there is no vertex to
// connect. `direction` and `throughput` are those with which the path arrived. The logarithms are
// log2 of A and S at arrival (kernels/mis/bidirectional.h).
#define LIGHT_VERTEX_FIELDS(X)              \
    X(ALWAYS, uint, hit_primitive)          \
    X(ALWAYS, float, hit_u)                 \
    X(ALWAYS, float, hit_v)                 \
    X(FEATURE_shapes, float, hit_w)         \
    X(ALWAYS, float3, direction) /* unit */ \
    X(ALWAYS, float3, throughput)           \
    X(ALWAYS, float, log_inverse_arrival)   \
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
#define X(feature, type, name) type name;
    LIGHT_VERTEX_FIELDS(X)
#undef X
} LightVertex;

/// Returns the row of a path: its index among all paths of the batch, with `paths` paths per
/// sample, modulo the rows of a chunk. A camera path and the light path of the same index share a
/// row.
DEVICE uint light_vertex_row(uint path, uint sample, uint paths, uint rows) {
    return (sample * paths + path) % rows;
}

/// Returns the location of vertex `i` among the `per_path` vertices of a row.
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
#define FIELD_ABSENT(type, name) vertex.name = (type)(0);
#define X(feature, type, name) \
    WHEN(feature)(FIELD_LOAD(type, name)) UNLESS(feature)(FIELD_ABSENT(type, name))
    LIGHT_VERTEX_FIELDS(X)
#undef X
#undef FIELD_ABSENT
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

/// Returns the size of a light vertex, in words of 4 bytes, under a feature mask with
/// `vertex_connections`.
uint32_t light_vertex_words(FeatureMask mask);

}  // namespace rtrays

#endif
