// SPDX-License-Identifier: MIT
#include "reference/renderer.h"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <cmath>
#include <limits>

#include "reference/film.h"
#include "reference/tests/test_scenes.h"
#include "renderer/base/error.h"

namespace rtrays::reference {
namespace {

/// Expects that all channels of both images are equal bit by bit.
void expect_same_bits(const Image &a, const Image &b) {
    ASSERT_EQ(a.channels().size(), b.channels().size());
    for (size_t i = 0; i < a.channels().size(); ++i) {
        EXPECT_EQ(a.channels()[i].values, b.channels()[i].values) << a.channels()[i].name;
    }
}

Image render(int threads, const std::vector<uint64_t> &stops) {
    ReferenceSettings settings = small_settings(48, 81);
    settings.threads = threads;
    auto renderer = cornell_like_box().renderer(settings);
    uint64_t done = 0;
    for (const uint64_t stop : stops) {
        done = renderer.render(done, stop);
    }
    return renderer.develop();
}

TEST(ReferenceRenderer, bits_do_not_depend_on_threads) {
    const Image one = render(1, {32});
    expect_same_bits(one, render(2, {32}));
    expect_same_bits(one, render(5, {32}));
}

TEST(ReferenceRenderer, bits_do_not_depend_on_how_the_range_is_cut) {
    expect_same_bits(render(2, {32}), render(2, {1, 2, 7, 31, 32}));
}

TEST(ReferenceRenderer, bits_do_not_depend_on_being_restored) {
    const TestScene scene = cornell_like_box();
    auto first = scene.renderer(small_settings(48, 81));
    first.render(0, 13);
    auto second = scene.renderer(small_settings(48, 81));
    second.restore(first.film(), first.seconds());
    EXPECT_EQ(second.samples(), 13u);
    second.render(13, 32);
    expect_same_bits(second.develop(), render(2, {32}));
    EXPECT_GT(second.seconds(), first.seconds());
}

TEST(ReferenceRenderer, seeds_and_ranges_give_other_samples) {
    const TestScene scene = cornell_like_box();
    const auto red = [&](uint64_t seed, uint64_t begin, uint64_t end) {
        auto renderer = scene.renderer(small_settings(16, seed));
        renderer.render(begin, end);
        return renderer.develop().channel("R");
    };
    const auto first = red(1, 0, 4);
    EXPECT_NE(red(2, 0, 4), first);
    EXPECT_NE(red(1, 4, 8), first);
    EXPECT_EQ(red(1, 0, 4), first);
}

TEST(ReferenceRenderer, refuses_samples_that_it_has) {
    auto renderer = cornell_like_box().renderer(small_settings(16, 1));
    renderer.render(0, 4);
    EXPECT_THROW(renderer.render(3, 8), Error);
    EXPECT_EQ(renderer.samples(), 4u);
}

TEST(ReferenceRenderer, bits_do_not_depend_on_the_order_of_ranges) {
    auto renderer = cornell_like_box().renderer(small_settings(48, 81));
    for (const SampleRange range : {SampleRange{30, 32}, {0, 7}, {8, 30}, {7, 8}}) {
        renderer.render(range.begin, range.end);
    }
    expect_same_bits(renderer.develop(), render(2, {32}));
}

TEST(ReferenceRenderer, counts_samples_and_rays) {
    auto renderer = cornell_like_box().renderer(small_settings(16, 1));
    renderer.render(0, 4);
    const ReferenceStats stats = renderer.stats();
    EXPECT_EQ(stats.camera_rays, 16u * 16u * 4u);
    EXPECT_GT(stats.bounce_rays, 0u);
    EXPECT_GT(stats.shadow_rays, 0u);
    EXPECT_GT(stats.seconds, 0.0);
    EXPECT_EQ(stats.engine.rfind("embree 3.", 0), 0u);
    EXPECT_EQ(renderer.develop().channel("samples")[7], 4.0f);
}

TEST(ReferenceRenderer, sums_the_largest_radiance_and_refuses_an_infinite_one) {
    TestScene scene = furnace_box(0.5f, Rgb::Constant(std::numeric_limits<float>::max()));
    // The largest float is finite, and so are sums of it over a path in double.
    auto renderer = scene.renderer(small_settings(8, 1));
    EXPECT_NO_THROW(renderer.render(0, 4));
    scene.lights.radiance[0].setConstant(std::numeric_limits<float>::infinity());
    EXPECT_THROW(scene.renderer(small_settings(8, 1)), Error);
}

TEST(ReferenceRenderer, refuses_materials_out_of_range) {
    TestScene scene = cornell_like_box();
    scene.materials.component[0].weight = Rgb::Constant(1.5f);
    EXPECT_THROW(scene.renderer(small_settings(8, 1)), Error);
    scene = cornell_like_box();
    scene.meshes.material[0] = no_index;
    EXPECT_THROW(scene.renderer(small_settings(8, 1)), Error);
}

/// Renders a box and a sun from `distance`, with a view that shows three units.
Image from_afar(double distance) {
    TestScene scene;
    const uint32_t white = scene.add_material(Rgb::Constant(0.5f));
    scene.add_box(Vec3(-0.6, -0.6, -0.6), Vec3(0.6, 0.6, 0.6), false, white);
    scene.add_shape(ShapeArrays::Kind::sphere, placed(Vec3(0.9, 0.8, 0.2), 0.3), white);
    const uint32_t sun = scene.add_light(LightArrays::Kind::directional, Rgb::Constant(3));
    scene.lights.world_from_light[sun].topLeftCorner<3, 3>() =
        Eigen::AngleAxisd(-0.7, Vec3::UnitX()).toRotationMatrix();
    scene.set_camera(Vec3(0.36, 0.48, 0.8) * distance, Vec3::Zero(), Vec3::UnitY(),
                     2 * std::atan(1.5 / distance));
    auto renderer = scene.renderer(small_settings(32, 1));
    renderer.render(0, 16);
    return renderer.develop();
}

// All random numbers are the same, and so is the perspective up to a ten-thousandth.
TEST(ReferenceRenderer, far_cameras_give_the_image_of_a_nearer_one) {
    const std::vector<float> near = from_afar(3e4).channel("G");
    double sum = 0;
    for (const float value : near) {
        sum += static_cast<double>(value);
    }
    EXPECT_GT(sum, 32);
    for (const double distance : {3e5, 3e6, 3e9}) {
        const std::vector<float> far = from_afar(distance).channel("G");
        double differences = 0;
        for (size_t i = 0; i < near.size(); ++i) {
            differences += std::abs(static_cast<double>(near[i]) - static_cast<double>(far[i]));
        }
        EXPECT_LT(differences / sum, 1e-3) << distance;
    }
}

TEST(ReferenceRenderer, windows_have_the_bits_of_the_full_picture) {
    const TestScene scene = cornell_like_box();
    ReferenceSettings settings = small_settings(12, 3);
    auto full = scene.renderer(settings);
    full.render(0, 3);
    settings.full_width = settings.full_height = 12;
    settings.width = 5;
    settings.height = 4;
    settings.crop_x = 6;
    settings.crop_y = 7;
    auto part = scene.renderer(settings);
    part.render(0, 3);
    const std::vector<FirstHit> hits = full.first_hits(), hits_of_part = part.first_hits();
    for (size_t y = 0; y < 4; ++y) {
        for (size_t x = 0; x < 5; ++x) {
            EXPECT_TRUE((part.film().pixels[5 * y + x].mean(3) ==
                         full.film().pixels[12 * (y + 7) + x + 6].mean(3))
                            .all());
            EXPECT_EQ(hits_of_part[5 * y + x], hits[12 * (y + 7) + x + 6]);
        }
    }
}

}  // namespace
}  // namespace rtrays::reference
