// SPDX-License-Identifier: MIT
// The state of a path between stages, declared once: layout, accessors and byte count derive from
// this table. Word w of path `slot` lies at words[w * capacity + slot], so that neighbouring
// work-items read neighbouring words, or, with PATH_STATE_INTERLEAVED, at words[slot *
// PATH_STATE_WORDS + w], so that a CPU finds a path in two cache lines.
#pragma once

#include "compat.h"
#include "declare.h"

// X(feature, type, name): a field exists where its feature does. Types: uint, float, float3 (three
// words).
#define PATH_STATE_FIELDS(X)                                                                      \
    X(ALWAYS, uint, pixel)                   /* of a light path: its number within the sample */  \
    X(ALWAYS, uint, sample)                  /* index within the batch */                         \
    X(ALWAYS, uint, depth)                   /* scattering events so far */                       \
    X(ALWAYS, float3, ray_origin)            /* of the path's ray, then of its shadow ray */      \
    X(ALWAYS, float3, ray_direction)         /* unit; the path's ray */                           \
    X(FEATURE_from_camera, float3, radiance) /* gathered so far, W / (sr m^2) */                  \
    X(ALWAYS, uint, hit_primitive)           /* NO_HIT, a triangle, or SHAPE_BIT and a shape */   \
    X(ALWAYS, float, hit_u)                  /* barycentrics; of a shape: the point in its */     \
    X(ALWAYS, float, hit_v)                  /* object space */                                   \
    X(FEATURE_shapes, float, hit_w)                                                               \
    X(FEATURE_scattering, float3, throughput)                                                     \
    X(FEATURE_roulette_scale, float,                                                              \
      roulette_scale) /* throughput over this is what roulette goes by */                         \
    X(FEATURE_direction_density, float,                                                           \
      pdf_w) /* of ray_direction, per solid angle; INFINITY: delta */                             \
    X(FEATURE_light_strategy, float,                                                              \
      log_ratio) /* of densities along the path: kernels/light/mis.h */                           \
    X(FEATURE_arrival_density, float, log_arrival)  /* likewise, of the last ray */               \
    X(FEATURE_vertex_joins, float, log_strategies)  /* likewise, of all strategies */             \
    X(FEATURE_emission_density, uint, light)        /* where the path began */                    \
    X(FEATURE_branches, uint, pending)              /* vertices it will come back to: branch.h */ \
    X(FEATURE_shadow_rays, float3, shadow_vector)   /* from ray_origin to what is joined */       \
    X(FEATURE_shadow_rays, float3, shadow_radiance) /* added unless the way is blocked */         \
    X(FEATURE_from_light, uint, splat_pixel)        /* to which it is added */

/// Tells shapes from triangles in `hit_primitive`; NO_HIT has it too.
#define SHAPE_BIT 0x80000000u

#ifdef __OPENCL_VERSION__

// Where a word of a path lies in a stream of `capacity`.
#if PATH_STATE_INTERLEAVED
#define STREAM_WORD(capacity, slot, word) ((slot)*PATH_STATE_WORDS + (word))
#else
#define STREAM_WORD(capacity, slot, word) ((word) * (capacity) + (slot))
#endif

// A program whose work-items follow a path on their own (advance_path.h) keeps it in their own
// memory.
#ifndef PATH_STATES_PRIVATE
#define PATH_STATES_PRIVATE 0
#endif
#if PATH_STATES_PRIVATE
#define PATH_MEMORY PRIVATE
#else
#define PATH_MEMORY GLOBAL
#endif

#define WORDS_uint 1
#define WORDS_float 1
#define WORDS_float3 3

// Word offset of each field: an enumerator per field, stepping over the words of the fields before.
enum PathStateLayout {
#define FIELD_OFFSET(type, name) PATH_##name, PATH_LAST_##name = PATH_##name + WORDS_##type - 1,
#define X(feature, type, name) WHEN(feature)(FIELD_OFFSET(type, name))
    PATH_STATE_FIELDS(X)
#undef X
#undef FIELD_OFFSET
        PATH_STATE_WORDS
};

/// The path states of one stream.
typedef struct PathStates {
    PATH_MEMORY uint *words;
    uint capacity;
} PathStates;

#define PATH_WORD(paths, slot, word) (paths).words[STREAM_WORD((paths).capacity, slot, word)]

// Whether the stages ask ahead for what they will read of the next paths: where the words of a path
// lie together.
#define PREFETCHES (HAS_PREFETCH && PATH_STATE_INTERLEAVED && !PATH_STATES_PRIVATE)

/// Asks for a path's words ahead of their use.
DEVICE void prefetch_path(MAYBE_UNUSED PathStates paths, MAYBE_UNUSED uint slot) {
#if PREFETCHES
    for (uint word = 0u; word < PATH_STATE_WORDS; word += CACHE_LINE / 4u) {
        PREFETCH(&PATH_WORD(paths, slot, word));
    }
    PREFETCH(&PATH_WORD(paths, slot, PATH_STATE_WORDS - 1u));
#endif
}

/// The slot of the path that is entry i of a queue, in FOR_EACH_ENTRY, where `end` is i_end. Asks
/// for the path three entries on: on a CPU its words may be in another core's cache.
DEVICE uint path_at(MAYBE_UNUSED PathStates paths, GLOBAL const uint *queue, uint i,
                    MAYBE_UNUSED uint end) {
    prefetch_path(paths, queue[min(i + 3u, end - 1u)]);
    return queue[i];
}

// get_<name>(paths, slot) and set_<name>(paths, slot, value) for every field.
#define ACCESS_uint(name)                                             \
    DEVICE uint get_##name(PathStates paths, uint slot) {             \
        return PATH_WORD(paths, slot, PATH_##name);                   \
    }                                                                 \
    DEVICE void set_##name(PathStates paths, uint slot, uint value) { \
        PATH_WORD(paths, slot, PATH_##name) = value;                  \
    }
#define ACCESS_float(name)                                             \
    DEVICE float get_##name(PathStates paths, uint slot) {             \
        return as_float(PATH_WORD(paths, slot, PATH_##name));          \
    }                                                                  \
    DEVICE void set_##name(PathStates paths, uint slot, float value) { \
        PATH_WORD(paths, slot, PATH_##name) = as_uint(value);          \
    }
#define ACCESS_float3(name)                                                    \
    DEVICE float3 get_##name(PathStates paths, uint slot) {                    \
        return make_float3(as_float(PATH_WORD(paths, slot, PATH_##name)),      \
                           as_float(PATH_WORD(paths, slot, PATH_##name + 1)),  \
                           as_float(PATH_WORD(paths, slot, PATH_##name + 2))); \
    }                                                                          \
    DEVICE void set_##name(PathStates paths, uint slot, float3 value) {        \
        PATH_WORD(paths, slot, PATH_##name) = as_uint(value.x);                \
        PATH_WORD(paths, slot, PATH_##name + 1) = as_uint(value.y);            \
        PATH_WORD(paths, slot, PATH_##name + 2) = as_uint(value.z);            \
    }
#define X(feature, type, name) WHEN(feature)(ACCESS_##type(name))
PATH_STATE_FIELDS(X)
#undef X

#else

#include <string>
#include <vector>

#include "features.h"

namespace rtrays {

/// A field of the path state that exists under a feature mask.
struct PathStateField {
    std::string name;
    uint32_t words;  ///< of 4 bytes
};

std::vector<PathStateField> path_state_fields(FeatureMask mask);
uint32_t path_state_words(FeatureMask mask);

}  // namespace rtrays

#endif
