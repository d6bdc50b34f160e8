// SPDX-License-Identifier: MIT
// Tests that independent estimators of one picture agree pairwise, over blocks of 16 x 16 pixels
// and in the mean: implicit, explicit and MIS paths of the renderer, and the reference.
#include <gtest/gtest.h>

#include <iterator>
#include <map>
#include <string>

#include "experiments/harness/core/agreement.h"
#include "reference/renderer.h"
#include "renderer/device/context.h"
#include "renderer/import/load_scene.h"
#include "renderer/session/render_session.h"

namespace rtrays {
namespace {

constexpr int size = 64;

/// Sample count and seed of an estimator. The samples suffice to detect an error of 2 %, as
/// asserted below; implicit paths are the noisiest. The seeds differ, because the tests assume
/// independent images.
struct Run {
    uint64_t spp;
    uint32_t seed;
};
const std::map<std::string, Run> runs = {
    {"implicit", {2048, 101}}, {"explicit", {256, 102}}, {"mis", {256, 103}}};

Image render(const Scene &scene, const std::string &strategies, DeviceContext &device) {
    RenderSettings settings;
    settings.width = settings.height = size;
    settings.seed = runs.at(strategies).seed;
    apply_setting(settings, "integrator.strategies=" + strategies);
    RenderSession session(scene, settings, device);
    session.render(0, runs.at(strategies).spp);
    return session.develop();
}

Image render_reference(const Scene &scene) {
    ReferenceSettings settings;
    settings.width = settings.height = size;
    settings.seed = 7;
    ReferenceRenderer reference(scene.arrays(), settings);
    reference.render(0, 512);
    return reference.develop();
}

TEST(Estimators, AgreePairwiseAndWithTheReference) {
    const Scene scene = load_scene(RTRAYS_SCENES "/cornell_box/scene.json");
    DeviceContext device;
    std::map<std::string, Image> images = {{"reference", render_reference(scene)}};
    for (const auto &entry : runs) {
        images[entry.first] = render(scene, entry.first, device);
    }
    AgreementPolicy policy;
    policy.alpha = 0.01 / 6;  // six pairs
    for (auto a = images.begin(); a != images.end(); ++a) {
        for (auto b = std::next(a); b != images.end(); ++b) {
            const Agreement agreement = test_agreement(a->second, b->second, policy);
            EXPECT_TRUE(agreement.agrees())
                << a->first << " against " << b->first << ": " << agreement.rejected
                << " tests reject, largest |z| " << agreement.largest_z;
            Image brighter = a->second;
            for (const std::string &channel : rgb_names()) {
                for (float &value : brighter.channel(channel)) {
                    value *= 1.02f;
                }
            }
            EXPECT_FALSE(test_agreement(brighter, b->second, policy).agrees())
                << "a planted error of 2 % of " << a->first;
        }
    }
}

}  // namespace
}  // namespace rtrays
