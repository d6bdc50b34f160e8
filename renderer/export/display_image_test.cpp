// SPDX-License-Identifier: MIT
// Tests display images: the sRGB curve, exposure, clipping, and reading back the files.
#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <limits>

#include "renderer/export/display_image.h"
#include "renderer/import/images/texture_file.h"
#include "renderer/scene/cores/texture.h"
#include "renderer/testing/errors.h"
#include "renderer/testing/scene_builder.h"

namespace rtrays {
namespace {

/// Returns an image with one row of grey pixels.
Image greys(const std::vector<float> &values) {
    Image image = Image::rgb(static_cast<int>(values.size()), 1);
    for (const std::string &name : rgb_names()) {
        image.channel(name) = values;
    }
    return image;
}

std::vector<int> shown(const std::vector<float> &values, double exposure) {
    const std::vector<uint8_t> bytes = display_bytes(greys(values), exposure);
    std::vector<int> red;
    for (size_t i = 0; i < bytes.size(); i += 3) {
        EXPECT_EQ(bytes[i], bytes[i + 1]);
        EXPECT_EQ(bytes[i], bytes[i + 2]);
        red.push_back(bytes[i]);
    }
    return red;
}

// Expected values follow IEC 61966-2-1: 12.92 x below 0.0031308, 1.055 x^(1/2.4) - 0.055 above.
TEST(DisplayImage, FollowsTheSrgbCurve) {
    EXPECT_EQ(shown({0.0f, 0.001f, 0.003f, 0.0032f, 0.18f, 0.5f, 1.0f}, 0),
              (std::vector<int>{0, 3, 10, 11, 118, 188, 255}));
}

TEST(DisplayImage, CurvesAreInverse) {
    for (double x = 0; x <= 1; x += 1.0 / 512) {
        EXPECT_NEAR(srgb_decoded(srgb_encoded(x)), x, 1e-6) << x;
    }
}

TEST(DisplayImage, MultipliesByPowersOfTwo) {
    EXPECT_EQ(shown({0.25f, 0.5f}, 1), shown({0.5f, 1.0f}, 0));
    EXPECT_EQ(shown({4.0f, 8.0f}, -3), shown({0.5f, 1.0f}, 0));
}

TEST(DisplayImage, ClipsExtremes) {
    const float infinity = std::numeric_limits<float>::infinity();
    const float largest = std::numeric_limits<float>::max();
    const std::vector<float> values = {-1.0f, -0.0f, NAN, 1e-45f, 1.5f, largest, infinity};
    EXPECT_EQ(shown(values, 0), (std::vector<int>{0, 0, 0, 0, 255, 255, 255}));
    // 2^100 scales the smallest subnormal to 2^-49, and 2^-100 scales the largest float to 2^28.
    EXPECT_EQ(shown(values, 100), (std::vector<int>{0, 0, 0, 0, 255, 255, 255}));
    EXPECT_EQ(shown(values, -100), (std::vector<int>{0, 0, 0, 0, 0, 255, 255}));
}

class DisplayFiles : public WithImages {
  protected:
    std::filesystem::path folder_ = testing::TempDir();
};

TEST_F(DisplayFiles, PngReadsBackExactly) {
    const Image image = greys({0.0f, 0.18f, 0.5f, 2.0f});
    write_image(image, folder_ / "display.png", -1);
    const auto read = load_texture_file(folder_ / "display.png", TextureEncoding::srgb);
    EXPECT_EQ(read->width, 4);
    EXPECT_EQ(read->height, 1);
    EXPECT_EQ(read->bytes, display_bytes(image, -1));
}

TEST_F(DisplayFiles, JpegReadsBackClosely) {
    const Image image = greys(std::vector<float>(64, 0.5f));
    for (const char *name : {"display.jpg", "display.jpeg"}) {
        write_image(image, folder_ / name, 0);
        const auto read = load_texture_file(folder_ / name, TextureEncoding::srgb);
        ASSERT_EQ(read->bytes.size(), 3 * 64u);
        for (const uint8_t byte : read->bytes) {
            EXPECT_NEAR(byte, 188, 2);
        }
    }
}

TEST_F(DisplayFiles, UnknownFormatsAreErrors) {
    expect_input_error(".png", [&] { require_image_output(folder_ / "display.bmp"); });
    for (const char *name : {"a.exr", "a.png", "a.jpg", "a.jpeg"}) {
        require_image_output(folder_ / name);
    }
}

}  // namespace
}  // namespace rtrays
