// SPDX-License-Identifier: MIT
// The state of a path between stages.
//
// The table declares it once: layout, accessors and size derive from it. Word w of path `slot` is
// at words[w * capacity + slot], so that neighbouring work-items read neighbouring words. With
// PATH_STATE_INTERLEAVED it is at words[slot * PATH_STATE_WORDS + w], so that a CPU finds a path in
// two cache lines.
#pragma once

#include "compat.h"
#include "declare.h"
#include "hit_primitive.h"
#include "light_path_trials.h"

// X(feature, type, name): a field exists if its feature is on. Types are uint, float, float3 (three
// words) and trials (a float for each trial). (hit_u, hit_v) are the barycentrics of a triangle;
// (hit_u, hit_v, hit_w) is the hit on a shape in its object space. kernels/mis/truncated.h defines
// R (camera paths) and Q (light paths), kernels/mis/bidirectional.h defines A and S.
#define PATH_STATE_FIELDS(X)                                                                      \
    X(ALWAYS, uint, pixel)                   /* light path: index within the sample */            \
    X(ALWAYS, uint, sample)                  /* index within the batch */                         \
    X(ALWAYS, uint, depth)                   /* scattering events so far */                       \
    X(ALWAYS, float3, ray_origin)            /* of the path's ray, then of its shadow ray */      \
    X(ALWAYS, float3, ray_direction)         /* unit; the path's ray */                           \
    X(FEATURE_from_camera, float3, radiance) /* accumulated so far, W / (sr m^2) */               \
    X(ALWAYS, uint, hit_primitive)           /* NO_HIT, a triangle, or SHAPE_BIT and a shape */   \
    X(ALWAYS, float, hit_u)                                                                       \
    X(ALWAYS, float, hit_v)                                                                       \
    X(FEATURE_shapes, float, hit_w)                                                               \
    X(FEATURE_scattering, float3, throughput)                                                     \
    X(FEATURE_roulette_scale, float, roulette_scale)    /* roulette uses throughput over this */  \
    X(FEATURE_direction_density, float, pdf_w)          /* per solid angle; INFINITY: delta */    \
    X(FEATURE_light_strategy, float, log_running_ratio) /* log2 R or log2 Q */                    \
    X(FEATURE_arrival_density, float, log_inverse_arrival) /* log2 A at the hit */                \
    X(FEATURE_vertex_connections, float, log_strategies)   /* log2 S at the last event */         \
    X(FEATURE_emission_density, uint, light)               /* index of the light at the start */  \
    X(FEATURE_branches, uint, pending)                     /* size of the stack of branch.h */    \
    X(FEATURE_shadow_origin, float3, shadow_origin)        /* else it is ray_origin */            \
    X(FEATURE_shadow_rays, float3, shadow_vector)          /* from its origin to the other end */ \
    X(FEATURE_shadow_rays, float3, shadow_radiance)        /* added unless the ray is blocked */  \
    X(FEATURE_from_light, uint, splat_pixel)               /* pixel to which it is added */       \
    X(FEATURE_light_path_trials, uint, trial_item)         /* index of the path in the work */    \
    X(FEATURE_light_path_trials, uint, trial_start)        /* PathTrials::start */                \
    X(FEATURE_light_path_trials, float, trial_density)     /* PathTrials::start_density */        \
    X(FEATURE_light_path_trials, float, trial_ratio)       /* log2 Q without explicit paths */    \
    X(FEATURE_light_path_trials, trials, trial_value)      /* shared/light_path_trials.h */       \
    X(FEATURE_light_path_trials, trials, shadow_trial)     /* added unless the ray is blocked */

#ifdef __OPENCL_VERSION__

// Index of a word of a path in a stream of `capacity` slots.
#if PATH_STATE_INTERLEAVED
#define STREAM_WORD(capacity, slot, word) ((slot)*PATH_STATE_WORDS + (word))
#else
#define STREAM_WORD(capacity, slot, word) ((word) * (capacity) + (slot))
#endif

// A program whose work-items each follow one path (kernels/path/advance.h) keeps the path in
// private memory.
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
#define WORDS_trials LIGHT_PATH_TRIALS

// Word offsets of the fields: one enumerator per field, which skips the words of the fields before
// it.
enum PathStateLayout {
#define FIELD_OFFSET(type, name) PATH_##name, PATH_LAST_##name = PATH_##name + WORDS_##type - 1,
#define X(feature, type, name) WHEN(feature)(FIELD_OFFSET(type, name))
    PATH_STATE_FIELDS(X)
#undef X
#undef FIELD_OFFSET
        PATH_STATE_WORDS
};

/// A path in flight: the handle through which stages read and write its state.
typedef struct Path {
    PATH_MEMORY uint *words;
    uint capacity;  ///< number of paths in `words`
    uint slot;      ///< index of the path
} Path;

#define PATH_WORD(path, word) (path).words[STREAM_WORD((path).capacity, (path).slot, word)]

// Whether the stages prefetch what they will read for the next paths. It pays where the words of a
// path are contiguous.
#define PREFETCHES (HAS_PREFETCH && PATH_STATE_INTERLEAVED && !PATH_STATES_PRIVATE)

// get_<name>(path) and set_<name>(path, value) for every field; those of trials have the trial as
// second parameter. Without the field's feature there is no word: get returns 0 and set does
// nothing.
#define ACCESS_uint(name)                           \
    DEVICE uint get_##name(Path path) {             \
        return PATH_WORD(path, PATH_##name);        \
    }                                               \
    DEVICE void set_##name(Path path, uint value) { \
        PATH_WORD(path, PATH_##name) = value;       \
    }
#define ACCESS_float(name)                             \
    DEVICE float get_##name(Path path) {               \
        return as_float(PATH_WORD(path, PATH_##name)); \
    }                                                  \
    DEVICE void set_##name(Path path, float value) {   \
        PATH_WORD(path, PATH_##name) = as_uint(value); \
    }
#define ACCESS_float3(name)                                             \
    DEVICE float3 get_##name(Path path) {                               \
        return make_float3(as_float(PATH_WORD(path, PATH_##name)),      \
                           as_float(PATH_WORD(path, PATH_##name + 1)),  \
                           as_float(PATH_WORD(path, PATH_##name + 2))); \
    }                                                                   \
    DEVICE void set_##name(Path path, float3 value) {                   \
        PATH_WORD(path, PATH_##name) = as_uint(value.x);                \
        PATH_WORD(path, PATH_##name + 1) = as_uint(value.y);            \
        PATH_WORD(path, PATH_##name + 2) = as_uint(value.z);            \
    }
#define ACCESS_trials(name)                                      \
    DEVICE float get_##name(Path path, uint trial) {             \
        return as_float(PATH_WORD(path, PATH_##name + trial));   \
    }                                                            \
    DEVICE void set_##name(Path path, uint trial, float value) { \
        PATH_WORD(path, PATH_##name + trial) = as_uint(value);   \
    }
#define ACCESS_NO_FIELD(type, name)                              \
    DEVICE type get_##name(MAYBE_UNUSED Path path) {             \
        return (type)(0);                                        \
    }                                                            \
    DEVICE void set_##name(MAYBE_UNUSED Path path, type value) { \
        (void)value;                                             \
    }
#define ACCESS_NO_uint(name) ACCESS_NO_FIELD(uint, name)
#define ACCESS_NO_float(name) ACCESS_NO_FIELD(float, name)
#define ACCESS_NO_float3(name) ACCESS_NO_FIELD(float3, name)
#define ACCESS_NO_trials(name)                                                             \
    DEVICE float get_##name(MAYBE_UNUSED Path path, MAYBE_UNUSED uint trial) {             \
        return 0.0f;                                                                       \
    }                                                                                      \
    DEVICE void set_##name(MAYBE_UNUSED Path path, MAYBE_UNUSED uint trial, float value) { \
        (void)value;                                                                       \
    }
#define X(feature, type, name) \
    WHEN(feature)(ACCESS_##type(name)) UNLESS(feature)(ACCESS_NO_##type(name))
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
    uint32_t words;  ///< size in words of 4 bytes
};

/// Returns the fields of the path state that exist under `mask`, in table order.
std::vector<PathStateField> path_state_fields(FeatureMask mask);
/// Returns the size of a path state under `mask`, in words of 4 bytes.
uint32_t path_state_words(FeatureMask mask);

}  // namespace rtrays

#endif
