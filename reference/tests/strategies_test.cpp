// SPDX-License-Identifier: MIT
// The strategies implicit, explicit and mis estimate the same image. They are compared per 16x16
// block and on the mean.
#include <gtest/gtest.h>

#include "reference/tests/statistics.h"
#include "reference/tests/test_scenes.h"
#include "renderer/base/error.h"

namespace rtrays::reference {
namespace {

Image render(const TestScene &scene, Strategies strategies, uint64_t seed, uint64_t spp,
             uint32_t max_depth) {
    ReferenceSettings settings = small_settings(64, seed, strategies);
    settings.max_depth = max_depth;
    auto renderer = scene.renderer(settings);
    renderer.render(0, spp);
    return renderer.develop();
}

/// Returns the comparisons that Holm's procedure rejects among all pairs of strategies.
std::vector<std::string> disagreements(const TestScene &scene, uint32_t max_depth, uint64_t seed) {
    const Image by_hits = render(scene, Strategies::implicit_only, seed, 1024, max_depth);
    const Image by_sampling = render(scene, Strategies::explicit_only, seed + 1, 256, max_depth);
    const Image by_both = render(scene, Strategies::mis, seed + 2, 256, max_depth);
    std::vector<Comparison> suite;
    compare_images("implicit = explicit", by_hits, by_sampling, suite);
    compare_images("implicit = mis", by_hits, by_both, suite);
    compare_images("explicit = mis", by_sampling, by_both, suite);
    return holm_rejected(suite);
}

TEST(Strategies, agree_on_a_cornell_box) {
    EXPECT_EQ(disagreements(cornell_like_box(), 0, 61), std::vector<std::string>{});
}

TEST(Strategies, agree_on_direct_light_and_on_two_bounces) {
    EXPECT_EQ(disagreements(cornell_like_box(), 1, 64), std::vector<std::string>{});
    EXPECT_EQ(disagreements(cornell_like_box(), 2, 67), std::vector<std::string>{});
}

TEST(Strategies, agree_with_several_lights_of_different_power) {
    TestScene scene = cornell_like_box();
    scene.add_quad({Vec3(0.01, 1, 3), Vec3(0.01, 2, 3), Vec3(0.01, 2, 4), Vec3(0.01, 1, 4)}, 0,
                   {0.3f, 0.6f, 2.0f});
    scene.add_box({4.0, 3.0, 1.0}, {4.5, 3.5, 1.5}, false, 0, {3.0f, 0.0f, 0.0f});
    EXPECT_EQ(disagreements(scene, 0, 70), std::vector<std::string>{});
}

TEST(Strategies, the_comparison_sees_half_a_percent) {
    // The light is 0.5 % brighter in one of two images of many samples.
    TestScene brighter = cornell_like_box();
    for (Rgb &radiance : brighter.lights.radiance) {
        radiance *= 1.005f;
    }
    std::vector<Comparison> suite;
    compare_images("planted", render(cornell_like_box(), Strategies::mis, 73, 512, 0),
                   render(brighter, Strategies::mis, 74, 512, 0), suite);
    EXPECT_NE(holm_rejected(suite), std::vector<std::string>{});
}

TEST(Strategies, agree_without_roulette_and_trace_two_rays_per_event) {
    constexpr uint32_t depth = 3;
    ReferenceSettings settings = small_settings(64, 75, Strategies::explicit_only);
    settings.max_depth = depth;
    settings.roulette = false;
    const TestScene scene = cornell_like_box();
    auto renderer = scene.renderer(settings);
    renderer.render(0, 256);
    std::vector<Comparison> suite;
    compare_images("without = with roulette", renderer.develop(),
                   render(scene, Strategies::mis, 76, 256, depth), suite);
    EXPECT_EQ(holm_rejected(suite), std::vector<std::string>{});
    // Paths end early only if they leave the box, hit the back of a surface or point away from the
    // light.
    const ReferenceStats stats = renderer.stats();
    EXPECT_LE(stats.bounce_rays, (depth - 1) * stats.camera_rays)
        << "the last event traces no bounce ray";
    EXPECT_LE(stats.shadow_rays, depth * stats.camera_rays);
    EXPECT_GT(stats.bounce_rays, stats.camera_rays);
    settings.max_depth = 0;
    EXPECT_THROW(scene.renderer(settings), Error);
}

TEST(Strategies, names_go_both_ways) {
    for (const auto &[name, value] : strategies_names) {
        EXPECT_EQ(strategies_from_name(name), value);
        EXPECT_EQ(name_of(value), name);
    }
    EXPECT_THROW(strategies_from_name("naive"), Error);
}

}  // namespace
}  // namespace rtrays::reference
