// SPDX-License-Identifier: MIT
// Tests the normals that maps of normals and heights tilt, and their shadowing, against closed
// forms. Uses the device code compiled for the host.
#include <gtest/gtest.h>

#include "renderer/testing/bsdf_cases.h"
#include "renderer/testing/float_traps.h"
#include "renderer/testing/mapped_triangle.h"

namespace rtrays {
namespace {

const float3 above = make_float3(0, 0, 1);

void expect_vector(float3 found, float3 expected, const char *what = "") {
    const float3 difference = found - expected;
    EXPECT_LT(std::sqrt(dot(difference, difference)), 1e-5f)
        << what << ": " << found.x << ", " << found.y << ", " << found.z << " instead of "
        << expected.x << ", " << expected.y << ", " << expected.z;
}

TEST(NormalMap, TexelsAreNormalsInTheFrameOfTheTangentAndTheNormal) {
    MappedTriangle triangle;
    triangle.set_texel(make_float3(0.3f, -0.2f, 0.5f));
    expect_vector(triangle.frame(above).ns, normalize(make_float3(0.3f, -0.2f, 0.5f)));
    triangle.map.scale = 0.5f;
    expect_vector(triangle.frame(above).ns, normalize(make_float3(0.15f, -0.1f, 0.5f)), "scale");
    triangle.map.scale = 0.0f;
    expect_vector(triangle.frame(above).ns, above, "no tilt");
    triangle.map.scale = 1.0f;
    // u along y and v against x: x of the texel is along y.
    triangle.uvs = {{{0, 0}, {0, -2}, {3, 0}}};
    expect_vector(triangle.frame(above).ns, normalize(make_float3(0.2f, 0.3f, 0.5f)), "turned");
    // The normal of the vertices is the axis, and dp/du is made perpendicular to it.
    triangle.uvs = {{{0, 0}, {1, 0}, {0, 1}}};
    const float3 inclined = normalize(make_float3(1, 0, 1));
    triangle.set_smooth_normal(inclined);
    triangle.set_texel(make_float3(0.5f, 0, 0.5f));
    expect_vector(triangle.frame(inclined).ns, make_float3(1, 0, 0), "bent");
    triangle.set_smooth_normal(-inclined);
    expect_vector(triangle.frame(inclined).ns, make_float3(1, 0, 0),
                  "opposite normals of vertices");
}

TEST(NormalMap, MirroredCoordinatesFollowTheNormalOrDpDv) {
    MappedTriangle triangle;
    triangle.set_texel(make_float3(0.3f, 0.4f, 0.5f));
    triangle.uvs = {{{0, 0}, {-1, 0}, {0, 1}}};
    expect_vector(triangle.frame(above).ns, normalize(make_float3(-0.3f, -0.4f, 0.5f)));
    triangle.map.flags = NORMAL_MAP_FOLLOWS_V;
    expect_vector(triangle.frame(above).ns, normalize(make_float3(-0.3f, 0.4f, 0.5f)));
    triangle.uvs = {{{0, 0}, {1, 0}, {0, 1}}};
    expect_vector(triangle.frame(above).ns, normalize(make_float3(0.3f, 0.4f, 0.5f)));
    // A mirrored instance has the other order of vertices, so that its front remains the front.
    triangle.set_corners(make_float3(0, 0, 0), make_float3(0, 1, 0), make_float3(-1, 0, 0));
    triangle.uvs = {{{0, 0}, {0, 1}, {1, 0}}};
    expect_vector(triangle.frame(above).ns, normalize(make_float3(-0.3f, 0.4f, 0.5f)));
}

TEST(NormalMap, TheBackSinksWhereTheFrontRisesUnlessItIsMirrored) {
    MappedTriangle triangle;
    triangle.set_texel(make_float3(0.3f, -0.2f, 0.5f));
    const float3 below = make_float3(0, 0, -1);
    expect_vector(triangle.frame(below).ns, normalize(make_float3(-0.3f, 0.2f, -0.5f)));
    EXPECT_EQ(triangle.frame(below).front, 0u);
    triangle.map.flags = NORMAL_MAP_MIRRORED_BACK;
    expect_vector(triangle.frame(below).ns, normalize(make_float3(0.3f, -0.2f, -0.5f)));
    expect_vector(triangle.frame(above).ns, normalize(make_float3(0.3f, -0.2f, 0.5f)));
}

TEST(NormalMap, TheTiltIsReversedBelowTheHorizon) {
    MappedTriangle triangle;
    triangle.set_texel(make_float3(0.8f, 0, 0.2f));
    const float3 n = normalize(make_float3(0.8f, 0, 0.2f));
    const float3 reversed = normalize(make_float3(-0.8f, 0, 0.2f));
    const float3 behind = normalize(make_float3(-1, 0, 0.1f));
    expect_vector(triangle.frame(make_float3(0.6f, 0, 0.8f)).ns, n);
    expect_vector(triangle.frame(behind).ns, reversed);
    expect_vector(triangle.frame(-behind).ns, -reversed, "from behind");
    triangle.map.flags = NORMAL_MAP_MIRRORED_BACK;
    expect_vector(triangle.frame(make_float3(-1, 0, -0.1f)).ns,
                  normalize(make_float3(-0.8f, 0, -0.2f)), "from behind, mirrored");
    expect_vector(triangle.frame(make_float3(1, 0, -0.1f)).ns,
                  normalize(make_float3(0.8f, 0, -0.2f)), "from behind, mirrored");
    // A normal that points into the surface is seen from the side where that is possible, with one
    // tilt or the other. Otherwise the geometric normal applies.
    triangle.map.flags = 0;
    triangle.set_texel(make_float3(0.8f, 0, -0.2f));
    const float3 inwards = normalize(make_float3(0.8f, 0, -0.2f));
    expect_vector(triangle.frame(normalize(make_float3(1, 0, 0.1f))).ns, inwards);
    expect_vector(triangle.frame(normalize(make_float3(-1, 0, 0.1f))).ns,
                  normalize(make_float3(-0.8f, 0, -0.2f)));
    expect_vector(triangle.frame(above).ns, above);
}

TEST(NormalMap, WithoutADirectionTheNormalOfTheSurfaceApplies) {
    MappedTriangle triangle;
    const float3 smooth = normalize(make_float3(0.3f, 0.1f, 1));
    triangle.set_smooth_normal(smooth);
    triangle.set_texel(make_float3(0, 0, 0));
    expect_vector(triangle.frame(above).ns, smooth, "a normal of no length");
    triangle.set_texel(make_float3(0, 0, 1));
    expect_vector(triangle.frame(above).ns, smooth, "a flat map");
    const test::InvalidAllowed values_that_overflow;
    triangle.texels.assign(3, as_uint(3e38f));
    expect_vector(triangle.frame(above).ns, smooth, "overflow");
}

TEST(NormalMap, CoordinatesWithoutAreaUseTheFirstEdge) {
    MappedTriangle triangle;
    triangle.set_texel(make_float3(0.3f, -0.2f, 0.5f));
    for (const float v : {0.0f, 1.0f}) {
        triangle.uvs = {{{0.5f, v}, {0.5f, v}, {0.5f, v}}};
        expect_vector(triangle.frame(above).ns, normalize(make_float3(0.3f, -0.2f, 0.5f)));
    }
    triangle.set_heights(2, 2, {0, 1, 5, 9});
    expect_vector(triangle.frame(above).ns, above, "heights have no slope");
}

/// Returns the normal of the surface that heights displace, in double precision: the product of
/// the derivatives of p + h n.
Eigen::Vector3d displaced_normal(const Eigen::Vector3d &dp_du, const Eigen::Vector3d &dp_dv,
                                 const Eigen::Vector3d &n, double dh_du, double dh_dv) {
    const Eigen::Vector3d u = dp_du + (dh_du - dp_du.dot(n)) * n;
    const Eigen::Vector3d v = dp_dv + (dh_dv - dp_dv.dot(n)) * n;
    const Eigen::Vector3d product = u.cross(v).normalized();
    return product.dot(n) < 0 ? Eigen::Vector3d(-product) : product;
}

TEST(BumpMap, TiltsLikeTheDisplacedSurface) {
    const std::vector<float> heights = {0.5f, 0.25f, 0.125f, 0.75f, 0.0f, 1.0f};
    const auto at = [&](int row, int column) {
        return static_cast<double>(heights[static_cast<size_t>(3 * row + column)]);
    };
    for (const bool mirrored : {false, true}) {
        for (const double scale : {0.02, -0.05, 0.4}) {
            MappedTriangle triangle;
            triangle.set_corners(make_float3(1, 2, 3), make_float3(1.5f, 2.25f, 3.5f),
                                 make_float3(0.5f, 3, 3.25f));
            triangle.uvs = {{{0, 0}, {mirrored ? -0.5f : 0.5f, 0}, {0, 1}}};
            const Eigen::Vector3d dp_du = (mirrored ? -2.0 : 2.0) * Eigen::Vector3d(0.5, 0.25, 0.5);
            const Eigen::Vector3d dp_dv(-0.5, 1, 0.25);
            const Eigen::Vector3d ng = Eigen::Vector3d(0.5, 0.25, 0.5).cross(dp_dv).normalized();
            const Eigen::Vector3d n = (ng + Eigen::Vector3d(0.2, -0.1, 0.3)).normalized();
            triangle.set_smooth_normal(make_float3(
                static_cast<float>(n.x()), static_cast<float>(n.y()), static_cast<float>(n.z())));
            triangle.set_heights(3, 2, heights);
            triangle.map.scale = static_cast<float>(scale);
            triangle.texture.uv_scale[0] = 2;
            triangle.texture.uv_offset[0] = mirrored ? 0.75f : 0.25f;
            // At u = 1/4 of the edge the image is looked up in the middle of its columns.
            const double s = mirrored ? -0.5 : 0.5;
            const double image_u = 2 * 0.25 * s + (mirrored ? 0.75 : 0.25);
            ASSERT_NEAR(image_u, 0.5, 1e-12);
            const double v = 0.5;  // between the rows
            // Columns 1 and 1: between texel centres the derivative jumps, so move a little.
            const float step = 0.02f;
            const double column =
                (2 * (0.25 + static_cast<double>(step)) * s + (mirrored ? 0.75 : 0.25)) * 3 - 0.5;
            const int left = static_cast<int>(std::floor(column));
            const double t = column - left;
            const double dh_dx =
                0.5 * (at(0, left + 1) - at(0, left)) + 0.5 * (at(1, left + 1) - at(1, left));
            const double dh_dy =
                (1 - t) * (at(0, left) - at(1, left)) + t * (at(0, left + 1) - at(1, left + 1));
            const Eigen::Vector3d expected =
                displaced_normal(dp_du, dp_dv, n, scale * dh_dx * 3 * 2, scale * dh_dy * 2);
            const float3 wo =
                make_float3(static_cast<float>(expected.x()), static_cast<float>(expected.y()),
                            static_cast<float>(expected.z()));
            expect_vector(triangle.frame(wo, 0.25f + step, static_cast<float>(v)).ns, wo,
                          mirrored ? "mirrored" : "");
        }
    }
}

TEST(BumpMap, HugeHeightsTurnTheNormalIntoTheSurface) {
    MappedTriangle triangle;
    triangle.set_heights(2, 1, {0, 1});
    triangle.map.scale = 1e6f;
    expect_vector(triangle.frame(normalize(make_float3(-1, 0, 0.1f)), 0.5f).ns,
                  make_float3(-1, 0, 0), "seen from the slope");
    expect_vector(triangle.frame(normalize(make_float3(1, 0, 0.1f)), 0.5f).ns, make_float3(1, 0, 0),
                  "reversed");
    const test::InvalidAllowed values_that_overflow;
    triangle.map.scale = 3e38f;
    expect_vector(triangle.frame(above, 0.5f).ns, above, "overflow");
    triangle.map.scale = 1e6f;
    triangle.texture.flags = TEXTURE_FLOAT;
    expect_vector(triangle.frame(above, 0.5f).ns, above, "steps have no slope");
}

TEST(NormalMap, ShadowingIsThatOfGgx) {
    MappedTriangle triangle;
    triangle.set_texel(make_float3(0.6f, 0, 0.8f));
    const float3 light = normalize(make_float3(0.3f, 0.4f, 0.25f));
    const auto shadowing = [&](float3 wo, float3 wi) {
        const SurfaceFrame frame = triangle.frame(wo);
        return static_cast<double>(map_shadowing(frame, to_local(frame, wi)));
    };
    EXPECT_EQ(shadowing(above, light), 1.0) << "not wanted";
    triangle.map.flags = NORMAL_MAP_SHADOWING;
    const auto expected = [](double tan2_tilt, double tan2_light) {
        return 2 / (1 + std::sqrt(1 + std::min(tan2_tilt / 8, 1.0) * tan2_light));
    };
    const double tan2_light = 0.25 / 0.0625;
    EXPECT_NEAR(shadowing(above, light), expected(0.5625, tan2_light), 1e-6);
    EXPECT_NEAR(shadowing(above, -light), expected(0.5625, tan2_light), 1e-6);
    // The tilt that is reversed for wo does not change it.
    EXPECT_NEAR(shadowing(normalize(make_float3(-1, 0, 0.1f)), light), expected(0.5625, tan2_light),
                1e-6);
    EXPECT_EQ(shadowing(above, above), 1.0);
    triangle.set_texel(make_float3(1, 0, 0));
    EXPECT_NEAR(shadowing(normalize(make_float3(1, 0, 1)), light), expected(8, tan2_light), 1e-6);
    triangle.set_texel(above);
    EXPECT_EQ(shadowing(above, light), 1.0) << "no tilt";
}

// A white furnace: whatever the map, no more light leaves than arrives.
TEST(NormalMap, ReturnsAtMostTheLightThatArrives) {
    const std::vector<TestMaterial> materials = {
        {"lambert", {component(BXDF_LAMBERT)}},
        {"ggx", {rough(BXDF_MICROFACET_REFLECTION, 0.3f, 0.3f)}},
        rough_glass("glass", 0.4f, 0.4f, 0)};
    constexpr uint32_t samples = 100'000;
    uint32_t block = 900;
    double least = 1;
    for (const TestMaterial &material : materials) {
        for (const float3 texel :
             {make_float3(0.2f, 0.1f, 0.9f), make_float3(0.8f, 0.1f, 0.3f),
              make_float3(-0.9f, 0.1f, 0.01f), make_float3(0.7f, 0.2f, -0.3f)}) {
            MappedTriangle triangle;
            triangle.set_texel(texel);
            triangle.map.flags = block % 2 == 0 ? NORMAL_MAP_SHADOWING : 0u;
            for (const float3 wo : {above, normalize(make_float3(1, 0.2f, 0.3f)),
                                    normalize(make_float3(0, 1, -0.5f))}) {
                ++block;
                double sum = 0, squares = 0;
                for (uint32_t i = 0; i < samples; ++i) {
                    const uint4 words = bsdf_words(i, block);
                    const BsdfSample s =
                        material.sample(triangle.frame(wo), uniform_float(words.x),
                                        uniform_float(words.y), uniform_float(words.z));
                    const double scale = static_cast<double>(s.scale);
                    const double weight =
                        s.pdf_w > 0.0f ? static_cast<double>(s.weight.x) / scale : 0.0;
                    sum += weight;
                    squares += weight * weight;
                }
                const double mean = sum / samples;
                const double error = std::sqrt((squares / samples - mean * mean) / samples);
                EXPECT_LT(mean, 1 + 4 * error + 1e-4) << material.name;
                least = std::min(least, mean);
            }
        }
    }
    EXPECT_LT(least, 0.9) << "light is lost below the horizon of the surface";
}

}  // namespace
}  // namespace rtrays
