// SPDX-License-Identifier: MIT
// Tests the layers of an image that hold the contributions of each strategy and sum to the image.
#include <gtest/gtest.h>

#include <algorithm>
#include <string>
#include <vector>

#include "renderer/device/context.h"
#include "renderer/import/load_scene.h"
#include "renderer/session/render_session.h"
#include "renderer/testing/errors.h"

namespace rtrays {
namespace {

Image render(const std::string &scene, const std::string &algorithm, bool separate,
             const std::string &assignment) {
    static DeviceContext device;
    RenderSettings settings;
    settings.width = settings.height = 32;
    settings.algorithm = &algorithm_named(algorithm);
    settings.variance = false;
    settings.separate_strategies = separate;
    settings.stream_capacity = 512;
    apply_setting(settings, assignment);
    RenderSession session(load_scene(RTRAYS_SCENES + scene), settings, device);
    session.render(0, 16);
    return session.develop();
}

double mean_of(const Image &image, const std::string &channel) {
    double sum = 0;
    for (const float value : image.channel(channel)) {
        sum += static_cast<double>(value);
    }
    return sum / static_cast<double>(image.pixel_count());
}

struct Case {
    std::string scene;
    std::string algorithm;
    std::string assignment;
    std::vector<std::string> layers;
};

// The same paths have the same weights, whether they are summed separately or together. The sums
// differ only by rounding.
TEST(Contributions, AddUpToTheImage) {
    const Case cases[] = {
        {"/cornell_box/scene.json",
         "path_tracing",
         "integrator.strategies=mis",
         {"implicit", "explicit"}},
        {"/cornell_box/scene.json",
         "truncated_bdpt",
         "device.features=scene",
         {"implicit", "explicit", "light"}},
        {"/cornell_box/scene.json",
         "truncated_bdpt",
         "integrator.seen_emitters=camera",
         {"implicit", "explicit", "light"}},
        {"/features/combined_lights.json",
         "truncated_bdpt",
         "integrator.light_selection=independent",
         {"implicit", "explicit", "light"}},
        {"/features/area_light.json",
         "bdpt",
         "integrator.bdpt_vertices=3",
         {"implicit", "explicit", "connections", "light"}},
    };
    for (const auto &[scene, algorithm, assignment, layers] : cases) {
        const std::string what = scene + " " + algorithm + " " + assignment;
        const Image whole = render(scene, algorithm, false, assignment);
        const Image separate = render(scene, algorithm, true, assignment);
        for (const char channel : {'R', 'G', 'B'}) {
            const std::string name(1, channel);
            std::vector<double> sum(whole.pixel_count());
            for (const std::string &layer : layers) {
                ASSERT_GT(mean_of(separate, layer + "." + name), 0) << what << " " << layer;
                const std::vector<float> &values = separate.channel(layer + "." + name);
                std::transform(
                    sum.begin(), sum.end(), values.begin(), sum.begin(),
                    [](double total, float value) { return total + static_cast<double>(value); });
            }
            for (size_t i = 0; i < sum.size(); ++i) {
                const double expected = static_cast<double>(whole.channel(name)[i]);
                ASSERT_NEAR(sum[i], expected, 2e-6 * (1 + expected)) << what;
                ASSERT_NEAR(static_cast<double>(separate.channel(name)[i]), expected,
                            2e-6 * (1 + expected))
                    << what;
            }
        }
    }
}

// A light that paths cannot hit contributes only explicitly.
TEST(Contributions, AreThoseOfTheirStrategy) {
    const Image point =
        render("/features/point_light.json", "path_tracing", true, "integrator.strategies=mis");
    EXPECT_EQ(mean_of(point, "implicit.G"), 0);
    EXPECT_GT(mean_of(point, "explicit.G"), 0);
}

TEST(Contributions, GoWithoutVariance) {
    static DeviceContext device;
    RenderSettings settings;
    settings.separate_strategies = true;
    expect_input_error("omit the layer 'variance'", [&] {
        RenderSession(load_scene(RTRAYS_SCENES "/cornell_box/scene.json"), settings, device);
    });
}

}  // namespace
}  // namespace rtrays
