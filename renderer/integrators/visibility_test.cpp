// SPDX-License-Identifier: MIT
// Tests which algorithms see the caustic of a point light, its image in a mirror, and what a
// surface with tilted shading normals reflects.
#include <gtest/gtest.h>

#include <cmath>
#include <string>

#include "renderer/base/angles.h"
#include "renderer/device/context.h"
#include "renderer/import/json/scene_json.h"
#include "renderer/import/load_scene.h"
#include "renderer/session/render_session.h"

namespace rtrays {
namespace {

/// Returns the mean of the green channel over the image, and its standard error from 32 batches.
std::pair<double, double> mean_of(const Scene &scene, const Algorithm &algorithm,
                                  uint32_t max_depth) {
    static DeviceContext device;
    RenderSettings settings;
    settings.algorithm = &algorithm;
    settings.max_depth = max_depth;
    RenderSession session(scene, settings, device);
    constexpr uint64_t batches = 32, spp = 512;
    double sum = 0, squares = 0;
    for (uint64_t batch = 0; batch < batches; ++batch) {
        session.restart(3);
        session.render(batch * spp, (batch + 1) * spp);
        double mean = 0;
        const Image image = session.develop();
        for (const float value : image.channel("G")) {
            mean += static_cast<double>(value) / static_cast<double>(image.pixel_count());
        }
        sum += mean;
        squares += mean * mean;
    }
    const double mean = sum / batches;
    return {mean, std::sqrt((squares / batches - mean * mean) / (batches - 1))};
}

std::pair<double, double> mean_of(const std::string &scene, const Algorithm &algorithm,
                                  uint32_t max_depth) {
    return mean_of(load_scene(RTRAYS_SCENES "/analytic/" + scene), algorithm, max_depth);
}

/// Returns the mean radiance of the visible floor, with midpoints of 4 x 4 sub-pixels of 16 x 16
/// pixels.
double expected_radiance() {
    double sum = 0;
    const double half = 1.2 * std::tan(10 * pi / 180);
    for (int i = 0; i < 64; ++i) {
        for (int j = 0; j < 64; ++j) {
            const double x = 1.2 + half * ((i + 0.5) / 32 - 1), z = half * ((j + 0.5) / 32 - 1);
            const double d = std::sqrt(x * x + z * z + 9);
            sum += 0.5 / pi * 20 * 3 / (d * d * d);
        }
    }
    return sum / (64 * 64);
}

// The algorithms without random numbers see no caustic, and their samples have no scatter.
TEST(Visibility, IsThatOfTheRegistryForTheCausticOfAPointLight) {
    const double expected = expected_radiance();
    for (const Algorithm *algorithm : all_algorithms()) {
        const auto [mean, error] = mean_of("caustic.json", *algorithm, 2);
        if (algorithm->sees.of(PathClass::delta_light_caustics) == Visibility::no) {
            EXPECT_EQ(mean, 0) << algorithm->name;
            continue;
        }
        // With 3.5 standard errors for each of three means, the family-wise level is 0.005
        // (Student's t with 31 degrees of freedom).
        EXPECT_LT(std::abs(mean - expected), 3.5 * error) << algorithm->name;
        EXPECT_LT(error, 0.02 * expected) << "statistical power";
    }
}

TEST(Visibility, IsThatOfTheRegistryForItsMirrorImage) {
    for (const Algorithm *algorithm : all_algorithms()) {
        EXPECT_EQ(algorithm->sees.of(PathClass::mirrored_delta_light_caustics), Visibility::no);
        EXPECT_EQ(mean_of("caustic_in_mirror.json", *algorithm, 0).first, 0) << algorithm->name;
    }
}

// A floor whose shading normals are tilted by 60 degrees away from a wall, under a sun at the
// zenith. Most light that the floor sends to the wall leaves it below the horizon of the shading
// normal, where camera paths use the geometric normal.
TEST(Visibility, IsThatOfCameraPathsWhereShadingNormalsAreTilted) {
    const Scene scene = parse_scene_json(
        R"({"version": 1, "film": {"width": 8, "height": 8},
        "materials": {"w": {"type": "lambert", "reflectance": [0.8, 0.8, 0.8]}}, "nodes": [
        {"name": "camera", "transform": [{"look_at": {"origin": [3, 1, 0], "target": [-1, 1, 0], "up": [0, 1, 0]}}],
         "camera": {"type": "pinhole", "fov": 20, "fov_axis": "smaller"}},
        {"name": "floor", "material": "w", "geometry": {"type": "mesh",
         "vertices": [[-1, 0, 2], [3, 0, 2], [3, 0, -2], [-1, 0, -2]], "polygons": [[0, 1, 2, 3]],
         "normals": [[0.866, 0.5, 0], [0.866, 0.5, 0], [0.866, 0.5, 0], [0.866, 0.5, 0]]}},
        {"name": "wall", "material": "w", "geometry": {"type": "mesh",
         "vertices": [[-1, 0, 2], [-1, 0, -2], [-1, 3, -2], [-1, 3, 2]], "polygons": [[0, 1, 2, 3]]}},
        {"name": "sun", "transform": [{"rotate": {"axis": [1, 0, 0], "degrees": -90}}],
         "light": {"type": "directional", "irradiance": [3, 3, 3]}}]})",
        "test", "test");
    const auto [expected, expected_error] = mean_of(scene, algorithms::path_tracing, 3);
    for (const Algorithm *algorithm :
         {&algorithms::light_tracing, &algorithms::bdpt, &algorithms::truncated_bdpt}) {
        const auto [mean, error] = mean_of(scene, *algorithm, 3);
        // As above, 3.5 standard errors for each of three means.
        EXPECT_LT(std::abs(mean - expected), 3.5 * std::hypot(error, expected_error))
            << algorithm->name;
        EXPECT_LT(error, 0.02 * expected) << algorithm->name << ": statistical power";
    }
}

}  // namespace
}  // namespace rtrays
