// SPDX-License-Identifier: MIT
// Tests scenes whose values were derived by hand. They check the conventions that renderer and
// reference share through the importer: camera axes, winding, mirroring, colour encoding and light
// units. Both must reproduce the derived value.
#include <gtest/gtest.h>

#include <array>
#include <cmath>

#include "experiments/harness/core/metrics.h"
#include "reference/renderer.h"
#include "renderer/base/angles.h"
#include "renderer/device/context.h"
#include "renderer/import/load_scene.h"
#include "renderer/session/render_session.h"

namespace rtrays {
namespace {

constexpr uint64_t spp = 2048;

/// Bound of a deviation in standard errors. Eleven scenes, two renderers and three channels make 66
/// random decisions; a bound of 4.5 keeps the total probability of a false alarm at 0.0005.
constexpr double bound = 4.5;

struct Expected {
    const char *scene;
    /// Radiance of pixel (x, y) by channel; equal for all pixels if the scene is uniform.
    double (*radiance)(int x, int y, size_t channel);
};

constexpr std::array<double, 3> rho = {0.8, 0.5, 0.2};
constexpr std::array<double, 3> steps = {1, 2, 4};  // radiances and intensities by channel

const std::array<Expected, 11> expectations = {{
    {"fov_axis",
     [](int x, int y, size_t c) { return x >= 16 && x < 24 && y < 4 ? steps[c] : 0.0; }},
    {"winding", [](int x, int, size_t c) { return x < 8 || (x >= 16 && x < 24) ? steps[c] : 0.0; }},
    {"point_light", [](int, int, size_t c) { return rho[c] / pi * 10 * steps[c] / 4; }},
    {"spot_light", [](int, int, size_t c) { return rho[c] / pi * 10 * steps[c] / 4; }},
    {"directional_light", [](int, int, size_t c) { return rho[c] / pi * steps[c] / 2; }},
    {"dome", [](int, int, size_t c) { return rho[c] * steps[c]; }},
    {"disc_light", [](int, int, size_t c) { return rho[c] * steps[c] * 0.25 / (0.25 + 16); }},
    {"sphere_light", [](int, int, size_t c) { return rho[c] * steps[c] * 0.25 / 16; }},
    {"three_lamps", [](int, int, size_t c) { return 0.8 * rho[c] * steps[c] * 0.25 / 16; }},
    {"texture_srgb", [](int, int, size_t) { return std::pow((128 / 255.0 + 0.055) / 1.055, 2.4); }},
    {"texture_linear", [](int, int, size_t) { return 128 / 255.0; }},
}};

Image render(const Scene &scene) {
    DeviceContext device;
    RenderSettings settings;
    settings.seed = 5;
    RenderSession session(scene, settings, device);
    session.render(0, spp);
    return session.develop();
}

Image render_reference(const Scene &scene) {
    ReferenceSettings settings;
    settings.width = scene.film_width();
    settings.height = scene.film_height();
    settings.seed = 6;
    ReferenceRenderer reference(scene.arrays(), settings);
    reference.render(0, spp);
    return reference.develop();
}

/// Compares the sum over the pixels with its expected value, and noise-free pixels one by one.
void expect_meets(const Image &image, const Expected &expected, const char *renderer) {
    for (size_t channel = 0; channel < 3; ++channel) {
        const std::string name = rgb_names()[channel];
        const std::vector<float> &values = image.channel(name),
                                 &variances = image.channel("variance." + name);
        double sum = 0, wanted = 0, variance = 0;
        for (int y = 0; y < image.height(); ++y) {
            for (int x = 0; x < image.width(); ++x) {
                const auto i = static_cast<size_t>(y * image.width() + x);
                const double here = expected.radiance(x, y, channel);
                // Towards the corners of the field of view, cos^3 falls by up to 1.3e-4.
                if (variances[i] == 0.0f) {
                    ASSERT_NEAR(static_cast<double>(values[i]), here, 1.5e-4 * here)
                        << renderer << " " << x << "," << y;
                }
                sum += static_cast<double>(values[i]);
                wanted += here;
                variance += static_cast<double>(variances[i]);
            }
        }
        // A field of view of half a degree lowers the mean by at most 4.3e-5: cos^3 at a quarter of
        // a degree from 3 units away, with the light 2 units above.
        EXPECT_NEAR(sum, wanted, bound * std::sqrt(variance) + 5e-5 * wanted)
            << renderer << " " << name;
        EXPECT_LT(std::sqrt(variance), 0.005 * wanted) << renderer << ": power";
    }
}

class Analytic : public testing::TestWithParam<Expected> {};

TEST_P(Analytic, RendererAndReferenceMeetTheDerivedValue) {
    const Scene scene =
        load_scene(std::string(RTRAYS_SCENES "/analytic/") + GetParam().scene + ".json");
    expect_meets(render(scene), GetParam(), "renderer");
    expect_meets(render_reference(scene), GetParam(), "reference");
}

INSTANTIATE_TEST_SUITE_P(Scenes, Analytic, testing::ValuesIn(expectations),
                         [](const auto &tested) { return std::string(tested.param.scene); });

}  // namespace
}  // namespace rtrays
