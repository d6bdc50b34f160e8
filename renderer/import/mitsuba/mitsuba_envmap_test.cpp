// SPDX-License-Identifier: MIT
// Tests the import of Mitsuba environments. Their rows are at other latitudes than those of RTRays,
// but the radiance of a direction must not change.
#include "renderer/import/mitsuba/envmap.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>

#include "renderer/testing/errors.h"

namespace rtrays::mitsuba {
namespace {

TextureImage noise(int width, int height) {
    TextureImage image;
    image.width = width;
    image.height = height;
    std::mt19937 engine(7);
    std::uniform_real_distribution<float> value;
    for (int i = 0; i < 3 * width * height; ++i) {
        image.floats.push_back(value(engine));
    }
    return image;
}

/// Interpolates a column between two rows. `row` counts from the first row.
double between_rows(const TextureImage &image, double row, int column) {
    const int above = std::min(static_cast<int>(row), image.height - 2);
    const double t = row - above;
    const auto at = [&](int y) {
        return static_cast<double>(image.floats[3 * static_cast<size_t>(y * image.width + column)]);
    };
    return (1 - t) * at(above) + t * at(above + 1);
}

/// Return the radiance at v in [0, 1] from the upper pole, as defined in stores.h and as computed
/// by Mitsuba's envmap.cpp, uv.y() * (height - 1).
double ours(const TextureImage &image, double v, int column) {
    return between_rows(image, std::clamp(v * image.height - 0.5, 0.0, image.height - 1.0), column);
}
double mitsubas(const TextureImage &image, double v, int column) {
    return between_rows(image, v * (image.height - 1), column);
}

TEST(MitsubaEnvmap, IsTheSameRadianceInMitsubasForm) {
    const TextureImage image = noise(3, 8);
    const TextureImage made = to_mitsuba_envmap(image);
    EXPECT_EQ(made.height, 17);
    for (int i = 0; i <= 1000; ++i) {
        EXPECT_NEAR(mitsubas(made, i / 1000.0, i % 3), ours(image, i / 1000.0, i % 3), 1e-6);
    }
    const TextureImage back = from_mitsuba_envmap(made);
    EXPECT_EQ(back.height, 8);
    EXPECT_EQ(back.floats, image.floats);
    EXPECT_EQ(to_mitsuba_envmap(noise(1, 2)).width, 2);
}

TEST(MitsubaEnvmap, ReadsTheRowsOfOthers) {
    for (const int height : {3, 8, 9}) {
        const TextureImage image = noise(3, height);
        const TextureImage read = from_mitsuba_envmap(image);
        double sum = 0, wanted = 0;
        for (int i = 0; i <= 1000; ++i) {
            const double v = i / 1000.0, row = v * (height - 1),
                         from_row = std::abs(row - std::round(row));
            // 32 rows between two. The error at a row is 1/128 of a second difference, which is at
            // most 2. Half of such a row at each pole is flat.
            EXPECT_NEAR(ours(read, v, 1), mitsubas(image, v, 1),
                        from_row >= 1.0 / 64 ? 1e-6 : 1.0 / 64)
                << v;
            sum += ours(read, v, 1);
            wanted += mitsubas(image, v, 1);
        }
        EXPECT_NEAR(sum / wanted, 1, 0.005);
    }
    EXPECT_EQ(from_mitsuba_envmap(noise(2048, 257)).height, 512);
}

TEST(MitsubaEnvmap, DecodesBytesAndRefusesWhatMitsubaDoes) {
    TextureImage image;
    image.width = 2;
    image.height = 3;
    image.bytes.assign(18, 128);
    EXPECT_NEAR(static_cast<double>(from_mitsuba_envmap(image).floats[0]), 0.21586, 1e-5);
    expect_input_error("Mitsuba requires at least 2x3", [] { from_mitsuba_envmap(noise(2, 2)); });
    expect_input_error("Mitsuba requires at least 2x3", [] { from_mitsuba_envmap(noise(1, 3)); });
}

}  // namespace
}  // namespace rtrays::mitsuba
