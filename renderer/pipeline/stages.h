// SPDX-License-Identifier: MIT
#pragma once

#include <map>
#include <string>
#include <vector>

#include "renderer/bvh/bvh.h"
#include "renderer/device/kernel.h"
#include "renderer/shared/features.h"

namespace rtrays {

/// What a stage takes, in the order of its parameters; each stands for one or more kernel
/// parameters.
enum class StageInput {
    geometry,
    traversal,
    surfaces,
    materials,
    lights,
    camera,
    film,
    half_film,
    live_pixels,
    film_sums,
    settings,
    first_sample,
    chosen,
    first_work,
    work,
    vertices,
    branches,
    streams,
    counters,
    ray_counts
};

/// One block of the pipeline: one kernel.
struct StageDescription {
    std::string name;  ///< of the kernel, in source, profile and results
    std::string file;
    std::vector<StageInput> inputs;
    /// What its work-items stand for: chunks of a queue's entries, slots, chunks of the work's
    /// paths, the last few paths, sums of the film, or just one.
    enum class Items { entries, slots, paths, few_paths, film_sums, one } items;
};

/// All stages there are.
const std::vector<StageDescription> &stage_table();

/// The description of one stage; throws `Error` when there is none of that name.
const StageDescription &stage_description(const std::string &name);

/// The kernel arguments that stand for each input.
using StageArguments = std::map<StageInput, std::vector<KernelArgument>>;

/// How streams and the hierarchy are laid out on a device. None of it changes a bit of the image,
/// but for the layout of the hierarchy where a ray hits two triangles at the same distance.
struct StreamLayout {
    uint32_t group_size;  ///< work-items per group
    uint32_t capacity;    ///< paths in flight
    uint32_t chunk;       ///< entries of a queue per work-item
    bool interleaved;     ///< the words of a path lie together
    BvhLayout bvh = BvhLayout::bvh2;
};

/// What the stages' programs are specialised by.
Defines stage_defines(FeatureMask features, const StreamLayout &layout);

/// The compiled programs and kernels of some stages under one feature mask.
class StageSet {
  public:
    /// Builds one program per file.
    StageSet(DeviceContext &device, const std::vector<std::string> &names, FeatureMask features,
             const StreamLayout &layout, const SourceOverlays &overlays);

    /// Compiles more stages, with the arguments that the others have. Their first launch compiles
    /// once more.
    void add(const std::vector<std::string> &names);

    bool has(const std::string &name) const { return stages_.count(name) > 0; }

    /// Binds what `arguments` holds; inputs that it does not name keep their binding.
    void bind(const StageArguments &arguments);

    /// Launches a stage over that many work-items.
    void enqueue(const std::string &name, uint64_t items);

    const std::map<std::string, Program> &programs() const { return programs_; }  ///< by file
    double build_seconds() const;

  private:
    struct Stage {
        const StageDescription *description;
        Kernel kernel;
    };

    void bind(Stage &stage, const StageArguments &changed);

    DeviceContext *device_;
    Defines defines_;
    uint32_t group_size_;
    SourceOverlays overlays_;
    std::map<std::string, Program> programs_;
    std::map<std::string, Stage> stages_;
    StageArguments arguments_;  ///< all that were bound
};

}  // namespace rtrays
