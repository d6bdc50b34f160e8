// SPDX-License-Identifier: MIT
// Renders a mirror under a dome, where Russian roulette is the only source of variance.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "renderer/device/context.h"
#include "renderer/import/json/scene_json.h"
#include "renderer/import/load_scene.h"
#include "renderer/session/render_session.h"

namespace rtrays {
namespace {

/// Renders a mirror of reflectance 1/2 that fills the image, under a dome of radiance 1.
Image render_mirror(const std::string &setting) {
    static DeviceContext device;
    const Scene scene = parse_scene_json(
        R"({"version": 1, "film": {"width": 8, "height": 8}, "nodes": [
            {"name": "camera", "camera": {"type": "pinhole", "fov": 30, "fov_axis": "x"}},
            {"name": "mirror", "geometry": {"type": "rectangle"},
             "material": {"type": "mirror", "reflectance": [0.5, 0.5, 0.5]},
             "transform": [{"scale": [9, 9, 1]}, {"translate": [0, 0, -4]}]},
            {"name": "sky", "light": {"type": "dome", "radiance": [1, 1, 1]}}]})",
        "mirror", "mirror");
    RenderSettings settings;
    settings.width = settings.height = 8;
    apply_setting(settings, setting);
    RenderSession session(scene, settings, device);
    session.render(0, 64);
    return session.develop();
}

TEST(Roulette, BeginsAtTheThroughputOrEventSet) {
    for (const char *always : {"integrator.roulette_start=1", "integrator.roulette_start=0.51",
                               "integrator.roulette_event=1"}) {
        const Image image = render_mirror(always);
        double mean = 0;
        for (const float value : image.channel("R")) {
            EXPECT_EQ(std::fmod(64 * value, 1.0f), 0.0f) << "paths have radiance 1 or 0";
            mean += static_cast<double>(value) / 64;
        }
        // 4096 paths, each lost with probability 1/2.
        EXPECT_NEAR(mean, 0.5, 5 * 0.5 / 64);
        const auto [least, most] =
            std::minmax_element(image.channel("R").begin(), image.channel("R").end());
        EXPECT_LT(*least, *most);
    }
    for (const char *late : {"integrator.roulette_start=0.5", "integrator.roulette_start=0.25",
                             "integrator.roulette_start=0", "integrator.roulette_event=2"}) {
        const Image image = render_mirror(late);
        for (const float value : image.channel("R")) {
            EXPECT_NEAR(value, 0.5f, 1e-6f);
        }
    }
}

// A closed room of radiance 1 and albedo 1/2 shines 2 everywhere. Longer paths must not change it.
TEST(Roulette, KeepsTheFurnaceWhereverItBegins) {
    const Scene scene = load_scene(RTRAYS_SCENES "/analytic/furnace_050.json");
    double rays_before = 0;
    for (const char *event : {"1", "3", "6"}) {
        DeviceContext device;
        RenderSettings settings;
        settings.width = settings.height = 16;
        apply_setting(settings, std::string("integrator.roulette_event=") + event);
        RenderSession session(scene, settings, device);
        session.render(0, 64);
        double mean = 0, variance = 0;
        const Image image = session.develop();
        for (size_t pixel = 0; pixel < image.pixel_count(); ++pixel) {
            mean += static_cast<double>(image.channel("R")[pixel]) / 256;
            variance += static_cast<double>(image.channel("variance.R")[pixel]) / (256.0 * 256.0);
        }
        EXPECT_NEAR(mean, 2, 5 * std::sqrt(variance) + 1e-5) << event;
        EXPECT_LT(std::sqrt(variance), 0.02) << event;
        const auto rays = static_cast<double>(session.stats().rays);
        EXPECT_GT(rays, 1.2 * rays_before) << "paths do not become longer";
        rays_before = rays;
    }
}

}  // namespace
}  // namespace rtrays
