// SPDX-License-Identifier: MIT
// Tests the opacity test: the share of rays that pass, the independence of decisions, and lookups.
#include "renderer/kernels/traversal/opacity.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>
#include <vector>

namespace rtrays {
namespace {

using Random = std::mt19937_64;

float3 random_vector(Random &random) {
    std::uniform_real_distribution<float> uniform(-1, 1);
    return make_float3(uniform(random), uniform(random), uniform(random));
}

/// Expects a binomial count with probability p, within 6 standard deviations.
void expect_share(double count, double n, double p) {
    EXPECT_NEAR(count, n * p, 6 * std::sqrt(n * p * (1 - p)) + 1e-9) << "p = " << p;
}

constexpr uint rays = 1 << 18;

TEST(Opacity, IsTheShareOfRaysThatAreStopped) {
    Random random(1);
    const std::vector<float> opacities = {0.0f, 1e-3f, 0.25f, 0.5f, 0.9f, 0.999f, 1.0f};
    std::vector<uint> stopped(opacities.size(), 0);
    for (uint i = 0; i < rays; ++i) {
        const uint4 ray = hash_of_ray(random_vector(random), random_vector(random));
        for (size_t k = 0; k < opacities.size(); ++k) {
            stopped[k] += is_stopped(ray, 7u, 0u, opacities[k]) ? 1 : 0;
        }
    }
    for (size_t k = 0; k < opacities.size(); ++k) {
        expect_share(stopped[k], rays, static_cast<double>(opacities[k]));
    }
    EXPECT_EQ(stopped.front(), 0u);
    EXPECT_EQ(stopped.back(), rays);
}

// Rays of a pinhole differ in the last bits of their direction alone; shadow rays of a directional
// light differ in their origin alone.
TEST(Opacity, DecidesIndependentlyForNeighbouringRays) {
    const float3 fixed = make_float3(0.25f, -3.0f, 1.0f);
    for (const bool moves : {false, true}) {
        uint stopped = 0, changes = 0;
        bool last = false;
        for (uint i = 0; i < rays; ++i) {
            const float3 other = make_float3(0.5f, as_float(as_uint(0.5f) + i), -0.5f);
            const bool now = is_stopped(
                moves ? hash_of_ray(other, fixed) : hash_of_ray(fixed, other), 3u, 0u, 0.3f);
            stopped += now ? 1 : 0;
            changes += i > 0 && now != last ? 1 : 0;
            last = now;
        }
        expect_share(stopped, rays, 0.3);
        expect_share(changes, rays - 1, 2 * 0.3 * 0.7);
    }
}

TEST(Opacity, DecidesIndependentlyForThePrimitivesOfARay) {
    Random random(2);
    // Two neighbouring primitives, two hits of one, and two with many bits apart.
    const uint pairs[][4] = {{0, 0, 1, 0}, {8, 0, 8, 1}, {5, 0, ~5u, 0}, {1024, 0, 4096, 0}};
    for (const auto &pair : pairs) {
        uint both = 0;
        for (uint i = 0; i < rays; ++i) {
            const uint4 ray = hash_of_ray(random_vector(random), random_vector(random));
            both +=
                is_stopped(ray, pair[0], pair[1], 0.3f) && is_stopped(ray, pair[2], pair[3], 0.3f)
                    ? 1
                    : 0;
        }
        expect_share(both, rays, 0.09);
    }
    // The transmittance of a stack.
    for (const uint sheets : {2u, 10u, 300u}) {
        const float opacity = 1.0f / static_cast<float>(sheets);
        uint passed = 0;
        for (uint i = 0; i < rays; ++i) {
            const uint4 ray = hash_of_ray(random_vector(random), random_vector(random));
            uint sheet = 0;
            while (sheet < sheets && !is_stopped(ray, sheet, 0u, opacity)) {
                ++sheet;
            }
            passed += sheet == sheets ? 1 : 0;
        }
        expect_share(passed, rays, std::pow(1 - static_cast<double>(opacity), sheets));
    }
}

/// The opacity test of a scene with one textured opacity and one triangle, whose texture
/// coordinates are its barycentrics.
struct OneTriangle {
    uint mask = 0;
    MaskedTriangle masked{{{0, 0}, {1, 0}, {0, 1}}, 0, 0};
    OpacityRecord record{};
    std::vector<float> texels;
    OpacityTest test = all_opaque();

    OneTriangle(std::vector<float> with_texels, uint flags) : texels(std::move(with_texels)) {
        record.texture = {0, 2, 2, flags, {1, 1}, {0, 0}};
        record.opacity = 1;
        test.triangle_masks = &mask;
        test.masked_triangles = &masked;
        test.opacities = &record;
        test.texels = texels.data();
        test.ray = hash_of_ray(make_float3(1, 2, 3), make_float3(4, 5, 6));
    }
};

TEST(Opacity, OfATextureOfOnesOrZerosIsExact) {
    Random random(3);
    std::uniform_real_distribution<float> uniform(0, 0.5f);
    for (const uint flags : {0u, TEXTURE_BILINEAR, TEXTURE_BILINEAR | TEXTURE_CLAMP}) {
        for (const float value : {0.0f, 1.0f}) {
            const OneTriangle one(std::vector<float>(4, value), flags);
            for (int i = 0; i < 100000; ++i) {
                const float u = uniform(random), v = uniform(random);
                ASSERT_EQ(opacity_at(&one.test, 0, make_float2(u, v)), value);
                ASSERT_EQ(triangle_stops(&one.test, 0, u, v), value == 1.0f);
            }
        }
    }
}

TEST(Opacity, IsLookedUpAtTheTextureCoordinatesOfTheHit) {
    // Rows from the top: the upper left and the lower right texel stop rays.
    const OneTriangle one({1, 0, 0, 1}, 0);
    EXPECT_FALSE(triangle_stops(&one.test, 0, 0.25f, 0.25f));
    EXPECT_TRUE(triangle_stops(&one.test, 0, 0.25f, 0.75f));
    EXPECT_TRUE(triangle_stops(&one.test, 0, 0.75f, 0.25f));
}

TEST(Opacity, WithACutoffIsZeroOrOne) {
    OneTriangle one({0, 1, 0, 1}, TEXTURE_BILINEAR | TEXTURE_CLAMP);
    one.record.cutoff = 0.5f;
    EXPECT_EQ(opacity_at(&one.test, 0, make_float2(0.5f, 0.3f)), 1.0f) << "on the cutoff";
    EXPECT_EQ(opacity_at(&one.test, 0, make_float2(0.499f, 0.3f)), 0.0f);
    one.record.opacity = 0.8f;
    EXPECT_EQ(opacity_at(&one.test, 0, make_float2(0.55f, 0.3f)), 0.0f);
    EXPECT_EQ(opacity_at(&one.test, 0, make_float2(0.7f, 0.3f)), 1.0f);
}

}  // namespace
}  // namespace rtrays
