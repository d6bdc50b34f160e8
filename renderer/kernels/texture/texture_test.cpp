// SPDX-License-Identifier: MIT
// Compares texture lookups with an implementation in double precision.
#include <gtest/gtest.h>

#include <numeric>

#include "renderer/testing/bsdf_cases.h"
#include "renderer/testing/float_traps.h"

namespace rtrays {
namespace {

constexpr uint width = 5, height = 3;

/// A texture whose texels are all different. Texels have 8 bits, in sRGB or linear, or are floats.
struct TestTexture {
    TextureRecord record{};
    std::vector<uint> texels = {0xdeadbeef};  // belongs to another texture

    explicit TestTexture(uint flags) {
        record = {1, width, height, flags, {1, 1}, {0, 0}};
        for (uint i = 0; i < width * height; ++i) {
            const uint r = i * 17, g = 255 - i * 13, b = (i * 101) % 256;
            if ((flags & TEXTURE_FLOAT) != 0u) {
                for (const uint c : {r, g, b}) {
                    texels.push_back(as_uint(static_cast<float>(c) * 10.5f));
                }
            } else {
                texels.push_back(r | g << 8 | b << 16 | 0xab000000u);
            }
        }
    }

    double texel(long x, long y, uint channel) const {
        const uint i = static_cast<uint>(y) * width + static_cast<uint>(x);
        const std::array<uint, 3> bytes = {i * 17, 255 - i * 13, (i * 101) % 256};
        const double s = bytes[channel] / 255.0;
        if ((record.flags & TEXTURE_FLOAT) != 0u) {
            return bytes[channel] * 10.5;
        }
        return (record.flags & TEXTURE_SRGB) == 0u ? s
               : s <= 0.04045                      ? s / 12.92
                                                   : std::pow((s + 0.055) / 1.055, 2.4);
    }

    /// Returns the lookup in double precision. v counts rows from the bottom.
    double lookup(double u, double v, uint channel) const {
        u = record.uv_scale[0] * u + record.uv_offset[0];
        v = record.uv_scale[1] * v + record.uv_offset[1];
        const bool mirror = (record.flags & TEXTURE_MIRROR) != 0u;
        const bool clamp = (record.flags & TEXTURE_CLAMP) != 0u && !mirror;
        const auto wrap = [&](long i, long size) {
            const long twice = (i % (2 * size) + 2 * size) % (2 * size);
            return clamp    ? std::clamp(i, 0l, size - 1)
                   : mirror ? std::min(twice, 2 * size - 1 - twice)
                            : (i % size + size) % size;
        };
        const auto at = [&](long x, long y) {
            return texel(wrap(x, width), height - 1 - wrap(y, height), channel);
        };
        const auto coordinate = [&](double x, double size) {
            return (clamp ? std::clamp(x, 0.0, 1.0) : x) * size;
        };
        const double x = coordinate(u, width), y = coordinate(v, height);
        if ((record.flags & TEXTURE_BILINEAR) == 0u) {
            return at(static_cast<long>(std::floor(x)), static_cast<long>(std::floor(y)));
        }
        const double i = std::floor(x - 0.5), j = std::floor(y - 0.5), s = x - 0.5 - i,
                     t = y - 0.5 - j;
        const auto li = static_cast<long>(i), lj = static_cast<long>(j);
        return (1 - t) * ((1 - s) * at(li, lj) + s * at(li + 1, lj)) +
               t * ((1 - s) * at(li, lj + 1) + s * at(li + 1, lj + 1));
    }

    float3 device_lookup(float u, float v) const {
        return texture_lookup(&record, texels.data(), make_float2(u, v));
    }
};

TEST(Texture, SrgbTableIsTheCurve) {
    for (int i = 0; i < 256; ++i) {
        const double s = i / 255.0;
        const double linear = s <= 0.04045 ? s / 12.92 : std::pow((s + 0.055) / 1.055, 2.4);
        EXPECT_EQ(srgb_to_linear[i], static_cast<float>(linear)) << i;
    }
}

/// Returns all values of a texture's flags. Mirrored textures are clamped, too.
std::vector<uint> all_flags() {
    std::vector<uint> all(24);
    std::iota(all.begin(), all.begin() + 16, 0u);
    std::iota(all.begin() + 16, all.end(), TEXTURE_MIRROR | TEXTURE_CLAMP);
    return all;
}

TEST(Texture, AgreesWithDoublePrecision) {
    for (const uint flags : all_flags()) {
        TestTexture texture(flags);
        texture.record.uv_scale[0] = 1.75f;
        texture.record.uv_scale[1] = -0.6f;
        texture.record.uv_offset[0] = -0.4f;
        texture.record.uv_offset[1] = 0.3f;
        const double range = (flags & TEXTURE_FLOAT) != 0u ? 2677.5 : 1.0;
        int compared = 0;
        for (uint32_t i = 0; i < 20'000; ++i) {
            const uint4 w = bsdf_words(i, 2000);
            const float u = 6.0f * uniform_float(w.x) - 3.0f, v = 6.0f * uniform_float(w.y) - 3.0f;
            const double du = static_cast<double>(u), dv = static_cast<double>(v);
            const float3 found = texture.device_lookup(u, v);
            const std::array<float, 3> channels = {found.x, found.y, found.z};
            for (uint c = 0; c < 3; ++c) {
                const double expected = texture.lookup(du, dv, c);
                // At a texel's edge, rounding may select either side.
                const double moved = texture.lookup(du + 1e-6, dv + 1e-6, c),
                             back = texture.lookup(du - 1e-6, dv - 1e-6, c);
                if ((flags & TEXTURE_BILINEAR) != 0u || (moved == expected && back == expected)) {
                    ASSERT_NEAR(channels[c], expected, 1e-5 * range)
                        << "flags " << flags << " at " << u << ", " << v;
                    ++compared;
                }
            }
        }
        EXPECT_GT(compared, 55'000);
    }
}

// Image files store rows from the top, but v points upwards.
TEST(Texture, HasItsOriginAtTheLowerLeft) {
    for (const uint flags : {TEXTURE_CLAMP, 0u, TEXTURE_CLAMP | TEXTURE_BILINEAR}) {
        const TestTexture texture(flags);
        const auto expect_texel = [&](float u, float v, long x, long row) {
            EXPECT_NEAR(texture.device_lookup(u, v).x, texture.texel(x, row, 0), 1e-6);
        };
        expect_texel(0.1f, 1.0f / 6, 0, height - 1);  // centre of the lower left texel
        expect_texel(0.9f, 5.0f / 6, width - 1, 0);   // centre of the upper right texel
        if (flags != 0u) {                            // a repeated image has its other edge there
            expect_texel(0.0f, 0.0f, 0, height - 1);
            expect_texel(1.0f, 1.0f, width - 1, 0);
            expect_texel(7.0f, -3.0f, width - 1, height - 1);
        }
    }
}

TEST(Texture, StaysInsideTheImageWhateverTheCoordinates) {
    const float infinity = std::numeric_limits<float>::infinity();
    const test::InvalidAllowed coordinates_that_are_none;
    for (const uint flags : all_flags()) {
        const TestTexture texture(flags);
        std::vector<double> values;
        for (const float u : {0.0f, -0.0f, 1.0f, -1.0f, -1e-10f, -1e-45f, 0.99999994f, 1e9f, -3e38f,
                              3e38f, infinity, -infinity, NAN}) {
            for (const float v : {0.5f, -1e-10f, 1e30f, NAN}) {
                // The sanitizers detect an index out of range.
                const float3 found = texture.device_lookup(u, v);
                EXPECT_TRUE(found.x >= 0.0f && found.x <= 255 * 10.5f) << u << ", " << v;
                values.push_back(static_cast<double>(found.x));
            }
        }
    }
}

TEST(Texture, ScalesTheWeightOfAComponent) {
    const TestTexture texture(0);
    BxdfRecord lambert = component(BXDF_LAMBERT);
    lambert.weight[0] = 0.5f;
    lambert.texture = 0;
    const MaterialRecord material = {0, 1, 0, 0};
    SurfaceFrame frame = tilted_frame(20);
    frame.uv = make_float2(0.5f, 0.5f);
    SceneView scene{};
    scene.materials = &material;
    scene.components = &lambert;
    scene.textures = &texture.record;
    scene.texels = texture.texels.data();
    const BsdfValue value = bsdf_evaluate(&scene, 0, frame, frame.ns);
    EXPECT_NEAR(value.f_cos.x, 0.5 * texture.texel(2, 1, 0) / pi, 1e-6);
    EXPECT_NEAR(value.f_cos.y, texture.texel(2, 1, 1) / pi, 1e-6);
}

}  // namespace
}  // namespace rtrays
