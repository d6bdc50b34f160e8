// SPDX-License-Identifier: MIT
// Tests BSDFs and textures on the device: every component compiles alone, and device samples follow
// the densities that the host computes from the same source.
#include <gtest/gtest.h>

#include "renderer/device/buffer.h"
#include "renderer/device/kernel.h"
#include "renderer/shared/features.h"
#include "renderer/testing/bsdf_cases.h"

namespace rtrays {
namespace {

const std::string test_kernel = R"(
#include "renderer/kernels/bsdf/bsdf.h"
#include "renderer/kernels/sampling/random.h"

// Samples one material seen along wo; normal and wo by three words each. Per sample: wi, pdf_w.
__kernel void test(GLOBAL const MaterialRecord *materials, GLOBAL const BxdfRecord *components,
                   GLOBAL const TextureRecord *textures, GLOBAL const uint *texels,
                   GLOBAL const float *view, GLOBAL float *samples, uint count, uint block) {
    const uint i = get_global_id(0);
    if (i >= count) {
        return;
    }
    SceneView scene;
    scene.materials = materials;
    scene.components = components;
#if FEATURE_textures
    scene.textures = textures;
    scene.texels = texels;
#endif
    const float3 n = make_float3(view[0], view[1], view[2]);
    const SurfaceFrame frame = make_surface_frame(n, n, make_float3(view[3], view[4], view[5]), make_float2(0.0f, 0.0f),
                                                  make_float3(view[6], view[7], view[8]));
    const uint4 w = random_words(17u, 0u, 5u, i, block);
    const BsdfSample s = bsdf_sample(&scene, 0u, frame, uniform_float(w.x), uniform_float(w.y),
                                     uniform_float(w.z));
    const BsdfValue value = bsdf_evaluate(&scene, 0u, frame, s.wi);
    samples[5u * i] = s.wi.x;
    samples[5u * i + 1u] = s.wi.y;
    samples[5u * i + 2u] = s.wi.z;
    samples[5u * i + 3u] = s.pdf_w;
    samples[5u * i + 4u] = value.pdf_w;
}
)";

Program build(DeviceContext &device, FeatureMask mask) {
    return Program(device, {"kernels/test.cl"}, mask.defines(), {{"kernels/test.cl", test_kernel}});
}

// The code of one component must not depend on that of another.
TEST(BsdfDevice, EveryKindCompilesAlone) {
    DeviceContext device;
    const FeatureMask base = FeatureMask().with(Feature::scattering);
    const auto expect_build = [&](FeatureMask mask) {
        EXPECT_NO_THROW(build(device, mask)) << ::testing::PrintToString(mask.names());
    };
    expect_build(base);
    for (const Feature kind :
         {Feature::lambert, Feature::oren_nayar, Feature::blinn, Feature::ward,
          Feature::ward_original, Feature::coated_lambert, Feature::disney_diffuse,
          Feature::disney_sheen, Feature::disney_clearcoat}) {
        expect_build(base.with(kind));
    }
    for (const Feature kind : {Feature::ideal_reflection, Feature::ideal_refraction}) {
        expect_build(base.with(kind).with(Feature::delta));
    }
    for (const Feature kind : {Feature::microfacet_reflection, Feature::microfacet_refraction}) {
        for (const Feature distribution : {Feature::ggx, Feature::beckmann}) {
            expect_build(base.with(kind).with(distribution));
        }
    }
    for (const Feature fresnel : {Feature::fresnel_dielectric, Feature::fresnel_conductor,
                                  Feature::fresnel_conductor_approximate, Feature::fresnel_schlick,
                                  Feature::fresnel_thin_dielectric}) {
        expect_build(base.with(Feature::lambert).with(Feature::fresnel).with(fresnel));
    }
    for (const Feature other :
         {Feature::textures, Feature::composite, Feature::one_sided, Feature::component_sides,
          Feature::tangents, Feature::smooth_normals}) {
        expect_build(base.with(Feature::lambert).with(other));
    }
}

/// Returns, per sample, wi (3 words), pdf_w and the density from bsdf_evaluate for wi.
std::vector<float> run_samples(DeviceContext &device, Kernel &kernel, const TestMaterial &material,
                               const SurfaceFrame &frame, float3 tangent, uint count, uint block) {
    const Buffer<MaterialRecord> materials(device, "materials",
                                           std::vector<MaterialRecord>{material.record()});
    const Buffer<BxdfRecord> components(device, "components", material.components);
    const Buffer<TextureRecord> textures(device, "textures", 1);
    const Buffer<uint> texels(device, "texels", 1);
    const float3 front = frame.front != 0u ? frame.ng : -frame.ng;
    const Buffer<float> view(device, "view",
                             std::vector<float>{front.x, front.y, front.z, tangent.x, tangent.y,
                                                tangent.z, frame.wo.x, frame.wo.y, frame.wo.z});
    const Buffer<float> samples(device, "samples", 5 * count);
    kernel.bind({materials, components, textures, texels, view, samples, count, block});
    kernel.enqueue(count);
    device.finish();
    return samples.read();
}

// A material must not depend on other features that the scene requires.
TEST(BsdfDevice, EverythingCompiledInChangesNoBit) {
    DeviceContext device;
    Kernel all(build(device, FeatureMask::all()), "test", 64);
    const FeatureMask base = FeatureMask().with(Feature::scattering);
    const std::vector<std::pair<TestMaterial, FeatureMask>> cases = {
        {{"lambert", {component(BXDF_LAMBERT)}}, base.with(Feature::lambert)},
        {{"oren_nayar", {oren_nayar(0.5f)}}, base.with(Feature::oren_nayar)},
        {{"blinn", {blinn(64)}}, base.with(Feature::blinn)},
        {{"disney_clearcoat", {rough(BXDF_DISNEY_CLEARCOAT, 0.05f, 0.05f)}},
         base.with(Feature::disney_clearcoat)},
        {{"smooth coat", {coated("smooth coat", 0, 0, 0.5f, true).components.back()}},
         base.with(Feature::coated_lambert)},
        {{"ward", {rough(BXDF_WARD, 0.2f, 0.2f)}}, base.with(Feature::ward)},
        {{"ggx", {rough(BXDF_MICROFACET_REFLECTION, 0.3f, 0.3f)}},
         base.with(Feature::microfacet_reflection).with(Feature::ggx)},
        {{"beckmann",
          {with_eta(rough(BXDF_MICROFACET_REFRACTION, 0.3f, 0.3f, BXDF_FLAG_BECKMANN), 1.5f)},
          MATERIAL_BOUNDARY},
         base.with(Feature::microfacet_refraction).with(Feature::beckmann)},
    };
    for (const auto &[material, mask] : cases) {
        Kernel alone(build(device, mask), "test", 64);
        for (const bool front : {true, false}) {
            const SurfaceFrame frame = tilted_frame(35, 0.6, front);
            const float3 none = make_float3(0, 0, 0);
            const std::vector<float> a =
                run_samples(device, alone, material, frame, none, 10'000, 2999);
            const std::vector<float> b =
                run_samples(device, all, material, frame, none, 10'000, 2999);
            EXPECT_TRUE(a == b) << material.name;
        }
    }
}

// Four tests share a family-wise level of 0.01, so each has the level 0.01 / 4.
TEST(BsdfDevice, SamplesFollowTheHostsDensity) {
    constexpr uint count = 500'000;
    DeviceContext device;
    const Program program = build(device, FeatureMask::all());
    Kernel kernel(program, "test", 64);
    const TestMaterial rough_composite = {
        "three components",
        {weighted(oren_nayar(0.5f), 0.3f), weighted(rough(BXDF_WARD, 0.2f, 0.4f), 0.3f),
         weighted(with_eta(blinn(64), 1.5f, FRESNEL_DIELECTRIC), 0.4f)}};
    const std::vector<std::pair<TestMaterial, double>> cases = {
        {rough_composite, 30.0},
        {rough_glass("ggx glass", 0.2f, 0.4f, 0), 40.0},
        {rough_glass("beckmann glass", 0.3f, 0.3f, BXDF_FLAG_BECKMANN), 60.0},
        {{"ggx", {rough(BXDF_MICROFACET_REFLECTION, 0.1f, 0.1f)}}, 89.0},
    };
    uint block = 3000;
    for (const auto &[material, theta] : cases) {
        const SurfaceFrame frame = tilted_frame(theta);
        const std::vector<float> found =
            run_samples(device, kernel, material, frame, frame.x, count, ++block);
        const float3 centre = 2.0f * dot(frame.ns, frame.wo) * frame.ns - frame.wo;
        const DirectionGrid grid(centre, frame.ns, 0.5);
        SampledDirections directions;
        for (size_t i = 0; i < found.size(); i += 5) {
            const float3 wi = make_float3(found[i], found[i + 1], found[i + 2]);
            directions.add(grid, wi, found[i + 3]);
            if (i < 5000 && found[i + 3] > 0.0f && std::abs(dot(wi, frame.ns)) > 1e-3f) {
                ASSERT_NEAR(found[i + 4] / material.evaluate(frame, wi).pdf_w, 1.0f, 1e-3f)
                    << material.name;
            }
        }
        const ChiSquare result = test_directions(material, frame, grid, directions);
        EXPECT_GT(result.p, 0.01 / 4) << material.name;
        EXPECT_LT(result.planted, 0.01 / 4) << material.name;
    }
}

}  // namespace
}  // namespace rtrays
