// SPDX-License-Identifier: MIT
// The table of all stages: the kernel, its program and source file, its work-items and its inputs.
#pragma once

#include <vector>

namespace rtrays {

/// Inputs of a stage, in the order of its parameters. Each input is one or more kernel parameters.
enum class StageInput {
    tracing,
    shading,
    scene,
    camera,
    film,
    half_film,
    live_pixels,
    film_sums,
    settings,
    first_sample,
    light_index,
    vertex_index,
    first_work,
    work,
    vertices,
    branches,
    streams,
    counters,
    ray_counts
};

/// Programs of the pipeline. Each compiles the files of its stages together: most of the time of a
/// compilation goes to the text that they share, and a program is compiled again only if a feature
/// changes that one of its files mentions.
enum class StageProgram {
    streams,  ///< queues, film and counts
    tracing,
    shading,
    paths,  ///< kernels that run whole paths
};

/// Meaning of a stage's work-item.
enum class StageItems {
    entries,     ///< a chunk of a queue's entries
    slots,       ///< a slot of the stream
    paths,       ///< a chunk of the work's paths
    tail_paths,  ///< a path of the tail of a batch
    film_sums,   ///< a sum of the film
    one,         ///< the only work-item
};

// X(name of the kernel, program, file, work-items, inputs ...). A row is one stage. The names also
// appear in profiles and results. `In` is StageInput.
#define RTRAYS_STAGES(X)                                                                          \
    X(reset_streams, streams, "kernels/advance_streams.cl", slots, In::first_work, In::streams)   \
    X(generate_camera_rays, shading, "kernels/generate_camera_rays.cl", entries, In::camera,      \
      In::settings, In::first_sample, In::work, In::live_pixels, In::streams)                     \
    X(generate_light_paths, shading, "kernels/generate_light_paths.cl", entries, In::shading,     \
      In::camera, In::settings, In::first_sample, In::work, In::vertices, In::streams)            \
    X(begin_round, streams, "kernels/advance_streams.cl", one, In::counters)                      \
    X(intersect_nearest, tracing, "kernels/intersect_nearest.cl", entries, In::tracing,           \
      In::streams)                                                                                \
    X(evaluate_emission, shading, "kernels/evaluate_emission.cl", entries, In::shading,           \
      In::settings, In::streams)                                                                  \
    X(sample_light, shading, "kernels/sample_light.cl", entries, In::shading, In::settings,       \
      In::first_sample, In::light_index, In::streams)                                             \
    X(intersect_any, tracing, "kernels/intersect_any.cl", entries, In::tracing, In::streams)      \
    X(connect_camera, shading, "kernels/connect_camera.cl", entries, In::shading, In::camera,     \
      In::settings, In::first_sample, In::streams)                                                \
    X(store_vertex, shading, "kernels/store_vertex.cl", entries, In::shading, In::settings,       \
      In::vertices, In::streams)                                                                  \
    X(connect_vertices, shading, "kernels/connect_vertices.cl", entries, In::shading,             \
      In::settings, In::vertex_index, In::vertices, In::streams)                                  \
    X(splat_unblocked, tracing, "kernels/splat_unblocked.cl", entries, In::tracing, In::film,     \
      In::first_sample, In::streams)                                                              \
    X(extend_path, shading, "kernels/extend_path.cl", entries, In::shading, In::film,             \
      In::half_film, In::settings, In::first_sample, In::streams)                                 \
    X(follow_branches, shading, "kernels/follow_branches.cl", entries, In::shading, In::film,     \
      In::settings, In::first_sample, In::branches, In::streams)                                  \
    X(retire_paths, streams, "kernels/retire_paths.cl", entries, In::film, In::first_sample,      \
      In::streams)                                                                                \
    X(trace_paths, paths, "kernels/trace_paths.cl", paths, In::scene, In::camera, In::film,       \
      In::half_film, In::settings, In::first_sample, In::first_work, In::work, In::live_pixels,   \
      In::counters)                                                                               \
    X(run_tail, paths, "kernels/run_tail.cl", tail_paths, In::scene, In::camera, In::film,        \
      In::half_film, In::settings, In::first_sample, In::streams)                                 \
    X(end_shadow_rays, streams, "kernels/advance_streams.cl", one, In::counters)                  \
    X(count_nearest_rays, streams, "kernels/count_rays.cl", entries, In::ray_counts, In::streams) \
    X(count_shadow_rays, streams, "kernels/count_rays.cl", entries, In::ray_counts, In::streams)  \
    X(end_round, streams, "kernels/advance_streams.cl", one, In::counters)                        \
    X(carry_film, streams, "kernels/carry_film.cl", film_sums, In::film, In::film_sums)

/// One stage of the pipeline, which is one kernel.
enum class Stage {
#define RTRAYS_STAGE(name, ...) name,
    RTRAYS_STAGES(RTRAYS_STAGE)
#undef RTRAYS_STAGE
};

/// A row of the table of stages.
struct StageDescription {
    const char *name;
    StageProgram program;
    const char *file;
    StageItems items;
    std::vector<StageInput> inputs;

    /// Returns whether the stage has this input.
    bool reads(StageInput input) const;
};

/// Returns the row of a stage.
const StageDescription &stage_description(Stage stage);

/// Returns the name of a stage's kernel.
const char *to_string(Stage stage);

}  // namespace rtrays
