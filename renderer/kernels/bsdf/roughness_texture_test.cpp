// SPDX-License-Identifier: MIT
// Tests textures of roughness: a surface looks as one of the roughness at the point.
#include <gtest/gtest.h>

#include <cstring>

#include "testing/bsdf_cases.h"

namespace rtrays {
namespace {

/// Makes a grey float texel the texture of the roughness of all components.
TestMaterial with_texel(TestMaterial material, float grey, bool squared = false) {
    TextureRecord record{};
    record.width = record.height = 1;
    record.flags = TEXTURE_FLOAT;
    record.uv_scale[0] = record.uv_scale[1] = 1;
    material.textures = {record};
    uint word = 0;
    std::memcpy(&word, &grey, sizeof(word));
    material.texels = {word, word, word};
    for (BxdfRecord &component : material.components) {
        component.flags |=
            BXDF_FLAG_ROUGHNESS_TEXTURE | (squared ? BXDF_FLAG_ROUGHNESS_SQUARED : 0);
        component.coat_or_roughness = 0;
    }
    return material;
}

/// Expects equal values, densities and samples of both in many directions.
void expect_same(const TestMaterial &a, const TestMaterial &b) {
    for (const double degrees : {0.0, 40.0, 85.0}) {
        const SurfaceFrame frame = tilted_frame(degrees);
        for (uint32_t i = 0; i < 200; ++i) {
            const uint4 words = bsdf_words(i, 0);
            const float select = uniform_float(words.x), u = uniform_float(words.y),
                        v = uniform_float(words.z);
            const BsdfSample p = a.sample(frame, select, u, v), q = b.sample(frame, select, u, v);
            ASSERT_NEAR(p.pdf_w, q.pdf_w, 1e-4f * q.pdf_w) << a.name << ' ' << degrees;
            ASSERT_NEAR(p.weight.x, q.weight.x, 1e-4f * q.weight.x) << a.name << ' ' << degrees;
            ASSERT_NEAR(dot(p.wi, q.wi), 1, 1e-5) << a.name << ' ' << degrees;
            const BsdfValue f = a.evaluate(frame, p.wi), g = b.evaluate(frame, p.wi);
            ASSERT_NEAR(f.f_cos.x, g.f_cos.x, 1e-4f * g.f_cos.x) << a.name << ' ' << degrees;
            ASSERT_NEAR(f.pdf_w, g.pdf_w, 1e-4f * g.pdf_w) << a.name << ' ' << degrees;
        }
    }
}

TEST(RoughnessTexture, ScalesTheRoughnessOfEveryKind) {
    for (const uint kind : {BXDF_MICROFACET_REFLECTION, BXDF_WARD, BXDF_WARD_ORIGINAL}) {
        const TestMaterial plain = {"rough", {rough(kind, 0.1f, 0.2f)}};
        expect_same(with_texel({"times texel", {rough(kind, 0.4f, 0.8f)}}, 0.25f), plain);
        expect_same(with_texel({"times square", {rough(kind, 0.4f, 0.8f)}}, 0.5f, true), plain);
    }
    expect_same(with_texel(rough_glass("glass", 0.4f, 0.8f, 0), 0.25f),
                rough_glass("glass", 0.1f, 0.2f, 0));
    // Burley's roughness is not squared.
    expect_same(with_texel({"burley", {disney_diffuse(0.8f, 0.5f)}}, 0.5f, true),
                {"burley", {disney_diffuse(0.4f, 0.5f)}});
}

// A black texel is as smooth as the smoothest rough surface, whatever the factor.
TEST(RoughnessTexture, BlackIsTheLeastRoughness) {
    const uint kind = BXDF_MICROFACET_REFLECTION;
    const auto least = static_cast<float>(BxdfComponent::least_alpha);
    for (const float texel : {0.0f, 1e-30f, 1e-5f}) {
        for (const bool squared : {false, true}) {
            expect_same(with_texel({"black", {rough(kind, 1, 1)}}, texel, squared),
                        {"least", {rough(kind, least, least)}});
        }
    }
}

}  // namespace
}  // namespace rtrays
