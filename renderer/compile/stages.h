// SPDX-License-Identifier: MIT
// Stages of the pipeline: their kernels, inputs and launches.
#pragma once

#include <map>
#include <string>
#include <vector>

#include "renderer/bvh/bvh.h"
#include "renderer/device/kernel.h"
#include "renderer/shared/features.h"

namespace rtrays {

/// Inputs of a stage, in the order of its parameters. Each input is one or more kernel parameters.
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

/// One stage of the pipeline, which is one kernel.
struct StageDescription {
    std::string name;  ///< name of the kernel, also used in profiles and results
    std::string file;
    std::vector<StageInput> inputs;
    /// Meaning of a work-item: a chunk of a queue's entries, a slot, a chunk of the work's paths,
    /// one of the last few paths, a sum of the film, or the only work-item.
    enum class Items { entries, slots, paths, few_paths, film_sums, one } items;
};

/// Returns the descriptions of all stages.
const std::vector<StageDescription> &stage_table();

/// Returns the description of one stage. Throws `Error` (run failed) when no stage has that name.
const StageDescription &stage_description(const std::string &name);

/// The kernel arguments of each input.
using StageArguments = std::map<StageInput, std::vector<KernelArgument>>;

/// Layout of streams and BVH on a device. The layout does not change a bit of the image, with one
/// exception: the BVH's layout decides which triangle a ray hits when two are at the same distance.
struct StreamLayout {
    uint32_t group_size;  ///< work-items per group
    uint32_t capacity;    ///< paths in flight
    uint32_t chunk;       ///< entries of a queue per work-item
    bool interleaved;     ///< the words of a path are adjacent
    BvhLayout bvh = BvhLayout::bvh2;
};

/// Returns the defines by which programs are specialised.
Defines stage_defines(FeatureMask features, const StreamLayout &layout);

/// Compiled programs and kernels of some stages under one feature mask.
class StageSet {
  public:
    /// Builds one program per file and one kernel per stage.
    StageSet(DeviceContext &device, const std::vector<std::string> &names, FeatureMask features,
             const StreamLayout &layout, const SourceOverlays &overlays);

    /// Compiles more stages and binds the arguments that the others have. The first launch of each
    /// takes longer, because the driver compiles the kernel.
    void add(const std::vector<std::string> &names);

    bool has(const std::string &name) const { return stages_.count(name) > 0; }

    /// Binds `arguments`. Inputs that it does not contain keep their arguments.
    void bind(const StageArguments &arguments);

    /// Launches a stage with at least `items` work-items.
    void enqueue(const std::string &name, uint64_t items);

    /// Returns the programs by file.
    const std::map<std::string, Program> &programs() const { return programs_; }
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
    StageArguments arguments_;  ///< all bound arguments
};

}  // namespace rtrays
