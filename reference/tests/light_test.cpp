// SPDX-License-Identifier: MIT
#include "reference/light.h"

#include <gtest/gtest.h>

#include "reference/tests/statistics.h"
#include "reference/tests/test_scenes.h"
#include "renderer/base/error.h"
#include "renderer/base/statistics.h"

namespace rtrays::reference {
namespace {

/// Returns the solid angle of a triangle seen from `point` (Van Oosterom & Strackee 1983, eq. 8).
double solid_angle(const TriangleRecord &triangle, const Vec3 &point) {
    const Vec3 a = (triangle.vertex - point).normalized();
    const Vec3 b = (triangle.vertex + triangle.edge1 - point).normalized();
    const Vec3 c = (triangle.vertex + triangle.edge2 - point).normalized();
    return 2.0 * std::abs(std::atan2(a.dot(b.cross(c)), 1.0 + a.dot(b) + b.dot(c) + c.dot(a)));
}

/// Returns three lights of very different power and shape around the origin.
TestScene three_lights() {
    TestScene scene;
    const uint32_t material = scene.add_material(Rgb::Constant(0.5f));
    scene.add_quad({Vec3(-1, 3, -1), Vec3(2, 3, -1), Vec3(2, 3, 1), Vec3(-1, 3, 1)}, material,
                   Rgb::Constant(10.0f));
    scene.add_mesh({Vec3(-4, 0, -1), Vec3(-4, 0, 2), Vec3(-4, 2, 0), Vec3(-4, -3, 0)},
                   {{0, 2, 1}, {0, 1, 3}}, material, Rgb(0.1f, 0.0f, 0.0f));
    scene.add_box({1.5, -0.5, -0.5}, {2.5, 0.5, 0.5}, false, material, Rgb::Constant(1.0f));
    return scene;
}

TEST(LightSet, sampled_directions_integrate_to_the_lights_solid_angle) {
    // The mean over all samples of 1 / pdf_w, or 0 for a sample off the triangle, is the solid
    // angle of the triangle.
    const TestScene scene = three_lights();
    const Geometry geometry(scene.meshes, scene.shapes);
    const LightSet lights(geometry, scene.lights);
    const Vec3 from = Vec3::Zero();
    constexpr int samples = 400000;

    std::vector<double> sum(geometry.triangles().size(), 0.0), squares = sum;
    Rng rng(41, 0, 0);
    int visible = 0;
    for (int i = 0; i < samples; ++i) {
        const auto sample = lights.sample(geometry, from, rng);
        if (!sample) {
            continue;  // a face of the box that faces away
        }
        SurfacePoint hit;
        ASSERT_TRUE(geometry.intersect({from, sample->wi}, Coherence::incoherent, hit));
        const uint32_t light = geometry.light(hit);
        ASSERT_NE(light, no_index);
        if (geometry.occluded(from, sample->target)) {
            continue;
        }
        ++visible;
        // Both MIS strategies must use the same density.
        ASSERT_NEAR(lights.pdf_w(geometry, light, from, hit) / sample->pdf_w, 1.0, 1e-9);
        ASSERT_TRUE((lights.emitted(geometry, light, hit, -sample->wi) == sample->radiance).all());
        sum[hit.primitive] += 1.0 / sample->pdf_w;
        squares[hit.primitive] += square(1.0 / sample->pdf_w);
    }
    EXPECT_GT(visible, samples / 3);

    std::vector<Comparison> suite;
    for (uint32_t t = 0; t < sum.size(); ++t) {
        const TriangleRecord &triangle = geometry.triangles()[t];
        const double mean = sum[t] / samples;
        const double deviation = std::sqrt((squares[t] / samples - mean * mean) / samples);
        const bool faces = triangle.normal.dot(from - triangle.vertex) > 0.0;
        const double expected = faces ? solid_angle(triangle, from) : 0.0;
        const double difference = mean - expected;
        suite.push_back(
            {std::to_string(t), normal_p_value(difference == 0.0 ? 0.0 : difference / deviation)});
    }
    EXPECT_EQ(holm_rejected(suite), std::vector<std::string>{});
}

TEST(LightSet, has_no_density_behind_a_light) {
    const TestScene scene = three_lights();
    const Geometry geometry(scene.meshes, scene.shapes);
    const LightSet lights(geometry, scene.lights);
    const Vec3 above(0.3, 6.0, 0.1);
    SurfacePoint hit;
    ASSERT_TRUE(geometry.intersect({above, -Vec3::UnitY()}, Coherence::incoherent, hit));
    EXPECT_EQ(lights.pdf_w(geometry, 0, above, hit), 0.0);
    EXPECT_TRUE((lights.emitted(geometry, 0, hit, Vec3::UnitY()) == 0.0).all());
}

TEST(LightSet, tolerates_black_lights_and_refuses_negative_ones) {
    TestScene scene = three_lights();
    for (Rgb &radiance : scene.lights.radiance) {
        radiance.setZero();
    }
    scene.set_camera({0, 0, 0}, {0, 1, 0}, Vec3::UnitX(), 1.0);
    auto renderer = scene.renderer(small_settings(4, 1));
    renderer.render(0, 16);
    EXPECT_EQ(image_mean(renderer.develop(), "R").mean, 0.0);
    scene.lights.radiance[1] = Rgb(-1.0f, 0.0f, 0.0f);
    EXPECT_THROW(scene.renderer(small_settings(4, 1)), Error);
}

}  // namespace
}  // namespace rtrays::reference
