// SPDX-License-Identifier: MIT
// Independent estimators of one picture agree: implicit, explicit and MIS paths of the renderer, and the reference,
// pairwise, by blocks of 16 x 16 pixels and on the mean.
#include <gtest/gtest.h>

#include <map>

#include "experiments/agreement.h"
#include "reference/renderer.h"
#include "renderer/device/context.h"
#include "renderer/pipeline/render_session.h"
#include "renderer/scene/scene.h"

namespace rtrays {
namespace {

constexpr int size = 64;

/// Enough samples of each that an error of 2 % is seen (asserted below); implicit paths are the noisiest.
const std::map<std::string, uint64_t> samples = {{"implicit", 2048}, {"explicit", 256}, {"mis", 256}};

Image render(const Scene &scene, const std::string &strategies, DeviceContext &device) {
    RenderSettings settings;
    settings.width = settings.height = size;
    settings.seed = 100 + static_cast<uint32_t>(strategies.size());
    settings.strategies = strategies;
    RenderSession session(scene, settings, device);
    session.render(0, samples.at(strategies));
    return session.develop();
}

Image render_reference(const Scene &scene) {
    ReferenceSettings settings;
    settings.width = settings.height = size;
    settings.seed = 7;
    ReferenceRenderer reference(scene.cameras(), scene.meshes(), scene.materials(), scene.lights(), settings);
    reference.render(0, 512);
    return reference.develop();
}

TEST(Estimators, AgreePairwiseAndWithTheReference) {
    const Scene scene = load_scene(RTRAYS_SCENES "/cornell_box/scene.json");
    DeviceContext device;
    std::map<std::string, Image> images = {{"reference", render_reference(scene)}};
    for (const auto &[strategies, spp] : samples) {
        images[strategies] = render(scene, strategies, device);
    }
    AgreementPolicy policy;
    policy.alpha = 0.01 / 6;  // six pairs
    for (auto a = images.begin(); a != images.end(); ++a) {
        for (auto b = std::next(a); b != images.end(); ++b) {
            const Agreement agreement = test_agreement(a->second, b->second, policy);
            EXPECT_TRUE(agreement.agrees()) << a->first << " against " << b->first << ": " << agreement.rejected
                                            << " tests rejected, largest |z| " << agreement.largest_z;
            Image brighter = a->second;
            for (const std::string &channel : rgb_names()) {
                for (float &value : brighter.channel(channel)) {
                    value *= 1.02f;
                }
            }
            EXPECT_FALSE(test_agreement(brighter, b->second, policy).agrees()) << "a planted error of 2 % of " << a->first;
        }
    }
}

}  // namespace
}  // namespace rtrays
