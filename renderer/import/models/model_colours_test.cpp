// SPDX-License-Identifier: MIT
// Tests colours of vertices in PLY, OBJ and, with Assimp, glTF files.
#include <gtest/gtest.h>

#include <cmath>
#include <nlohmann/json.hpp>

#include "renderer/base/json.h"
#include "renderer/import/models/model_file.h"
#include "renderer/scene/cores/texture.h"
#include "renderer/testing/errors.h"
#include "renderer/testing/loaded_model.h"
#include "renderer/testing/temporary_folder.h"

namespace rtrays {
namespace {

using Eigen::Vector3d;
using Colours = std::vector<Rgb>;

/// Returns a triangle in ASCII PLY, with these properties and their values at each vertex.
std::string ply(const std::string &properties, const std::vector<std::string> &values) {
    return "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\n"
           "property float z\n" +
           properties +
           "element face 1\nproperty list uchar int vertex_indices\nend_header\n0 0 0 " +
           values.at(0) + "\n1 0 0 " + values.at(1) + "\n0 1 0 " + values.at(2) + "\n3 0 1 2\n";
}

LoadedModel loaded(const std::string &file, const std::string &content) {
    const TemporaryFolder folder;
    return LoadedModel(folder.write(file, content));
}

/// Expects these colours of one mesh, with at most rounding errors of float.
void expect_colours(const Scene &scene, const Colours &expected) {
    const MeshArrays &meshes = scene.meshes();
    ASSERT_EQ(meshes.vertex_count.at(0), expected.size());
    ASSERT_EQ(meshes.colour.size(), meshes.position.size());
    for (size_t i = 0; i < expected.size(); ++i) {
        EXPECT_LT((meshes.colour[i] - expected[i]).cwiseAbs().maxCoeff(), 1e-6f) << i;
    }
}

/// Expects that the first component of the only material shows the colours, times `weight`.
void expect_shown(const LoadedModel &model, const Rgb &weight) {
    const BxdfComponent &component = model.scene.materials().component.at(0);
    ASSERT_NE(component.texture, no_index);
    EXPECT_TRUE(model.scene.arrays().textures.has_vertex_colours(component.texture));
    EXPECT_LT((component.weight - weight).cwiseAbs().maxCoeff(), 1e-6f);
}

TEST(PlyColours, FloatsAreLinearAndIntegersAreDecoded) {
    const std::vector<std::string> floats = {"0.5 0.25 1", "0 1 0", "1 1 1"};
    const Colours linear = {{0.5f, 0.25f, 1}, {0, 1, 0}, {1, 1, 1}};
    for (const char *names : {"float red|float green|float blue", "float r|double g|float b"}) {
        std::string properties = "property " + std::string(names) + "\n";
        for (size_t bar = properties.find('|'); bar != std::string::npos;
             bar = properties.find('|')) {
            properties.replace(bar, 1, "\nproperty ");
        }
        const LoadedModel model = loaded("m.ply", ply(properties, floats));
        expect_colours(model.scene, linear);
        expect_shown(model, Rgb::Ones());
        EXPECT_FALSE(model.says("sRGB")) << model.told;
    }
    const auto byte = [](int value) { return static_cast<float>(srgb_decoded(value / 255.0)); };
    const LoadedModel bytes =
        loaded("m.ply", ply("property uchar red\nproperty uchar green\nproperty uchar blue\n"
                            "property uchar alpha\n",
                            {"128 64 255 9", "0 255 0 9", "1 2 3 9"}));
    expect_colours(bytes.scene, {{byte(128), byte(64), 1}, {0, 1, 0}, {byte(1), byte(2), byte(3)}});
    EXPECT_TRUE(bytes.says("vertex colours that are integers are decoded by the sRGB curve"));
    EXPECT_TRUE(bytes.says("unknown properties are ignored (1: vertex alpha)")) << bytes.told;
    const LoadedModel shorts = loaded("m.ply", ply("property ushort red\nproperty ushort green\n"
                                                   "property ushort blue\n",
                                                   {"65535 0 0", "0 32896 0", "0 0 65535"}));
    expect_colours(shorts.scene, {{1, 0, 0}, {0, byte(128), 0}, {0, 0, 1}});
}

TEST(PlyColours, MultiplyTheMaterialsOfTheMtlFile) {
    const TemporaryFolder folder;
    folder.write("m.mtl", "newmtl a\nKd 0.5 0.4 0.3\n");
    std::string text = ply("property float red\nproperty float green\nproperty float blue\n",
                           {"1 0 0", "0 1 0", "0 0 1"});
    text.replace(text.find("vertex_indices\n"), 15,
                 "vertex_indices\nproperty int material_index\n");
    text.replace(text.find("3 0 1 2\n"), 8, "3 0 1 2 0\n");
    const LoadedModel model(folder.write("m.ply", text));
    expect_shown(model, Rgb(0.5f, 0.4f, 0.3f));
    expect_colours(model.scene, {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}});
    EXPECT_FALSE(model.says("texture coordinates")) << model.told;
}

TEST(PlyColours, SayWhatIsWrongOrIgnored) {
    const LoadedModel partly =
        loaded("m.ply", ply("property uchar red\nproperty uchar green\n", {"1 2", "3 4", "5 6"}));
    EXPECT_TRUE(partly.says("vertex colours without all of red, green and blue are ignored"));
    EXPECT_TRUE(partly.scene.meshes().colour.empty());
    const std::string floats = "property float red\nproperty float green\nproperty float blue\n";
    const LoadedModel large = loaded("m.ply", ply(floats, {"2 0.5 -1", "0.5 0.5 0.5", "1 1 1"}));
    EXPECT_TRUE(large.says("vertex colours are clamped to [0, 1] (1: m.ply)")) << large.told;
    expect_colours(large.scene, {{1, 0.5f, 0}, {0.5f, 0.5f, 0.5f}, {1, 1, 1}});
    const LoadedModel wide = loaded("m.ply", ply("property int red\nproperty int green\n"
                                                 "property int blue\n",
                                                 {"1 2 3", "4 5 6", "7 8 9"}));
    EXPECT_TRUE(wide.says("(3: vertex red, vertex green, vertex blue)")) << wide.told;
    for (const char *number : {"nan", "1e999"}) {
        expect_input_error("colour 1 is not within [0, 1]", [&] {
            loaded("m.ply", ply(floats, {"0 0 0", std::string("0 0 ") + number, "0 0 0"}));
        });
    }
}

TEST(ObjColours, AreDecodedAndMultiplyTheDiffuseColour) {
    const std::string faces = "f 1 2 3\nf 1 3 4\n";
    const std::string vertices = "v 0 0 0 1 0 0\nv 1 0 0 0 0.5 0\nv 1 1 0\nv 0 1 0 1 1 1\n";
    const auto half = static_cast<float>(srgb_decoded(0.5));
    const Colours expected = {{1, 0, 0}, {0, half, 0}, {1, 1, 1}, {1, 1, 1}};
    const LoadedModel plain = loaded("m.obj", vertices + faces);
    expect_colours(plain.scene, expected);
    expect_shown(plain, Rgb::Ones());
    EXPECT_TRUE(plain.says("vertex colours are decoded by the sRGB curve")) << plain.told;
    const TemporaryFolder folder;
    folder.write("m.mtl", "newmtl a\nKd 0.5 0.4 0.3\n");
    const LoadedModel model(folder.write("m.obj", "mtllib m.mtl\nusemtl a\n" + faces + vertices));
    expect_colours(model.scene, expected);
    expect_shown(model, Rgb(0.5f, 0.4f, 0.3f));
    const LoadedModel large = loaded("m.obj", "v 0 0 0 255 0 0 1\nv 1 0 0\nv 0 1 0\nf 1 2 3\n");
    EXPECT_TRUE(large.says("vertex colours are clamped to [0, 1]")) << large.told;
    EXPECT_TRUE(large.says("numbers after the colour of a vertex are ignored (1: line 1)"));
}

TEST(MeshColours, VerticesOfDifferentColoursStayApart) {
    // Two triangles that share two positions. Only their colours differ there.
    const std::string text =
        "v 0 0 0 1 0 0\nv 1 0 0 1 0 0\nv 1 1 0 1 0 0\nv 0 0 0 0 1 0\nv 1 1 0 0 1 0\n"
        "v 0 1 0 0 1 0\nf 1 2 3\nf 4 5 6\n";
    EXPECT_EQ(loaded("m.obj", text).scene.meshes().colour.size(), 6u);
}

#if RTRAYS_MODELS

/// Loads triangles.gltf with colours of this type, whose bytes are `data`, and other changes.
template <typename Change>
LoadedModel with_colours(const std::string &data, int component_type, const char *type,
                         const Change &change) {
    Json model = parse_json(bytes_of(std::filesystem::path(RTRAYS_CORPUS) / "triangles.gltf"),
                            "triangles.gltf");
    model["buffers"].push_back({{"byteLength", data.size()}, {"uri", "colours.bin"}});
    model["bufferViews"].push_back({{"buffer", 1}, {"byteLength", data.size()}});
    model["accessors"].push_back({{"bufferView", model["bufferViews"].size() - 1},
                                  {"componentType", component_type},
                                  {"normalized", component_type != 5126},
                                  {"count", 3},
                                  {"type", type}});
    model["meshes"][0]["primitives"][0]["attributes"]["COLOR_0"] = model["accessors"].size() - 1;
    change(model);
    const TemporaryFolder folder;
    folder.write("colours.bin", data);
    return LoadedModel(folder.write("m.gltf", model.dump()));
}

LoadedModel with_colours(const std::string &data, int component_type, const char *type) {
    return with_colours(data, component_type, type, [](const Json &) {});
}

template <typename T>
std::string bytes_of_values(const std::vector<T> &values) {
    return {reinterpret_cast<const char *>(values.data()), values.size() * sizeof(T)};
}

TEST(GltfColours, HaveEveryTypeOfTheFormat) {
    const Colours expected = {{1, 0.2f, 0}, {0, 1, 0.2f}, {0.2f, 0.2f, 1}};
    expect_colours(
        with_colours(bytes_of_values<float>({1, 0.2f, 0, 0, 1, 0.2f, 0.2f, 0.2f, 1}), 5126, "VEC3")
            .scene,
        expected);
    const LoadedModel floats = with_colours(
        bytes_of_values<float>({1, 0.2f, 0, 0.5f, 0, 1, 0.2f, 0.5f, 0.2f, 0.2f, 1, 0.5f}), 5126,
        "VEC4");
    expect_colours(floats.scene, expected);
    expect_colours(
        with_colours(bytes_of_values<uint8_t>({255, 51, 0, 9, 0, 255, 51, 9, 51, 51, 255, 9}), 5121,
                     "VEC4")
            .scene,
        expected);
    // Rows of three bytes are padded to four.
    const std::string padded =
        bytes_of_values<uint8_t>({255, 51, 0, 0, 0, 255, 51, 0, 51, 51, 255, 0});
    const auto stride = [](Json &model) { model["bufferViews"].back()["byteStride"] = 4; };
    expect_colours(with_colours(padded, 5121, "VEC3", stride).scene, expected);
    expect_colours(with_colours(bytes_of_values<uint16_t>({65535, 13107, 0, 9, 0, 65535, 13107, 9,
                                                           13107, 13107, 65535, 9}),
                                5123, "VEC4")
                       .scene,
                   expected);
    // The metal of triangles.gltf.
    expect_shown(floats, Rgb::Ones());
}

TEST(GltfColours, MultiplyTheBaseColourAndItsTexture) {
    const std::string data = bytes_of_values<float>({1, 0, 0, 0, 1, 0, 0, 0, 1});
    const auto with_texture = [](Json &model) {
        Json &physical = model["materials"][0]["pbrMetallicRoughness"];
        physical["metallicFactor"] = 0;
        physical["baseColorTexture"] = {{"index", 0}};
        model["textures"] = {{{"source", 0}}};
        model["images"] = {{{"uri", "checker.png"}}};
        model["images"][0]["uri"] =
            "data:image/png;base64,"
            "iVBORw0KGgoAAAANSUhEUgAAAAQAAAAECAIAAAAmkwkpAAAAGElEQVR42mNgcPj/"
            "v4EBSiJYDv8ZcMoAADqyFfGE/"
            "XEFAAAAAElFTkSuQmCC";
    };
    const LoadedModel model = with_colours(data, 5126, "VEC3", with_texture);
    const TextureArrays &textures = model.scene.arrays().textures;
    ASSERT_EQ(textures.image.size(), 1u);
    EXPECT_EQ(textures.image[0]->width, 4);
    EXPECT_TRUE(textures.has_vertex_colours(0));
}

TEST(GltfColours, SayWhatIsWrongOrIgnored) {
    expect_input_error("mesh 'triangle': COLOR_0 has the component type 5125",
                       [] { with_colours(std::string(48, '\1'), 5125, "VEC4"); });
    const LoadedModel large =
        with_colours(bytes_of_values<float>({2, 0, 0, 0, 1, 0, 0, 0, 1}), 5126, "VEC3");
    EXPECT_TRUE(large.says("vertex colours are clamped to [0, 1] (1: triangle)")) << large.told;
    const auto blend = [](Json &model) { model["materials"][0]["alphaMode"] = "BLEND"; };
    const std::string data = std::string(12, '\x7f');
    EXPECT_TRUE(with_colours(data, 5121, "VEC4", blend).says("the alpha of vertex colours"));
    EXPECT_FALSE(with_colours(data, 5121, "VEC4").says("the alpha of vertex colours"));
}

#endif

}  // namespace
}  // namespace rtrays
