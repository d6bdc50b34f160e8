// SPDX-License-Identifier: MIT
// Tests renders by a camera that is so far from the scene that float cannot resolve the scene in
// the coordinates of the lens.
#include <gtest/gtest.h>

#include <fmt/format.h>

#include <cmath>

#include "renderer/base/angles.h"
#include "renderer/device/context.h"
#include "renderer/import/json/scene_json.h"
#include "renderer/scene/scene.h"
#include "renderer/session/render_session.h"

namespace rtrays {
namespace {

/// Renders a box, a ball and a sun from `distance`, with a view that shows three units. A distance
/// of 0 means an orthographic camera.
Image render(double distance, const Algorithm &algorithm) {
    const double from = distance > 0 ? distance : 10;
    const std::string camera =
        distance > 0 ? fmt::format(R"("type": "pinhole", "fov": {}, "fov_axis": "smaller")",
                                   2 * std::atan(1.5 / distance) * 180 / pi)
                     : R"("type": "orthographic", "size": 3, "size_axis": "smaller")";
    static DeviceContext device;
    const Scene scene =
        parse_scene_json(fmt::format(
                             R"({{"version": 1, "film": {{"width": 32, "height": 32}},
            "materials": {{"white": {{"type": "lambert", "reflectance": [0.5, 0.5, 0.5]}}}}, "nodes": [
            {{"name": "camera", "camera": {{{}}},
              "transform": [{{"look_at": {{"origin": [0, {}, {}], "target": [0, 0, 0], "up": [0, 1, 0]}}}}]}},
            {{"name": "box", "material": "white", "geometry": {{"type": "box"}},
              "transform": [{{"rotate": {{"axis": [0, 1, 0], "degrees": 30}}}}, {{"scale": [0.6, 0.6, 0.6]}}]}},
            {{"name": "ball", "material": "white", "geometry": {{"type": "sphere", "radius": 0.3}},
              "transform": [{{"translate": [0.9, 0.8, 0.2]}}]}},
            {{"name": "sun", "light": {{"type": "directional", "irradiance": [3, 3, 3]}},
              "transform": [{{"rotate": {{"axis": [1, 0, 0], "degrees": -40}}}}]}}]}})",
                             camera, from * 0.6, from * 0.8),
                         "test", "test");
    RenderSettings settings;
    settings.algorithm = &algorithm;
    RenderSession session(scene, settings, device);
    session.render(0, 16);
    return session.develop();
}

/// Returns the mean absolute difference of two images over the mean of the first.
double difference(const Image &a, const Image &b) {
    double differences = 0, sum = 0;
    for (size_t i = 0; i < a.pixel_count(); ++i) {
        const auto x = static_cast<double>(a.channel("G")[i]),
                   y = static_cast<double>(b.channel("G")[i]);
        differences += std::abs(x - y);
        sum += x;
    }
    EXPECT_GT(sum, 0);
    return differences / sum;
}

// All random numbers are the same, and so is the perspective up to a millionth.
TEST(FarCamera, RendersTheImageOfANearerOne) {
    for (const Algorithm *algorithm : {&algorithms::path_tracing, &algorithms::light_tracing,
                                       &algorithms::truncated_bdpt, &algorithms::bdpt}) {
        const Image near = render(3e4, *algorithm);
        for (const double distance : {3e5, 3e6}) {
            EXPECT_LT(difference(near, render(distance, *algorithm)), 1e-3)
                << algorithm->name << " at " << distance;
        }
        EXPECT_LT(difference(render(3e6, *algorithm), render(0, *algorithm)), 1e-3)
            << algorithm->name << ", orthographic";
        // Below the limit of distance, rays begin on the lens.
        EXPECT_LT(difference(render(1e3, *algorithm), near), 0.02) << algorithm->name;
    }
}

}  // namespace
}  // namespace rtrays
