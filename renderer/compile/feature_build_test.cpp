// SPDX-License-Identifier: MIT
// Tests that every feature is optional: all stages compile without warnings with all features, with
// none, and with each one disabled.
#include <gtest/gtest.h>
#include <stdlib.h>

#include <numeric>
#include <set>

#include "renderer/base/error.h"
#include "renderer/compile/stages.h"
#include "renderer/device/context.h"
#include "renderer/integrators/algorithm.h"
#include "renderer/integrators/megakernel.h"

namespace rtrays {
namespace {

/// Returns a device for which warnings are errors. It compiles without optimization, which takes
/// PoCL less than two thirds of the time. The code is never run. It has a separate cache.
DeviceContext &device() {
    static const bool in_haste =
        setenv("POCL_EXTRA_BUILD_FLAGS", "-cl-opt-disable -Werror", 1) == 0 &&
        setenv("POCL_CACHE_DIR", RTRAYS_FEATURE_BUILD_CACHE, 1) == 0;
    EXPECT_TRUE(in_haste);
    static DeviceContext context;
    return context;
}

class FeatureMasks : public testing::TestWithParam<int> {};

std::string name_of_build(int index) {
    return index == -2 ? "all"
           : index == -1
               ? "none"
               : "without_" + FeatureMask().with(static_cast<Feature>(index)).names().front();
}

TEST_P(FeatureMasks, Build) {
    const int index = GetParam();
    const FeatureMask mask = index == -2 ? FeatureMask::all()
                             : index == -1
                                 ? FeatureMask()
                                 : FeatureMask::all().with(static_cast<Feature>(index), false);
    const auto passes = [&](const Algorithm &algorithm) {
        return algorithm_passes(algorithm, {mask, 1, true, 2});
    };
    // One program contains all stages of a pass, so that shared code is parsed once.
    const auto build = [](const Pass &pass, std::vector<Stage> stages) {
        for (const RoundStage &stage : pass.round) {
            stages.push_back(stage.stage);
        }
        std::set<std::string> includes;
        for (const Stage stage : stages) {
            includes.insert(std::string("#include \"") + stage_description(stage).file + "\"\n");
        }
        const std::string text = std::accumulate(includes.begin(), includes.end(), std::string());
        EXPECT_NO_THROW({
            const Program program(device(), "pass.cl",
                                  stage_defines(pass.features, {64, 512, 4, true}),
                                  {{"pass.cl", text}});
            for (const Stage stage : stages) {
                Kernel(program, to_string(stage), 64);
            }
        }) << to_string(pass.kind);
    };
    for (const Pass &pass : passes(algorithms::bdpt)) {
        build(pass, {Stage::reset_streams, Stage::carry_film});
    }
    for (const Pass &pass : megakernel_passes(passes(algorithms::path_tracing))) {
        build(pass, {});
    }
    for (Pass pass : passes(algorithms::light_tracing)) {
        pass.round = pass.tail;
        build(pass, {});
    }
    // For other algorithms, compile only the stages that the algorithms above do not have.
    for (Pass pass : passes(algorithms::whitted)) {
        pass.round = {pass.round[pass.round.size() - 2]};
        build(pass, {Stage::retire_paths});
    }
}

TEST(FeatureBuild, FailsOnAWarning) {
    EXPECT_THROW(Program(device(), "warning.cl", {}, {{"warning.cl", "#warning planted"}}), Error);
}

INSTANTIATE_TEST_SUITE_P(Masks, FeatureMasks, testing::Range(-2, static_cast<int>(Feature::count)),
                         [](const auto &built) { return name_of_build(built.param); });

}  // namespace
}  // namespace rtrays
