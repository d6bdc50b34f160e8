// SPDX-License-Identifier: MIT
#include "reference/texture.h"

#include <gtest/gtest.h>

#include "renderer/base/error.h"

namespace rtrays::reference {
namespace {

using Filter = TextureArrays::Filter;
using Wrap = TextureArrays::Wrap;

/// Returns two columns and two rows of texels. Red is 1 2 over 3 4 (from the top), green is its
/// tenth.
TextureArrays four_texels(Filter filter, Wrap wrap) {
    auto image = std::make_shared<TextureImage>();
    image->width = image->height = 2;
    for (const float value : {1.0f, 2.0f, 3.0f, 4.0f}) {
        image->floats.insert(image->floats.end(), {value, 0.1f * value, 0.0f});
    }
    return {{"t"}, {image}, {filter}, {wrap}, {{1.0, 1.0}}, {{0.0, 0.0}}};
}

double red(const TextureArrays &textures, double u, double v) {
    return Texture(textures, 0).evaluate(Eigen::Vector2d(u, v))[0];
}

TEST(Texture, nearest_starts_at_the_lower_left_corner) {
    const TextureArrays t = four_texels(Filter::nearest, Wrap::repeat);
    EXPECT_EQ(red(t, 0.1, 0.1), 3.0);
    EXPECT_EQ(red(t, 0.9, 0.1), 4.0);
    EXPECT_EQ(red(t, 0.1, 0.9), 1.0);
    EXPECT_EQ(red(t, 0.9, 0.9), 2.0);
    EXPECT_FLOAT_EQ(static_cast<float>(Texture(t, 0).evaluate(Eigen::Vector2d(0.9, 0.9))[1]), 0.2f);
    EXPECT_EQ(red(t, 1.1, -0.1), 1.0);  // repeated
    EXPECT_EQ(red(t, -5.9, 7.1), 3.0);
    EXPECT_TRUE(std::isfinite(red(t, 1e300, -1e300)));
}

TEST(Texture, bilinear_meets_the_texels_at_their_centres) {
    const TextureArrays t = four_texels(Filter::bilinear, Wrap::repeat);
    EXPECT_EQ(red(t, 0.25, 0.25), 3.0);
    EXPECT_EQ(red(t, 0.75, 0.75), 2.0);
    EXPECT_DOUBLE_EQ(red(t, 0.5, 0.5), 2.5);
    EXPECT_DOUBLE_EQ(red(t, 0.375, 0.25), 3.25);
    EXPECT_DOUBLE_EQ(red(t, 0.0, 0.25), 3.5);  // between the right and the left column
}

TEST(Texture, colours_of_vertices_multiply_the_image) {
    TextureArrays t = four_texels(Filter::nearest, Wrap::repeat);
    const TexturePoint point(Eigen::Vector2d(0.9, 0.1), Spectrum(0.5, 0.25, 1.0));
    EXPECT_EQ(Texture(t, 0).evaluate(point)[0], 4.0);
    t.vertex_colours = {1};
    EXPECT_EQ(Texture(t, 0).evaluate(point)[0], 2.0);
    EXPECT_FLOAT_EQ(static_cast<float>(Texture(t, 0).evaluate(point)[1]), 0.1f);
    EXPECT_EQ(Texture(t, 0).evaluate(point.uv)[0], 4.0);
}

TEST(Texture, clamping_repeats_the_border) {
    const TextureArrays nearest = four_texels(Filter::nearest, Wrap::clamp);
    EXPECT_EQ(red(nearest, -3.0, 1.0), 1.0);
    EXPECT_EQ(red(nearest, 1.0, 0.0), 4.0);
    const TextureArrays bilinear = four_texels(Filter::bilinear, Wrap::clamp);
    EXPECT_EQ(red(bilinear, 0.0, 0.0), 3.0);
    EXPECT_EQ(red(bilinear, 9.0, 9.0), 2.0);
}

TEST(Texture, mirroring_turns_back_at_every_edge) {
    const TextureArrays nearest = four_texels(Filter::nearest, Wrap::mirror);
    for (const double u : {0.1, 0.4, 0.6, 0.9}) {
        for (const double v : {0.2, 0.7}) {
            EXPECT_EQ(red(nearest, 2.0 - u, v), red(nearest, u, v));
            EXPECT_EQ(red(nearest, -u, -v), red(nearest, u, v));
            EXPECT_EQ(red(nearest, u + 4.0, v - 6.0), red(nearest, u, v));
        }
    }
    const TextureArrays bilinear = four_texels(Filter::bilinear, Wrap::mirror);
    EXPECT_EQ(red(bilinear, 0.0, 0.0), 3.0);
    EXPECT_DOUBLE_EQ(red(bilinear, 1.5, 1.0), 1.5);
}

TEST(Texture, scale_comes_before_offset) {
    TextureArrays t = four_texels(Filter::nearest, Wrap::clamp);
    t.uv_scale[0] = {0.5, 2.0};
    t.uv_offset[0] = {0.4, -1.0};
    EXPECT_EQ(red(t, 0.3, 0.55), 4.0);  // (0.55, 0.1)
    EXPECT_EQ(red(t, 0.1, 0.8), 1.0);   // (0.45, 0.6)
}

TEST(Texture, bytes_are_decoded_before_they_are_interpolated) {
    auto image = std::make_shared<TextureImage>();
    image->width = 2;
    image->height = 1;
    image->bytes = {0, 128, 255, 255, 10, 0};
    TextureArrays t{{"t"}, {image}, {Filter::bilinear}, {Wrap::clamp}, {{1.0, 1.0}}, {{0.0, 0.0}}};
    EXPECT_NEAR(Texture(t, 0).evaluate(Eigen::Vector2d(0.25, 0.5))[1], 128.0 / 255.0, 1e-15);
    image->srgb = true;
    const Spectrum left = Texture(t, 0).evaluate(Eigen::Vector2d(0.25, 0.5));
    EXPECT_EQ(left[0], 0.0);
    EXPECT_NEAR(left[1], 0.2158605, 1e-7);  // 128 decoded by IEC 61966-2-1
    EXPECT_EQ(left[2], 1.0);
    EXPECT_NEAR(Texture(t, 0).evaluate(Eigen::Vector2d(0.75, 0.5))[1], 10.0 / 255.0 / 12.92, 1e-15);
    EXPECT_DOUBLE_EQ(Texture(t, 0).evaluate(Eigen::Vector2d(0.5, 0.5))[0], 0.5);
}

TEST(Texture, refuses_broken_images) {
    TextureArrays t = four_texels(Filter::nearest, Wrap::repeat);
    auto image = std::make_shared<TextureImage>(*t.image[0]);
    image->floats[4] = -1.0f;
    t.image[0] = image;
    EXPECT_THROW(Texture(t, 0), Error);
    image->floats.pop_back();
    EXPECT_THROW(Texture(t, 0), Error);
    t.image[0] = nullptr;
    EXPECT_THROW(Texture(t, 0), Error);
}

}  // namespace
}  // namespace rtrays::reference
