// SPDX-License-Identifier: MIT
// Tests the import of model files of all formats as scenes.
#include "renderer/import/models/model_file.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <assimp/Exporter.hpp>
#include <assimp/Importer.hpp>
#include <cmath>
#include <nlohmann/json.hpp>

#include "renderer/base/angles.h"
#include "renderer/base/json.h"
#include "renderer/scene/cores/material.h"
#include "renderer/scene/graph.h"
#include "renderer/testing/errors.h"
#include "renderer/testing/loaded_model.h"
#include "renderer/testing/temporary_folder.h"

namespace rtrays {
namespace {

using Eigen::Vector3d;
using Eigen::Vector3f;
using Kind = BxdfComponent::Kind;
using Fresnel = BxdfComponent::Fresnel;

const std::filesystem::path corpus = RTRAYS_CORPUS;

using Loaded = LoadedModel;

TEST(ModelFile, GivesAModelWithoutLightAndCameraBoth) {
    const Loaded model(corpus / "triangle.stl");
    EXPECT_TRUE(model.says("the file has no camera; added 'camera'")) << model.told;
    EXPECT_TRUE(model.says("the file has no light; added the light 'dome' of radiance 1"))
        << model.told;
    ASSERT_EQ(model.scene.lights().kind, std::vector<LightArrays::Kind>{LightArrays::Kind::dome});
    EXPECT_EQ(model.scene.lights().radiance[0], Vector3f(1, 1, 1));
    EXPECT_EQ(model.material("default")[0].weight, Vector3f::Constant(0.6f));
    EXPECT_FALSE(
        model.scene.meshes().has_normals[0]);  // the normals in STL are those of the triangles
    // The camera sees the full model: every vertex is within half the angle of view of the axis.
    const CameraArrays &cameras = model.scene.cameras();
    const Eigen::Matrix4d camera_from_world = cameras.world_from_camera[0].inverse();
    for (const Vector3f &vertex : model.scene.meshes().position) {
        const Eigen::Vector4d seen = camera_from_world * vertex.cast<double>().homogeneous();
        EXPECT_LT(std::max(std::abs(seen.x()), std::abs(seen.y())),
                  -seen.z() * std::tan(0.5 * cameras.fov[0]));
    }
}

TEST(ModelFile, ReadsNodesInstancesLightsAndCamerasOfGltf) {
    const Loaded model(corpus / "triangles.gltf");
    const MeshArrays &meshes = model.scene.meshes();
    ASSERT_EQ(meshes.name, (std::vector<std::string>{"left", "right"}));
    EXPECT_EQ(model.scene.graph().find("left")->core(CoreRole::geometry),
              model.scene.graph().find("right")->core(CoreRole::geometry));
    EXPECT_EQ(meshes.position[1], Vector3f(-1, 0, 0));
    EXPECT_EQ(meshes.position[4], Vector3f(1, 0, 0));
    EXPECT_EQ(meshes.uv[0], Eigen::Vector2f(0, 0));  // glTF's v points down
    EXPECT_EQ(meshes.uv[2], Eigen::Vector2f(0, 1));

    const auto brass = model.material("brass");
    ASSERT_EQ(brass.size(), 1u);
    EXPECT_EQ(brass[0].kind, Kind::microfacet_reflection);
    EXPECT_EQ(brass[0].fresnel, Fresnel::schlick);
    EXPECT_NEAR(brass[0].alpha[0], 0.25, 1e-6);

    const CameraArrays &cameras = model.scene.cameras();
    ASSERT_EQ(cameras.name.size(), 1u);
    EXPECT_EQ(cameras.fov_axis[0], CameraArrays::FovAxis::x);
    // The field of view is 0.6 along y, and the aspect ratio is 2.
    EXPECT_NEAR(std::tan(0.5 * cameras.fov[0]), 2 * std::tan(0.3), 1e-6);
    EXPECT_EQ(cameras.world_from_camera[0].col(3), Eigen::Vector4d(0, 0, 5, 1));
    EXPECT_EQ(model.scene.film_width(), 2 * model.scene.film_height());

    const LightArrays &lights = model.scene.lights();
    ASSERT_EQ(lights.name.size(), 3u);
    const size_t bulb = model.light("bulb light");
    EXPECT_EQ(lights.kind[bulb], LightArrays::Kind::point);
    EXPECT_LT((683 * lights.radiance[bulb] - Vector3f(8, 4, 2)).norm(), 1e-5f);  // from candela
    EXPECT_EQ(lights.world_from_light[bulb].col(3), Eigen::Vector4d(0, 3, 0, 1));
    const size_t torch = model.light("torch light");
    EXPECT_EQ(lights.kind[torch], LightArrays::Kind::spot);
    EXPECT_NEAR(lights.inner_angle[torch], 0.2, 1e-6);
    EXPECT_NEAR(lights.outer_angle[torch], 0.5, 1e-6);
    const size_t sun = model.light("sun light");
    EXPECT_EQ(lights.kind[sun], LightArrays::Kind::directional);
    EXPECT_LT((683 * lights.radiance[sun] - Vector3f(3, 3, 3)).norm(), 1e-5f);  // from lux
    // The light is rotated from -z to straight down.
    EXPECT_LT((lights.world_from_light[sun].col(2) - Eigen::Vector4d(0, 1, 0, 0)).norm(), 1e-6);
    EXPECT_TRUE(model.says("by the factor 1/683; emission keeps its numbers (3: ")) << model.told;
    EXPECT_TRUE(model.says("linearly with the angle between their cones (1: torch)")) << model.told;
    EXPECT_EQ(std::count(model.told.begin(), model.told.end(), '\n'), 2) << model.told;
}

/// Returns triangles.gltf with a texture, whose image it contains: checker.png, of which half of
/// the texels are (255, 128, 0) and half are (0, 64, 255).
Json with_image() {
    const std::string image =
        "data:image/png;base64,"
        "iVBORw0KGgoAAAANSUhEUgAAAAQAAAAECAIAAAAmkwkpAAAAGElEQVR42mNgcPj/v4EBSiJYDv8ZcMoAADqyFfGE/"
        "XEFAAAAAElFTkSuQmCC";
    Json model = parse_json(bytes_of(corpus / "triangles.gltf"), "triangles.gltf");
    model["images"] = {{{"uri", image}}};
    model["textures"] = {{{"source", 0}}};
    return model;
}

TEST(ModelFile, MixesMetalAndCoatWithMaps) {
    Json model = with_image();
    Json &material = model["materials"][0];
    material["emissiveFactor"] = {1, 1, 0.5};
    material["emissiveTexture"] = {{"index", 0}};
    material["normalTexture"] = {{"index", 0}};
    material["alphaMode"] = "BLEND";
    material["pbrMetallicRoughness"] = {{"baseColorFactor", {0.8, 0.6, 0.4, 0.5}},
                                        {"baseColorTexture", {{"index", 0}}},
                                        {"metallicRoughnessTexture", {{"index", 0}}}};
    const TemporaryFolder folder;
    const Loaded loaded(folder.write("m.gltf", model.dump()));
    const auto brass = loaded.material("brass");
    ASSERT_EQ(brass.size(), 3u);
    // The blue channel mixes metal and base.
    EXPECT_EQ(brass[0].fresnel, Fresnel::schlick);
    EXPECT_EQ(brass[0].weight, Vector3f::Ones());
    ASSERT_NE(brass[0].mix_texture, no_index);
    const std::vector<uint8_t> &metal =
        loaded.scene.arrays().textures.image[brass[0].mix_texture]->bytes;
    EXPECT_EQ(std::count(metal.begin(), metal.end(), 0), 3 * 8);
    EXPECT_EQ(std::count(metal.begin(), metal.end(), 255), 3 * 8);
    for (size_t i = 0; i < 3; ++i) {
        EXPECT_EQ(brass[i].mix_texture, brass[0].mix_texture);
        EXPECT_EQ(brass[i].mix_inverted, i > 0);
        EXPECT_EQ(brass[i].mix, 1);
    }
    // The green channel is the roughness, whose square is alpha.
    EXPECT_EQ(brass[0].alpha, Eigen::Vector2d(1, 1));
    EXPECT_TRUE(brass[0].roughness_squared);
    ASSERT_NE(brass[0].roughness_texture, no_index);
    EXPECT_NE(brass[0].roughness_texture, brass[0].texture);
    const std::vector<uint8_t> &bytes =
        loaded.scene.arrays().textures.image[brass[0].roughness_texture]->bytes;
    EXPECT_EQ(std::count(bytes.begin(), bytes.end(), 128), 3 * 8);
    EXPECT_EQ(std::count(bytes.begin(), bytes.end(), 64), 3 * 8);
    EXPECT_LT((brass[0].eta - Vector3d(0.8, 0.6, 0.4)).norm(), 1e-6);
    EXPECT_NE(brass[0].texture, no_index);
    EXPECT_EQ(brass[1].fresnel, Fresnel::dielectric);
    EXPECT_EQ(brass[1].eta[0], 1.5);
    EXPECT_EQ(brass[1].texture, no_index);
    EXPECT_EQ(brass[1].roughness_texture, brass[0].roughness_texture);
    EXPECT_EQ(brass[2].kind, Kind::lambert);
    EXPECT_TRUE(brass[2].complement);
    EXPECT_LT((brass[2].weight - Vector3f(0.8f, 0.6f, 0.4f)).norm(), 1e-6f);
    EXPECT_EQ(brass[2].texture, brass[0].texture);
    EXPECT_TRUE(loaded.says("materials that emit are opaque; their opacity is ignored (1: brass)"));
    const LightArrays &lights = loaded.scene.lights();
    const size_t glow = loaded.light("left");
    ASSERT_LT(glow, lights.name.size());
    EXPECT_EQ(lights.radiance[glow], Vector3f(1, 1, 0.5f));
    const uint32_t emission =
        loaded.scene.materials().emission_texture.at(loaded.material_index("brass"));
    EXPECT_EQ(emission, brass[0].texture);  // one image at one placement
    EXPECT_FALSE(loaded.says("metalness")) << loaded.told;
}

TEST(ModelFile, ReadsTheNormalTextureOfGltf) {
    Json model = with_image();
    Json &material = model["materials"][0];
    const auto load = [&] {
        const TemporaryFolder folder;
        return Loaded(folder.write("m.gltf", model.dump()));
    };
    material["normalTexture"] = {{"index", 0}, {"scale", 0.5}};
    const Loaded loaded = load();
    EXPECT_TRUE(loaded.normal_map("brass") ==
                (NormalMap{NormalMap::Kind::normals, 0, 0.5, true, true, false}));
    EXPECT_FALSE(loaded.scene.arrays().textures.image[0]->srgb) << "linear data";
    EXPECT_FALSE(loaded.says("normal maps")) << loaded.told;
    // The base colour decides the texture coordinates of the mesh.
    material["pbrMetallicRoughness"]["baseColorTexture"] = {{"index", 0}};
    material["normalTexture"]["texCoord"] = 1;
    const Loaded other = load();
    EXPECT_TRUE(other.normal_map("brass") == NormalMap());
    EXPECT_TRUE(
        other.says("normal maps are ignored if their texture coordinates are rotated or "
                   "differ from those of the base colour (1: brass)"))
        << other.told;
}

TEST(ModelFile, ReadsTheOpacityOfGltf) {
    // 2 x 1 texels with alpha 0 and 255.
    const std::string image =
        "data:image/png;base64,"
        "iVBORw0KGgoAAAANSUhEUgAAAAIAAAABCAYAAAD0In+KAAAAEUlEQVR4nGPkEpFj2Bcg8h8ABrECXxXb"
        "TvwAAAAASUVORK5CYII=";
    const auto load = [&](const char *mode, const Json &cutoff, bool textured) {
        Json model = parse_json(bytes_of(corpus / "triangles.gltf"), "triangles.gltf");
        model["images"] = {{{"uri", image}}};
        model["textures"] = {{{"source", 0}}};
        Json &material = model["materials"][0];
        material["alphaMode"] = mode;
        if (!cutoff.is_null()) {
            material["alphaCutoff"] = cutoff;
        }
        material["pbrMetallicRoughness"]["baseColorFactor"] = {0.8, 0.6, 0.4, 0.75};
        if (textured) {
            material["pbrMetallicRoughness"]["baseColorTexture"] = {{"index", 0}};
        }
        const TemporaryFolder folder;
        return Loaded(folder.write("m.gltf", model.dump()));
    };
    const std::vector<uint8_t> alpha = {0, 0, 0, 255, 255, 255};
    const Loaded blend = load("BLEND", nullptr, true);
    EXPECT_NEAR(blend.opacity("brass").value, 0.75, 1e-6);
    EXPECT_EQ(blend.opacity("brass").cutoff, 0);
    EXPECT_EQ(blend.opacity_texels("brass"), alpha);
    const Loaded mask = load("MASK", nullptr, true);
    EXPECT_NEAR(mask.opacity("brass").value, 0.75, 1e-6);
    EXPECT_EQ(mask.opacity("brass").cutoff, 0.5);
    EXPECT_EQ(mask.opacity_texels("brass"), alpha);
    EXPECT_TRUE(load("MASK", 0.75, false).opacity("brass").is_opaque());
    EXPECT_FALSE(load("MASK", 0.8, false).opacity("brass").is_opaque());
    EXPECT_TRUE(load("MASK", 0, true).opacity("brass").is_opaque());
    EXPECT_EQ(load("MASK", 2, true).opacity("brass").value, 0);
    EXPECT_TRUE(load("OPAQUE", nullptr, true).opacity("brass").is_opaque());
}

TEST(ModelFile, ReadsCollada) {
    const Loaded model(corpus / "plane.dae");
    // Z is up in the file, so (2, 2, 0) becomes (2, 0, -2).
    EXPECT_LT((model.scene.meshes().position[2] - Vector3f(2, 0, -2)).norm(), 1e-6f);
    EXPECT_NEAR(model.scene.cameras().fov[0], 50 * degree, 1e-6);
    EXPECT_EQ(model.scene.cameras().fov_axis[0], CameraArrays::FovAxis::x);
    EXPECT_LT(
        (model.scene.cameras().world_from_camera[0].col(3) - Eigen::Vector4d(0, 7, 0, 1)).norm(),
        1e-6);
    EXPECT_EQ(model.scene.lights().radiance[0], Vector3f(4, 3, 2));
    EXPECT_TRUE(model.says("fall off with the square of the distance")) << model.told;
    const auto paint = model.material("paint");
    ASSERT_EQ(paint.size(), 2u);
    EXPECT_EQ(paint[1].exponent, 40);
}

TEST(ModelFile, KeepsTheSquaresOfEveryFormat) {
    Assimp::Importer importer;
    const aiScene *squares = importer.ReadFile((corpus / "materials.obj").string(), 0);
    ASSERT_NE(squares, nullptr);
    const struct {
        const char *id;
        const char *file;
    } formats[] = {{"obj", "a.obj"},     {"stl", "a.stl"},  {"stlb", "b.stl"},
                   {"collada", "a.dae"}, {"3ds", "a.3ds"},  {"glb2", "a.glb"},
                   {"x", "a.x"},         {"fbxa", "a.fbx"}, {"plyb", "a.ply"}};
    const TemporaryFolder folder;
    folder.write("checker.png", bytes_of(corpus / "checker.png"));
    for (const auto &format : formats) {
        SCOPED_TRACE(format.id);
        Assimp::Exporter exporter;
        ASSERT_EQ(exporter.Export(squares, format.id, (folder.path() / format.file).string()),
                  aiReturn_SUCCESS);
        const Loaded model(folder.path() / format.file);
        EXPECT_EQ(model.scene.meshes().triangle.size(), 16u);
        const Eigen::AlignedBox3d bounds = model.scene.graph().bounds();
        // Z is up in 3DS files, so y becomes -z.
        const bool is_turned = std::string(format.id) == "3ds";
        const Vector3d front = is_turned ? Vector3d::UnitY() : Vector3d::UnitZ();
        EXPECT_LT((bounds.min() - (is_turned ? Vector3d(0, 0, -1) : Vector3d(0, 0, 0))).norm(),
                  1e-6);
        const double size = std::string(format.id) == "fbxa" ? 0.01 : 1;  // centimetres
        EXPECT_LT(
            (bounds.max() - size * (is_turned ? Vector3d(1, 0, 0) : Vector3d(1, 1, 0))).norm(),
            1e-6);
        const auto mesh = load_mesh_file(folder.path() / format.file, "m");
        EXPECT_EQ(mesh->triangles().size(), 16u);
        // The front must not change.
        for (const Triangle &t : mesh->triangles()) {
            const Vector3d &a = mesh->vertices()[t[0]];
            EXPECT_GT((mesh->vertices()[t[1]] - a).cross(mesh->vertices()[t[2]] - a).dot(front), 0);
        }
    }
}

TEST(ModelFile, SaysWhatIsWrong) {
    const TemporaryFolder folder;
    expect_input_error("a.gltf", [&] { Loaded model(folder.write("a.gltf", "{}")); });
    expect_input_error("unknown scene format '.foo'",
                       [&] { Loaded model(folder.write("a.foo", "")); });
    expect_input_error("unknown scene format '.assbin'",
                       [&] { Loaded model(folder.write("a.assbin", "")); });
    // This file makes Assimp 5.2.5 abort in the child process.
    expect_input_error("damaged.3mf: cannot read the model: ",
                       [&] { Loaded model(corpus / "damaged.3mf"); });
    // Binary STL that claims four billion triangles, and one with the right number.
    std::string stl(80, ' ');
    expect_input_error("a.stl", [&] {
        Loaded model(folder.write("a.stl", stl + "\xff\xff\xff\xff" + std::string(50, '\0')));
    });
    expect_input_error("a.stl", [&] { Loaded model(folder.write("a.stl", "solid")); });
}

}  // namespace
}  // namespace rtrays
