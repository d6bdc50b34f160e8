// SPDX-License-Identifier: MIT
// Tests that every feature is optional: all stages compile without warnings with all features, with
// none, and with each one disabled. The masks of scenes with few features compile, too.
//
// With each one disabled, only the passes of bdpt compile, which have nearly all stages. If
// RTRAYS_ALL_BUILDS is set, as in `make test-full`, so do the megakernel and the other algorithms.
#include <gtest/gtest.h>
#include <stdlib.h>

#include <set>

#include "renderer/base/error.h"
#include "renderer/compile/compile_scene.h"
#include "renderer/compile/stages.h"
#include "renderer/device/context.h"
#include "renderer/import/json/scene_json.h"
#include "renderer/integrators/algorithm.h"
#include "renderer/integrators/megakernel.h"
#include "renderer/session/settings.h"

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

/// Builds `stages` and those of the pass's rounds in one program, so that shared code is parsed
/// once.
void expect_builds(const Pass &pass, std::set<Stage> stages) {
    for (const RoundStage &stage : pass.round) {
        stages.insert(stage.stage);
    }
    std::set<std::string> files;
    for (const Stage stage : stages) {
        files.insert(stage_description(stage).file);
    }
    EXPECT_NO_THROW({
        const Program program(device(), {files.begin(), files.end()},
                              stage_defines(pass.features, {64, 512, 4, true}));
        for (const Stage stage : stages) {
            Kernel(program, to_string(stage), 64);
        }
    }) << to_string(pass.kind)
       << ": " << testing::PrintToString(pass.features.names());
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
    for (const Pass &pass : passes(algorithms::bdpt)) {
        expect_builds(pass, {Stage::reset_streams, Stage::carry_film});
    }
    if (index >= 0 && getenv("RTRAYS_ALL_BUILDS") == nullptr) {
        return;
    }
    for (const Pass &pass : megakernel_passes(passes(algorithms::path_tracing))) {
        expect_builds(pass, {});
    }
    for (Pass pass : passes(algorithms::light_tracing)) {
        pass.round = pass.tail;
        expect_builds(pass, {});
    }
    // For other algorithms, compile only the stages that the algorithms above do not have.
    for (Pass pass : passes(algorithms::whitted)) {
        pass.round = {pass.round[pass.round.size() - 2]};
        expect_builds(pass, {Stage::retire_paths});
    }
}

TEST(FeatureBuild, FailsOnAWarning) {
    EXPECT_THROW(Program(device(), {"warning.cl"}, {}, {{"warning.cl", "#warning planted"}}),
                 Error);
}

INSTANTIATE_TEST_SUITE_P(Masks, FeatureMasks, testing::Range(-2, static_cast<int>(Feature::count)),
                         [](const auto &built) { return name_of_build(built.param); });

/// Returns the scene of a camera and of further nodes.
Scene scene_of(const std::string &nodes) {
    return parse_scene_json(R"({"version": 1, "film": {"width": 4, "height": 4}, "nodes": [
        {"name": "camera", "camera": {"type": "pinhole", "fov": 40, "fov_axis": "x"}})" +
                                nodes + "]}",
                            "test", "test");
}

/// Returns the passes of an algorithm with default settings, and the stages of each. A dome also
/// stands for an environment, which needs an image.
std::vector<std::pair<Pass, std::set<Stage>>> passes_of(const Scene &scene,
                                                        const Algorithm &algorithm) {
    RenderSettings settings;
    settings.algorithm = &algorithm;
    settings = with_fixed_choices(settings);
    const CompiledScene compiled = compile_scene(scene, compile_settings(settings));
    const bool has_dome = compiled.features.has(Feature::dome);
    std::vector<std::pair<Pass, std::set<Stage>>> passes;
    for (const FeatureMask features :
         {compiled.features,
          compiled.features.with(Feature::dome, false).with(Feature::environment, has_dome)}) {
        for (const Pass &pass :
             algorithm_passes(algorithm, {settings_features(settings) | features,
                                          compiled.lighting.light_count, true, 2})) {
            std::set<Stage> stages;
            for (const std::vector<RoundStage> *round : {&pass.round, &pass.tail}) {
                for (const RoundStage &stage : *round) {
                    stages.insert(stage.stage);
                }
            }
            passes.emplace_back(pass, stages);
        }
    }
    return passes;
}

// Masks with next to nothing in them: no surface or one that only emits, under each light, by each
// algorithm. No other test builds them, since every scene of the repository scatters light.
TEST(FeatureBuild, SucceedsForScenesThatScatterNothing) {
    const std::string sheet = R"({"type": "rectangle"})", coin = R"({"type": "disc", "radius": 1})";
    const auto emitter = [](const std::string &geometry) {
        return R"(, {"name": "emitter", "material": {"type": "lambert", "reflectance": [0, 0, 0]},
                     "light": {"type": "diffuse_area", "radiance": [1, 1, 1]}, "geometry": )" +
               geometry + "}";
    };
    const auto light = [](const std::string &parameters) {
        return R"(, {"name": "light", "light": {"type": )" + parameters + "}}";
    };
    std::set<std::pair<std::vector<std::string>, std::set<Stage>>> built;
    for (const std::string &surface : {std::string(), emitter(sheet), emitter(coin)}) {
        for (const std::string &lit :
             {std::string(), light(R"("point", "intensity": [1, 1, 1])"),
              light(R"("spot", "intensity": [1, 1, 1], "inner_degrees": 5, "outer_degrees": 9)"),
              light(R"("directional", "irradiance": [1, 1, 1])"),
              light(R"("dome", "radiance": [1, 1, 1])")}) {
            const Scene scene = scene_of(surface + lit);
            for (const Algorithm *algorithm : all_algorithms()) {
                for (const auto &[pass, stages] : passes_of(scene, *algorithm)) {
                    if (built.emplace(pass.features.names(), stages).second) {
                        expect_builds(pass, stages);
                    }
                }
            }
        }
    }
    EXPECT_GT(built.size(), 20u);
}

}  // namespace
}  // namespace rtrays
