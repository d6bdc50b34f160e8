// SPDX-License-Identifier: MIT
// The stack of vertices to which a camera path returns to follow components not followed yet.
//
// The table declares the record once, like that of light_vertex.h. A stack holds at most one vertex
// for each scattering event that its path may have.
#pragma once

#include "compat.h"
#include "declare.h"
#include "path_state.h"
#include "word_place.h"

// X(feature, type, name), as in path_state.h. `direction` and `throughput` are those with which the
// path arrived at the vertex.
#define BRANCH_FIELDS(X)                                      \
    X(ALWAYS, uint, hit_primitive)                            \
    X(ALWAYS, float, hit_u)                                   \
    X(ALWAYS, float, hit_v)                                   \
    X(FEATURE_shapes, float, hit_w)                           \
    X(ALWAYS, float3, direction) /* unit */                   \
    X(ALWAYS, float3, throughput)                             \
    X(ALWAYS, uint, depth)     /* scattering events before */ \
    X(ALWAYS, uint, component) /* index of the material's next component */

#ifdef __OPENCL_VERSION__

enum BranchLayout {
#define FIELD_WORDS(type, name) \
    BRANCH_##name, BRANCH_LAST_##name = BRANCH_##name + WORDS_##type - 1,
#define X(feature, type, name) WHEN(feature)(FIELD_WORDS(type, name))
    BRANCH_FIELDS(X)
#undef X
#undef FIELD_WORDS
        BRANCH_WORDS
};

typedef struct Branch {
#define X(feature, type, name) type name;
    BRANCH_FIELDS(X)
#undef X
} Branch;

DEVICE Branch load_branch(WordPlace place) {
    Branch branch;
#define FIELD_LOAD(type, name) branch.name = load_##type(place, BRANCH_##name);
#define FIELD_ABSENT(type, name) branch.name = (type)(0);
#define X(feature, type, name) \
    WHEN(feature)(FIELD_LOAD(type, name)) UNLESS(feature)(FIELD_ABSENT(type, name))
    BRANCH_FIELDS(X)
#undef X
#undef FIELD_ABSENT
#undef FIELD_LOAD
    return branch;
}

DEVICE void store_branch(WordPlace place, Branch branch) {
#define FIELD_STORE(type, name) store_##type(place, BRANCH_##name, branch.name);
#define X(feature, type, name) WHEN(feature)(FIELD_STORE(type, name))
    BRANCH_FIELDS(X)
#undef X
#undef FIELD_STORE
}

#else

#include "features.h"

namespace rtrays {

/// Returns the size of a branch vertex, in words of 4 bytes, under a feature mask with `branches`.
uint32_t branch_words(FeatureMask mask);

}  // namespace rtrays

#endif
