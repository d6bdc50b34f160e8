// SPDX-License-Identifier: MIT
// Compiled stages of the pipeline: their programs, arguments and launches.
#pragma once

#include <map>
#include <set>
#include <string>
#include <vector>

#include "renderer/bvh/bvh.h"
#include "renderer/compile/stage_table.h"
#include "renderer/device/kernel.h"
#include "renderer/shared/features.h"

namespace rtrays {

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
    /// Builds the programs of the stages, and one kernel per stage.
    StageSet(DeviceContext &device, const std::vector<Stage> &stages, FeatureMask features,
             const StreamLayout &layout, const SourceOverlays &overlays);

    /// Compiles more stages and binds the arguments that the others have. The first launch of each
    /// takes longer, because the driver compiles the kernel.
    void add(const std::vector<Stage> &stages);

    bool has(Stage stage) const { return kernels_.count(stage) > 0; }

    /// Binds `arguments`. Inputs that it does not contain keep their arguments.
    void bind(const StageArguments &arguments);

    /// Launches a stage with at least `items` work-items.
    void enqueue(Stage stage, uint64_t items);

    const std::vector<Program> &programs() const { return programs_; }
    /// Returns the time in which all programs were built or loaded.
    double build_seconds() const;

  private:
    void build(const std::set<Stage> &of_one_program);
    void bind(Stage stage, const StageArguments &changed);

    DeviceContext *device_;
    Defines defines_;
    uint32_t group_size_;
    SourceOverlays overlays_;
    std::vector<Program> programs_;
    std::map<Stage, Kernel> kernels_;
    StageArguments arguments_;  ///< all bound arguments
};

}  // namespace rtrays
