// SPDX-License-Identifier: MIT
#pragma once

#include <map>
#include <string>
#include <vector>

#include "renderer/device/kernel.h"
#include "renderer/shared/features.h"

namespace rtrays {

/// What a stage takes, in the order of its parameters; each stands for one or more kernel parameters.
enum class StageInput { bvh, surfaces, lights, camera, film, film_sums, settings, first_sample, work, streams, counters };

/// One block of the pipeline: one kernel.
struct StageDescription {
    std::string name;  ///< of the kernel, in source, profile and results
    std::string file;
    std::vector<StageInput> inputs;
    enum class Items { capacity, one, film_sums } items;  ///< how many work-items it is launched with
};

/// All stages there are.
const std::vector<StageDescription> &stage_table();

/// The description of one stage; throws `Error` when there is none of that name.
const StageDescription &stage_description(const std::string &name);

/// The kernel arguments that stand for each input.
using StageArguments = std::map<StageInput, std::vector<KernelArgument>>;

/// The compiled programs and kernels of some stages under one feature mask.
class StageSet {
  public:
    /// Builds one program per file.
    StageSet(DeviceContext &device, const std::vector<std::string> &names, FeatureMask features, uint32_t group_size,
             const SourceOverlays &overlays);

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

    std::map<std::string, Program> programs_;
    std::map<std::string, Stage> stages_;
    std::map<StageInput, uint32_t> parameter_count_;  ///< of each input, learnt from the first binding
};

}  // namespace rtrays
