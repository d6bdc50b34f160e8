// SPDX-License-Identifier: MIT
// Tests area lights with a texture: their power, the agreement of light samples with emission, and
// that every point that emits can be sampled.
#include <gtest/gtest.h>

#include "renderer/testing/light_paths.h"
#include "renderer/testing/scene_builder.h"

namespace rtrays {
namespace {

using Filter = TextureArrays::Filter;
using Wrap = TextureArrays::Wrap;

/// Returns an image whose texels are black, except some.
std::shared_ptr<const TextureImage> image_of(int width, int height,
                                             const std::vector<std::pair<int, Rgb>> &texels) {
    auto image = std::make_shared<TextureImage>();
    image->width = width;
    image->height = height;
    image->floats.assign(3 * static_cast<size_t>(width * height), 0.0f);
    for (const auto &[index, colour] : texels) {
        std::copy_n(colour.data(), 3, image->floats.data() + 3 * index);
    }
    return image;
}

/// A floor below a lamp of 2 x 2 units at height 2, which faces down. The lamp has 2 x 2 squares
/// of two triangles, with texture coordinates from 0 to 1.
struct Lamp {
    SceneArrays arrays;
    CameraRecord camera;

    Lamp() {
        const Scene scene = parse_scene_json(R"({"version": 1, "film": {"width": 8, "height": 8},
            "nodes": [
            {"name": "camera", "transform": [{"translate": [0, 1, 5]}],
             "camera": {"type": "pinhole", "fov": 40, "fov_axis": "x"}},
            {"name": "lamp", "transform": [{"rotate": {"axis": [1, 0, 0], "degrees": 90}},
                                           {"translate": [0, 2, 0]}],
             "geometry": {"type": "mesh",
              "vertices": [[-1,-1,0],[0,-1,0],[1,-1,0],[-1,0,0],[0,0,0],[1,0,0],[-1,1,0],[0,1,0],[1,1,0]],
              "uvs": [[0,0],[0.5,0],[1,0],[0,0.5],[0.5,0.5],[1,0.5],[0,1],[0.5,1],[1,1]],
              "polygons": [[0,1,4,3],[1,2,5,4],[3,4,7,6],[4,5,8,7]]},
             "material": {"type": "lambert", "reflectance": [0, 0, 0]},
             "light": {"type": "diffuse_area", "radiance": [3, 2, 1]}}]})",
                                             "in.json", "in");
        arrays = scene.arrays();
        camera = compile_camera(arrays.cameras, 0, 8, 8);
    }

    CompiledScene compile(const std::shared_ptr<const TextureImage> &image, Filter filter,
                          Wrap wrap, const Eigen::Vector2d &scale = {1, 1},
                          const Eigen::Vector2d &offset = {0, 0}) {
        arrays.textures = {{"t"}, {image}, {filter}, {wrap}, {scale}, {offset}};
        arrays.materials.emission_texture = {0};
        return compile_arrays(arrays, camera, CompileSettings());
    }
};

// The mean weight of light paths is pi times the integral of the radiance over the area.
TEST(TexturedLight, HasThePowerOfItsTexels) {
    const auto image = image_of(4, 4, {{0, {1, 2, 3}}, {5, {0, 4, 0}}, {14, {1, 1, 1}}});
    const CompiledScene scene = Lamp().compile(image, Filter::nearest, Wrap::repeat);
    Estimate power;
    for (uint32_t i = 0; i < 100'000; ++i) {
        power.add(green(emit(scene, i).weight));
    }
    // 4 units of area, 2 W / (sr m^2) in the green channel, and a mean texel of 7 / 16.
    EXPECT_NEAR(power.mean(), pi * 4 * 2 * 7 / 16, 4 * power.error());
    // The triangles that no positive texel touches are never selected.
    EXPECT_EQ(scene.lights.size(), 1u);
    EXPECT_TRUE(scene.features.has(Feature::emission_textures));
    EXPECT_TRUE(scene.features.has(Feature::texture_coordinates));
}

TEST(TexturedLight, IsSampledAsItIsHit) {
    const auto image = image_of(3, 2, {{0, {1, 2, 3}}, {4, {0, 9, 0}}, {5, {1, 1, 1}}});
    const CompiledScene scene =
        Lamp().compile(image, Filter::bilinear, Wrap::mirror, {1.5, -2}, {0.25, 0});
    const SceneView view = view_of(scene);
    const float3 from = make_float3(0.3f, 0, -0.2f);
    Estimate irradiance, by_light_paths;
    for (uint32_t i = 0; i < 200'000; ++i) {
        const LightSample sample = sample_lights(&view, 0, from, words(i, 4));
        irradiance.add(green(sample.radiance) * static_cast<double>(sample.wi.y / sample.pdf_w));
        // A light path of direction d arrives at height 0 with its weight. The density of its
        // arrivals in a square gives the mean irradiance there.
        const EmissionSample start = emit(scene, i);
        const float t = -start.origin.y / start.direction.y;
        const float x = start.origin.x + t * start.direction.x - from.x;
        const float z = start.origin.z + t * start.direction.z - from.z;
        const bool arrives = std::abs(x) < 0.05f && std::abs(z) < 0.05f;
        by_light_paths.add(arrives ? green(start.weight) / 0.01 : 0.0);
    }
    // The integral of L cos cos / d^2 over the lamp, by midpoints.
    constexpr int n = 400;
    double expected = 0;
    for (int row = 0; row < n; ++row) {
        for (int column = 0; column < n; ++column) {
            const double u = (column + 0.5) / n, v = (row + 0.5) / n;
            // The rotation turns +y of the mesh to +z.
            const Eigen::Vector3d to(2 * u - 1 - 0.3, 2, 2 * v - 1 + 0.2);
            const float3 texel =
                texture_lookup(scene.textures.data(), scene.texels.data(),
                               make_float2(static_cast<float>(u), static_cast<float>(v)));
            expected += 2 * green(texel) * 4.0 / std::pow(to.squaredNorm(), 2) * 4.0 / (n * n);
        }
    }
    EXPECT_NEAR(irradiance.mean(), expected, 4 * irradiance.error());
    EXPECT_LT(irradiance.error(), 0.01 * expected);
    EXPECT_NEAR(by_light_paths.mean(), expected, 4 * by_light_paths.error());
}

// Random textures with few positive texels, at random placements.
TEST(TexturedLight, EveryPointThatEmitsHasADensity) {
    std::mt19937 random(5);
    const auto below = [&](int n) { return static_cast<int>(random() % static_cast<unsigned>(n)); };
    Lamp lamp;
    int lit = 0, dark = 0;
    for (int i = 0; i < 300; ++i) {
        const int width = 1 + below(12), height = 1 + below(12);
        std::vector<std::pair<int, Rgb>> texels;
        for (int k = 0; k <= below(3); ++k) {
            texels.emplace_back(below(width * height), Rgb(below(2) == 0 ? 1e-6f : 1e6f, 1, 0));
        }
        const Filter filter = below(2) == 0 ? Filter::nearest : Filter::bilinear;
        const Wrap wrap = static_cast<Wrap>(below(3));
        const Eigen::Vector2d scale(0.01 * (below(600) - 300), 0.01 * (below(600) - 300));
        const Eigen::Vector2d offset(0.01 * (below(800) - 400), 1000.0 * below(2));
        const CompiledScene scene =
            lamp.compile(image_of(width, height, texels), filter, wrap, scale, offset);
        const SceneView view = view_of(scene);
        for (uint32_t k = 0; k < 400; ++k) {
            const auto triangle = static_cast<uint32_t>(below(8));
            const uint4 w = words(k, 9);
            const float2 at = sample_triangle(uniform_float(w.x), uniform_float(w.y));
            const float3 radiance = texture_lookup(scene.textures.data(), scene.texels.data(),
                                                   triangle_uv(&view, triangle, at.x, at.y));
            const uint32_t emitter = scene.surface_triangles[triangle].emitter;
            const bool can_be_sampled =
                emitter != NO_EMITTER && scene.emitter_triangles[emitter].pdf_a > 0.0f;
            const bool emits = radiance.x > 0.0f || radiance.y > 0.0f;
            ASSERT_TRUE(can_be_sampled || !emits) << i;
            lit += emits ? 1 : 0;
            dark += can_be_sampled ? 0 : 1;
        }
    }
    EXPECT_GT(lit, 10'000);
    EXPECT_GT(dark, 10'000);
}

TEST(TexturedLight, ShapesHaveTheirCoordinates) {
    const Scene scene = parse_scene_json(R"({"version": 1, "film": {"width": 8, "height": 8},
        "nodes": [{"name": "camera", "camera": {"type": "pinhole", "fov": 40, "fov_axis": "x"}},
        {"name": "ball", "geometry": {"type": "sphere"}, "transform": [{"translate": [0, 0, -5]}],
         "material": {"type": "lambert", "reflectance": [0, 0, 0], "emission": [1, 2, 1]}}]})",
                                         "in.json", "in");
    SceneArrays arrays = scene.arrays();
    // The lower half of the image is bright: z < 0 on the sphere.
    arrays.textures = {
        {"t"},   {image_of(1, 2, {{1, {3, 3, 3}}})}, {Filter::nearest}, {Wrap::clamp}, {{1, 1}},
        {{0, 0}}};
    arrays.materials.emission_texture = {0};
    const CompiledScene compiled =
        compile_arrays(arrays, compile_camera(arrays.cameras, 0, 8, 8), CompileSettings());
    const SceneView view = view_of(compiled);
    int bright = 0;
    for (uint32_t i = 0; i < 1000; ++i) {
        const LightSample sample = sample_lights(&view, 0, make_float3(7, 0, -5), words(i, 4));
        EXPECT_EQ(green(sample.radiance), sample.target.z < -5.0f ? 6.0 : 0.0);
        bright += sample.radiance.y > 0.0f ? 1 : 0;
        const EmissionSample start = emit(compiled, i);
        EXPECT_EQ(start.weight.y > 0.0f, start.point.position.z < -5.0f);
    }
    EXPECT_NEAR(bright, 500, 80);
    EXPECT_NEAR(compiled.lights[0].area, 4 * pi, 1e-5);
}

TEST(TexturedLight, BlackTexturesAreNoLights) {
    const CompiledScene scene = Lamp().compile(image_of(2, 2, {}), Filter::nearest, Wrap::repeat);
    EXPECT_TRUE(scene.lights.empty());
    EXPECT_TRUE(scene.emitter_triangles.empty());
    EXPECT_FALSE(scene.features.closed().has(Feature::emission_textures));
}

}  // namespace
}  // namespace rtrays
