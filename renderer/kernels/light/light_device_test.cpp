// SPDX-License-Identifier: MIT
// Tests lights and cameras on the device: every type compiles alone, and device samples equal those
// of the host, which runs the same source. Other tests check the distributions on the host.
#include <gtest/gtest.h>

#include "renderer/testing/guided_lights.h"

#include "renderer/compile/scene_buffers.h"
#include "renderer/device/buffer.h"
#include "renderer/device/kernel.h"
#include "renderer/kernels/camera/perspective.h"

namespace rtrays {
namespace {

const std::string test_kernel = R"(
#include "renderer/kernels/camera/perspective.h"
#include "renderer/kernels/light/emission.h"
#include "renderer/kernels/sampling/random.h"

#define WORDS 26u
#define PUT3(v) put[0] = (v).x; put[1] = (v).y; put[2] = (v).z; put += 3
#define PUT1(x) *put++ = (x)

// Per work-item: a start of a light path, a light sample, and the start as the camera sees it.
__kernel void test(SHADING_PARAMETERS, CameraRecord camera, GLOBAL float *found, uint count) {
    const uint i = get_global_id(0);
    if (i >= count) {
        return;
    }
    const SceneView scene = SHADING_VIEW;
    const uint4 a = random_words(5u, 0u, 1u, i, 0u), b = random_words(5u, 0u, 1u, i, 1u), c = random_words(5u, 0u, 1u, i, 2u);
    GLOBAL float *put = found + WORDS * i;
    const EmissionSample e = sample_emission(&scene, a, b);
    PUT3(e.origin);
    PUT3(e.direction);
    PUT3(e.weight);
    PUT1(e.pdf_origin);
    PUT1(e.pdf_direction);
    PUT1((float)(4u * e.light + 2u * e.is_delta + e.at_infinity));
    const float3 from = make_float3(uniform_float(c.x) - 0.5f, 0.25f, uniform_float(c.y));
    const LightSample s = sample_lights(&scene, SELECT_LIGHT, from, c);
    const bool any = s.pdf_w > 0.0f;
    PUT1(s.pdf_w);
    PUT3(any ? s.wi : from);
    PUT3(any ? s.radiance : from);
    PUT1(any ? s.sampling_over_emission : 0.0f);
    PUT1(any ? s.arrival_pdf_a : 0.0f);
    const CameraConnection connection = camera_connection(camera, e.point.position, uniform_float(b.z), uniform_float(b.w));
    PUT3(connection.lens_point);
    PUT1(connection.pdf_w);
    PUT1(connection.pdf_w > 0.0f ? camera_pdf_w(camera, normalize(e.point.position - connection.lens_point)) : 0.0f);
}
)";

Program build(DeviceContext &device, FeatureMask mask) {
    return Program(device, {"kernels/test.cl"}, mask.defines(), {{"kernels/test.cl", test_kernel}});
}

// The code of one type must not depend on that of another.
TEST(LightDevice, EveryKindCompilesAlone) {
    DeviceContext device;
    const FeatureMask both =
        FeatureMask().with(Feature::lights).with(Feature::from_light).with(Feature::light_strategy);
    const FeatureMask infinite = both.with(Feature::infinite_lights);
    const FeatureMask planes = FeatureMask().with(Feature::shapes).with(Feature::quadrics);
    for (const FeatureMask &mask :
         {both.with(Feature::triangles).with(Feature::area_lights),
          both.with(Feature::triangles).with(Feature::area_lights).with(Feature::light_triangles),
          (both | planes).with(Feature::shape_lights), both.with(Feature::point_lights),
          both.with(Feature::spot_lights), both.with(Feature::directional_lights),
          infinite.with(Feature::dome), infinite.with(Feature::environment),
          infinite.with(Feature::dome) | planes,
          both.with(Feature::point_lights).with(Feature::lens)}) {
        // A light of that type alone, then among others.
        EXPECT_NO_THROW(build(device, mask)) << ::testing::PrintToString(mask.names());
        EXPECT_NO_THROW(build(device, mask.with(Feature::many_lights)))
            << ::testing::PrintToString(mask.names());
    }
}

void append(std::vector<float> &list, float3 v) {
    list.insert(list.end(), {v.x, v.y, v.z});
}

std::vector<float> host_samples(const SceneView &view, const CameraRecord &camera, uint count) {
    std::vector<float> list;
    for (uint i = 0; i < count; ++i) {
        const uint4 a = random_words(5, 0, 1, i, 0), b = random_words(5, 0, 1, i, 1),
                    c = random_words(5, 0, 1, i, 2);
        const EmissionSample e = sample_emission(&view, a, b);
        append(list, e.origin);
        append(list, e.direction);
        append(list, e.weight);
        list.insert(list.end(),
                    {e.pdf_origin, e.pdf_direction,
                     static_cast<float>(4u * e.light + 2u * e.is_delta + e.at_infinity)});
        const float3 from = make_float3(uniform_float(c.x) - 0.5f, 0.25f, uniform_float(c.y));
        const LightSample s = sample_lights(&view, SELECT_LIGHT, from, c);
        const bool any = s.pdf_w > 0.0f;
        list.push_back(s.pdf_w);
        append(list, any ? s.wi : from);
        append(list, any ? s.radiance : from);
        list.insert(list.end(),
                    {any ? s.sampling_over_emission : 0.0f, any ? s.arrival_pdf_a : 0.0f});
        const CameraConnection connection =
            camera_connection(camera, e.point.position, uniform_float(b.z), uniform_float(b.w));
        append(list, connection.lens_point);
        list.push_back(connection.pdf_w);
        list.push_back(
            connection.pdf_w > 0.0f
                ? camera_pdf_w(camera, normalize(e.point.position - connection.lens_point))
                : 0.0f);
    }
    return list;
}

// Math functions of host and device may differ by a few ulps.
TEST(LightDevice, SamplesAreThoseOfTheHost) {
    constexpr uint count = 20'000, word_count = 26;
    DeviceContext device;
    Kernel kernel(build(device, FeatureMask::all()), "test", 64);
    for (const bool guided : {false, true}) {
        const CompiledScene scene =
            compile_light_scene(guided ? LightArrays::Kind::dome : LightArrays::Kind::environment);
        const EmissionGuide guide = make_guide(scene, random_moments(scene, 3));
        const Buffer<uint32_t> guide_words =
            guided ? Buffer<uint32_t>(device, "guide", guide.words) : Buffer<uint32_t>();
        SceneView view = view_of(scene);
        view.emission_guide = guided ? guide.words.data() : nullptr;
        CameraRecord camera = scene.camera;
        camera.aperture_radius = 0.1f;
        camera.focus_distance = 5.0f;
        SceneBuffers buffers;
        buffers.require(device, scene, FeatureMask::all());
        const Buffer<float> samples(device, "samples", count * word_count);
        std::vector<KernelArgument> arguments =
            buffers.arguments(scene, Bvh(), FeatureMask::all(), guide_words)
                .at(StageInput::shading);
        arguments.insert(arguments.end(), {camera, samples, count});
        kernel.bind(arguments);
        kernel.enqueue(count);
        device.finish();
        const std::vector<float> found = samples.read(),
                                 expected = host_samples(view, camera, count);
        ASSERT_EQ(found.size(), expected.size());
        size_t off = 0;
        for (size_t i = 0; i < found.size(); ++i) {
            const float tolerance = 2e-4f * std::abs(expected[i]) + 2e-5f;
            off += std::abs(found[i] - expected[i]) <= tolerance ? 0u : 1u;
        }
        EXPECT_LT(off, count / 1000) << "rounding may select another cell of the image, or another "
                                        "side of an edge, only for "
                                        "few samples";
    }
}

}  // namespace
}  // namespace rtrays
