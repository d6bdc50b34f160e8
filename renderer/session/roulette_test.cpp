// SPDX-License-Identifier: MIT
// Renders a mirror under a dome, where Russian roulette is the only source of variance.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "renderer/device/context.h"
#include "renderer/import/json/scene_json.h"
#include "renderer/session/render_session.h"

namespace rtrays {
namespace {

/// Renders a mirror of reflectance 1/2 that fills the image, under a dome of radiance 1.
Image render_mirror(const std::string &roulette_start) {
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
    apply_setting(settings, "integrator.roulette_start=" + roulette_start);
    RenderSession session(scene, settings, device);
    session.render(0, 64);
    return session.develop();
}

TEST(Roulette, BeginsAtMirrorsBelowTheThroughputSet) {
    for (const char *always : {"1", "0.51"}) {
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
    for (const char *late : {"0.5", "0.25", "0"}) {
        const Image image = render_mirror(late);
        for (const float value : image.channel("R")) {
            EXPECT_NEAR(value, 0.5f, 1e-6f);
        }
    }
}

}  // namespace
}  // namespace rtrays
