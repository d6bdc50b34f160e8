// SPDX-License-Identifier: MIT
// Vertices to which a camera path comes back to follow components that are left, declared once as
// in light_vertex.h. Each path has a stack of them, at most one for every scattering event that a
// path may have.
#pragma once

#include "compat.h"
#include "declare.h"
#include "path_state.h"
#include "word_place.h"

// X(feature, type, name), as in path_state.h.
#define BRANCH_FIELDS(X)                                                \
    X(ALWAYS, uint, hit_primitive)                                      \
    X(ALWAYS, float, hit_u)                                             \
    X(ALWAYS, float, hit_v)                                             \
    X(FEATURE_shapes, float, hit_w)                                     \
    X(ALWAYS, float3, direction)  /* unit, in which the path arrived */ \
    X(ALWAYS, float3, throughput) /* with which it did */               \
    X(ALWAYS, uint, depth)        /* scattering events before */        \
    X(ALWAYS, uint, component)    /* of the material: the next */

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
#define FIELD_MEMBER(type, name) type name;
#define X(feature, type, name) WHEN(feature)(FIELD_MEMBER(type, name))
    BRANCH_FIELDS(X)
#undef X
#undef FIELD_MEMBER
} Branch;

DEVICE Branch load_branch(WordPlace place) {
    Branch branch;
#define FIELD_LOAD(type, name) branch.name = load_##type(place, BRANCH_##name);
#define X(feature, type, name) WHEN(feature)(FIELD_LOAD(type, name))
    BRANCH_FIELDS(X)
#undef X
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

/// 4-byte words of such a vertex under a feature mask that has `branches`.
uint32_t branch_words(FeatureMask mask);

}  // namespace rtrays

#endif
