// SPDX-License-Identifier: MIT
// Tests windows of a picture: paths from the camera give the bits of the full picture, and paths
// from lights its mean.
#include <gtest/gtest.h>

#include "renderer/device/context.h"
#include "renderer/import/json/scene_json.h"
#include "renderer/scene/scene.h"
#include "renderer/session/render_session.h"

namespace rtrays {
namespace {

constexpr int full_width = 24, full_height = 18;
constexpr FilmCrop window{7, 5, 10, 9};

/// A floor and a ball below a lamp, which the window does not show.
Image render(const std::string &camera, const RenderSettings &settings, uint64_t samples) {
    static DeviceContext device;
    const Scene scene = parse_scene_json(
        R"({"version": 1, "film": {"width": 24, "height": 18},
        "materials": {"white": {"type": "lambert", "reflectance": [0.5, 0.5, 0.5]}}, "nodes": [
        {"name": "camera", "transform": [{"translate": [0, 0.3, 4]}], "camera": )" +
            camera + R"(},
        {"name": "floor", "material": "white", "geometry": {"type": "rectangle"},
         "transform": [{"scale": [3, 3, 1]}, {"rotate": {"axis": [1, 0, 0], "degrees": -90}},
                       {"translate": [0, -1, 0]}]},
        {"name": "ball", "material": "white", "geometry": {"type": "sphere", "radius": 0.8}},
        {"name": "lamp", "material": "white", "geometry": {"type": "rectangle"},
         "transform": [{"rotate": {"axis": [1, 0, 0], "degrees": 90}}, {"translate": [0, 2, 0]}],
         "light": {"type": "diffuse_area", "radiance": [5, 4, 3]}}]})",
        "test", "test");
    RenderSession session(scene, settings, device);
    session.render(0, samples);
    return session.develop();
}

RenderSettings settings_of(const Algorithm &algorithm, bool crops) {
    RenderSettings settings;
    settings.algorithm = &algorithm;
    if (crops) {
        set_window(settings, window, full_width, full_height);
    }
    return settings;
}

double mean_of_window(const Image &image) {
    const bool is_full = image.width() == full_width;
    double sum = 0;
    for (int y = 0; y < window.height; ++y) {
        for (int x = 0; x < window.width; ++x) {
            const int at =
                is_full ? (y + window.y) * full_width + x + window.x : y * window.width + x;
            sum += static_cast<double>(image.channel("G")[static_cast<size_t>(at)]);
        }
    }
    return sum / (window.width * window.height);
}

constexpr const char *pinhole = R"({"type": "pinhole", "fov": 40, "fov_axis": "x"})";

const Image &full_picture() {
    static const Image image = render(pinhole, settings_of(algorithms::path_tracing, false), 256);
    return image;
}

TEST(Crop, HasTheBitsOfTheFullPicture) {
    const Image part = render(pinhole, settings_of(algorithms::path_tracing, true), 256);
    const Image &all = full_picture();
    ASSERT_EQ(part.width(), window.width);
    ASSERT_EQ(part.height(), window.height);
    for (int y = 0; y < window.height; ++y) {
        for (int x = 0; x < window.width; ++x) {
            const auto i = static_cast<size_t>(y * window.width + x);
            const auto j = static_cast<size_t>((y + window.y) * full_width + x + window.x);
            ASSERT_EQ(part.channel("R")[i], all.channel("R")[j]) << x << ", " << y;
        }
    }
}

TEST(Crop, ShowsLightPathsFromOutside) {
    const double expected = mean_of_window(full_picture());
    EXPECT_GT(expected, 0.1);
    RenderSettings settings = settings_of(algorithms::light_tracing, true);
    settings.light_paths = 4096;
    EXPECT_NEAR(mean_of_window(render(pinhole, settings, 256)) / expected, 1, 0.02);
}

TEST(Crop, CannotBeResized) {
    static DeviceContext device;
    const Scene scene = parse_scene_json(
        R"({"version": 1, "film": {"width": 8, "height": 8, "crop": {"x": 1, "y": 2, "width": 3, "height": 4}},
        "nodes": [{"name": "c", "camera": {"type": "pinhole", "fov": 40, "fov_axis": "x"}}]})",
        "test", "test");
    RenderSession session(scene, RenderSettings(), device);
    EXPECT_EQ(session.develop().width(), 3);
    EXPECT_EQ(session.develop().height(), 4);
    EXPECT_THROW(session.resize(8, 8), Error);
}

}  // namespace
}  // namespace rtrays
