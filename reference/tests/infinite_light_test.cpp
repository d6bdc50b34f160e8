// SPDX-License-Identifier: MIT
#include "reference/infinite_light.h"

#include <gtest/gtest.h>

#include "reference/light.h"
#include "reference/tests/sphere_grid.h"
#include "reference/tests/statistics.h"
#include "reference/tests/test_materials.h"
#include "reference/tests/test_scenes.h"
#include "renderer/base/statistics.h"

namespace rtrays::reference {
namespace {

using Kind = LightArrays::Kind;

std::shared_ptr<TextureImage> make_image(int width, int height) {
    auto image = std::make_shared<TextureImage>();
    image->width = width;
    image->height = height;
    image->floats.assign(3 * static_cast<size_t>(width) * static_cast<size_t>(height), 0.0f);
    return image;
}

void set_texel(TextureImage &image, int column, int row, float value) {
    for (int channel = 0; channel < 3; ++channel) {
        image.floats[static_cast<size_t>(3 * (row * image.width + column) + channel)] = value;
    }
}

/// Returns an image with one bright texel, a black region and random values elsewhere.
std::shared_ptr<TextureImage> contrasty_image(int width, int height) {
    auto image = make_image(width, height);
    Rng rng(141, 0, 0);
    for (int row = 0; row < height; ++row) {
        for (int column = 0; column < width; ++column) {
            const bool black = column < width / 3 && row > height / 2;
            set_texel(*image, column, row, black ? 0.0f : static_cast<float>(rng.uniform()));
        }
    }
    set_texel(*image, width / 2, height / 3, 50.0f);
    return image;
}

EnvironmentLight environment(std::shared_ptr<const TextureImage> image) {
    const Eigen::Matrix3d rotation =
        (Eigen::AngleAxisd(0.7, Vec3::UnitX()) * Eigen::AngleAxisd(1.1, Vec3::UnitY()))
            .toRotationMatrix();
    return {std::move(image), rotation, Spectrum(1.0, 2.0, 3.0), 1.0, "test"};
}

TEST(Environment, looks_up_directions_as_documented) {
    auto image = make_image(4, 2);
    for (int column = 0; column < 4; ++column) {
        set_texel(*image, column, 0, 1.0f + static_cast<float>(column));
        set_texel(*image, column, 1, 11.0f + static_cast<float>(column));
    }
    const EnvironmentLight light(image, Eigen::Matrix3d::Identity(), Spectrum::Constant(2.0), 1.0,
                                 "test");
    const auto red = [&](const Vec3 &direction) {
        return light.radiance(direction.normalized())[0];
    };
    EXPECT_NEAR(red({0, 1e-9, -1}), 2.0 * 0.5 * (0.5 * (1 + 4) + 0.5 * (11 + 14)),
                1e-7);  // left edge
    EXPECT_NEAR(red({1, 0, -1}), 2.0 * 0.5 * (1 + 11),
                1e-12);  // u = 1/8: centre of the first column
    EXPECT_NEAR(red({1, 0, 1}), 2.0 * 0.5 * (2 + 12), 1e-12);
    EXPECT_NEAR(red({-1, 0, -1}), 2.0 * 0.5 * (4 + 14), 1e-12);
    EXPECT_NEAR(red({1, std::sqrt(2.0), -1}), 2.0, 1e-12);  // v = 1/4: centre of the first row
    EXPECT_NEAR(red({1, 20, -1}), 2.0, 1e-12);  // the first row is repeated above its centres
    EXPECT_NEAR(red({1, -20, -1}), 22.0, 1e-12);
}

TEST(Environment, directions_have_their_density_and_see_all_that_shines) {
    std::vector<Comparison> suite;
    for (const auto &[width, height] :
         {std::pair(1, 1), std::pair(4, 2), std::pair(7, 5), std::pair(32, 16)}) {
        const EnvironmentLight light = environment(contrasty_image(width, height));
        const TestScene empty;
        const Geometry geometry(empty.meshes, empty.shapes);
        Rng rng(142, 0, 0);
        const auto sample = [&](Rng &r) -> std::optional<Vec3> {
            const auto drawn = light.sample(geometry, Vec3::Zero(), r);
            if (!drawn) {
                return std::nullopt;
            }
            EXPECT_TRUE(drawn->radiance.isApprox(light.radiance(drawn->wi)));
            EXPECT_DOUBLE_EQ(drawn->pdf_w, light.pdf_w(drawn->wi));
            return drawn->wi;
        };
        const auto density = [&](const Vec3 &w) { return light.pdf_w(w); };
        const SamplerCheck check = check_sampler(sample, density, 400000, rng);
        EXPECT_NEAR(check.total, 1.0, 1e-3);  // the cells at the poles contain 1 / sin(theta)
        suite.push_back({std::to_string(width), check.p_value});
        for (int i = 0; i < 10000; ++i) {
            const double z = 1.0 - 2.0 * rng.uniform(), phi = 2.0 * pi * rng.uniform();
            const double s = std::sqrt(1.0 - z * z);
            const Vec3 w(s * std::cos(phi), s * std::sin(phi), z);
            ASSERT_EQ(light.pdf_w(w) > 0.0, light.radiance(w)[0] > 0.0);
        }
    }
    EXPECT_EQ(holm_rejected(suite), std::vector<std::string>{});
}

TEST(Environment, a_two_percent_error_of_its_image_is_seen) {
    const auto right = make_image(8, 4), wrong = make_image(8, 4);
    for (int i = 0; i < 32; ++i) {
        set_texel(*right, i % 8, i / 8, 1.0f);
        set_texel(*wrong, i % 8, i / 8, i < 16 ? 1.02f : 1.0f);
    }
    const EnvironmentLight sampled = environment(wrong), claimed = environment(right);
    const TestScene empty;
    const Geometry geometry(empty.meshes, empty.shapes);
    Rng rng(143, 0, 0);
    const SamplerCheck check = check_sampler(
        [&](Rng &r) -> std::optional<Vec3> {
            const auto drawn = sampled.sample(geometry, Vec3::Zero(), r);
            return drawn ? std::optional<Vec3>(drawn->wi) : std::nullopt;
        },
        [&](const Vec3 &w) { return claimed.pdf_w(w); }, 2000000, rng);
    EXPECT_LT(check.p_value, 0.01 * family_alpha);
}

/// Returns the image mean of a scene with an added light of the given kind.
BlockMean under_sky(TestScene scene, Kind kind, std::shared_ptr<const TextureImage> image,
                    Strategies strategies, uint64_t spp, uint32_t max_depth) {
    scene.add_light(kind, Rgb::Constant(2.0f));
    scene.lights.image.back() = std::move(image);
    ReferenceSettings settings =
        small_settings(4, 144 + static_cast<uint64_t>(strategies), strategies);
    settings.max_depth = max_depth;
    auto renderer = scene.renderer(settings);
    renderer.render(0, spp);
    return image_mean(renderer.develop(), "G");
}

TestScene plane_and_camera() {
    TestScene scene;
    Eigen::Matrix4d floor = Eigen::Matrix4d::Identity();
    floor.topLeftCorner<3, 3>() = Eigen::AngleAxisd(-0.5 * pi, Vec3::UnitX()).toRotationMatrix();
    scene.add_shape(ShapeArrays::Kind::plane, floor, scene.add_material(Rgb::Constant(0.5f)));
    scene.set_camera({0, 2, 3}, Vec3::Zero(), Vec3::UnitY(), 0.1);
    return scene;
}

TEST(Dome, over_a_plane_gives_albedo_times_its_radiance_and_misses_show_it) {
    auto white = make_image(3, 2);
    std::fill(white->floats.begin(), white->floats.end(), 1.0f);
    std::vector<Comparison> suite;
    for (const auto &[name, strategies] : strategies_names) {
        for (const Kind kind : {Kind::dome, Kind::environment}) {
            const BlockMean mean =
                under_sky(plane_and_camera(), kind, white, strategies, 1 << 14, 0);
            const double z = (mean.mean - 1.0) / std::hypot(std::sqrt(mean.variance), 1e-12);
            suite.push_back({name + std::string(kind == Kind::dome ? " dome" : " environment"),
                             normal_p_value(z)});
            TestScene sky = plane_and_camera();
            sky.set_camera({0, 2, 3}, {0, 5, 0}, Vec3::UnitY(), 0.1);
            EXPECT_NEAR(under_sky(sky, kind, white, strategies, 4, 0).mean, 2.0, 1e-12);
        }
    }
    EXPECT_EQ(holm_rejected(suite), std::vector<std::string>{});
}

TEST(Dome, glass_spheres_are_invisible_in_a_furnace) {
    for (const double eta : {1.0, 1.0 + 1e-6, 1.3, 1.9, 1.0 / 1.5}) {
        TestScene scene;
        scene.add_shape(ShapeArrays::Kind::sphere, placed(Vec3::Zero(), 1.0),
                        scene.add_material(smooth_glass(eta)));
        scene.set_camera({0, 0, 3}, Vec3::Zero(), Vec3::UnitY(), 0.5);
        const BlockMean mean = under_sky(scene, Kind::dome, nullptr, Strategies::mis, 4096, 0);
        // Russian roulette ends about one path in a million at each vertex. With 65536 paths, the
        // estimated variance may miss this, but one or two such events take 2 / 65536 each off the
        // mean.
        constexpr double rare = 1e-4;
        EXPECT_LT(std::abs(mean.mean - 2.0), 3.3 * std::sqrt(mean.variance) + rare) << eta;
        EXPECT_LT(std::sqrt(mean.variance), 0.01);
        // Inside the glass, radiance is eta^2 times as large.
        scene.set_camera({0, 0.2, 0.1}, {1, 0.3, 0.5}, Vec3::UnitY(), 0.3);
        const BlockMean inside = under_sky(scene, Kind::dome, nullptr, Strategies::mis, 4096, 0);
        EXPECT_LT(std::abs(inside.mean - 2.0 * eta * eta), 3.3 * std::sqrt(inside.variance) + rare)
            << eta;
    }
}

TEST(Dome, strategies_agree_under_a_contrasty_sky) {
    TestScene scene = plane_and_camera();
    scene.add_shape(ShapeArrays::Kind::sphere, placed({0, 0.3, 0}, 0.3),
                    scene.add_material(rough_glass(BxdfComponent::Distribution::ggx, 0.3, 1.5)));
    scene.add_shape(ShapeArrays::Kind::cone, placed({0.4, 0.1, 0.3}, 0.3),
                    scene.add_material({ward(0.2, 0.3)}));
    const auto image = contrasty_image(8, 4);
    const BlockMean hits =
        under_sky(scene, Kind::environment, image, Strategies::implicit_only, 1 << 16, 6);
    const BlockMean explicitly =
        under_sky(scene, Kind::environment, image, Strategies::explicit_only, 1 << 16, 6);
    const BlockMean both = under_sky(scene, Kind::environment, image, Strategies::mis, 1 << 15, 6);
    const auto p = [](const BlockMean &a, const BlockMean &b) {
        return normal_p_value((a.mean - b.mean) / std::sqrt(a.variance + b.variance));
    };
    EXPECT_EQ(holm_rejected({{"implicit = mis", p(hits, both)},
                             {"explicit = mis", p(explicitly, both)},
                             {"implicit = explicit", p(hits, explicitly)}}),
              std::vector<std::string>{});
    EXPECT_LT(std::sqrt(both.variance) / both.mean, 0.005);
}

}  // namespace
}  // namespace rtrays::reference
