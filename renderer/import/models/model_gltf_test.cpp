// SPDX-License-Identifier: MIT
// Tests what the import of glTF adds to Assimp: extensions, units and texture transforms. Also
// tests the units and cones of lights of Collada and FBX.
#include <gtest/gtest.h>

#include <assimp/Exporter.hpp>
#include <assimp/Importer.hpp>
#include <cmath>
#include <nlohmann/json.hpp>

#include "renderer/base/angles.h"
#include "renderer/base/json.h"
#include "renderer/import/models/model_file.h"
#include "renderer/scene/graph.h"
#include "renderer/testing/errors.h"
#include "renderer/testing/loaded_model.h"
#include "renderer/testing/temporary_folder.h"

namespace rtrays {
namespace {

using Eigen::Vector2d;
using Eigen::Vector2f;
using Eigen::Vector3d;
using Eigen::Vector3f;
using Kind = BxdfComponent::Kind;
using Fresnel = BxdfComponent::Fresnel;

const std::filesystem::path corpus = RTRAYS_CORPUS;

/// Half of the texels are (255, 128, 0), half are (0, 64, 255).
constexpr const char *checker =
    "data:image/png;base64,"
    "iVBORw0KGgoAAAANSUhEUgAAAAQAAAAECAIAAAAmkwkpAAAAGElEQVR42mNgcPj/v4EBSiJYDv8ZcMoAADqyFfGE/"
    "XEFAAAAAElFTkSuQmCC";

/// The document of triangles.gltf, whose material is `brass`.
Json document() {
    return parse_json(bytes_of(corpus / "triangles.gltf"), "triangles.gltf");
}

LoadedModel loaded(const Json &model) {
    const TemporaryFolder folder;
    return LoadedModel(folder.write("m.gltf", model.dump()));
}

/// Loads triangles.gltf with an extension of its material.
LoadedModel with_extension(const char *name, const Json &value) {
    Json model = document();
    model["extensionsUsed"].push_back(name);
    model["materials"][0]["extensions"][name] = value;
    return loaded(model);
}

TEST(Gltf, EmissionIsFactorTimesTextureTimesStrength) {
    Json model = document();
    Json &material = model["materials"][0];
    model["images"] = {{{"uri", checker}}};
    model["textures"] = {{{"source", 0}}};
    const auto radiance = [&] {
        const LoadedModel read = loaded(model);
        EXPECT_FALSE(read.says("KHR_materials_emissive_strength")) << read.told;
        EXPECT_EQ(
            read.scene.materials().emission_texture.at(read.material_index("brass")) != no_index,
            material.contains("emissiveTexture"));
        return read.scene.lights().radiance.at(read.light("left"));
    };
    for (const bool has_texture : {false, true}) {
        material["extensions"] = Json::object();
        material["emissiveFactor"] = {1, 0.5, 0.25};
        if (has_texture) {
            material["emissiveTexture"] = {{"index", 0}};
        }
        const Vector3f without = radiance();
        material["extensions"]["KHR_materials_emissive_strength"] = {{"emissiveStrength", 50}};
        model["extensionsUsed"] =
            Json::array({"KHR_lights_punctual", "KHR_materials_emissive_strength"});
        const Vector3f with = radiance();
        EXPECT_LT((with - 50 * without).norm(), 1e-5f * with.norm());
        EXPECT_EQ(without, Vector3f(1, 0.5f, 0.25f));  // the factor of the texture
    }
    model["extensionsRequired"] = Json::array({"KHR_materials_emissive_strength"});
    EXPECT_EQ(radiance().x(), 50.0f);
}

TEST(Gltf, EmissionHasItsOwnTextureTransform) {
    Json model = document();
    Json &material = model["materials"][0];
    model["images"] = {{{"uri", checker}}};
    model["textures"] = {{{"source", 0}}};
    model["extensionsUsed"].push_back("KHR_texture_transform");
    const auto texture = [](const Json &transform) {
        return Json{{"index", 0}, {"extensions", {{"KHR_texture_transform", transform}}}};
    };
    // Returns where the emission of a vertex is looked up.
    const auto looked_up = [&](size_t vertex) {
        const LoadedModel read = loaded(model);
        const TextureArrays &textures = read.scene.arrays().textures;
        const uint32_t at =
            read.scene.materials().emission_texture.at(read.material_index("brass"));
        EXPECT_NE(at, no_index) << read.told;
        const Vector2d uv = read.scene.meshes().uv.at(vertex).cast<double>();
        return Vector2d(textures.uv_scale.at(at).cwiseProduct(uv) + textures.uv_offset.at(at));
    };
    material["emissiveFactor"] = {1, 1, 1};
    material["emissiveTexture"] = {{"index", 0}};
    const Vector2d plain[2] = {looked_up(0), looked_up(1)};
    material["emissiveTexture"] = texture({{"scale", {2, 3}}, {"offset", {0.25, 0.5}}});
    const Json turned = texture({{"rotation", 0.5}, {"scale", {2, 2}}});
    for (size_t vertex = 0; vertex < 2; ++vertex) {
        // v points down in glTF.
        const Vector2d expected(2 * plain[vertex][0] + 0.25,
                                1 - (3 * (1 - plain[vertex][1]) + 0.5));
        EXPECT_LT((looked_up(vertex) - expected).norm(), 1e-6);
    }
    // Both turn alike, so both have the coordinates of the mesh.
    material["pbrMetallicRoughness"]["baseColorTexture"] = turned;
    material["emissiveTexture"] = turned;
    EXPECT_NE(loaded(model).scene.materials().emission_texture.at(0), no_index);
    // The emission alone turns.
    material["pbrMetallicRoughness"]["baseColorTexture"] = {{"index", 0}};
    const LoadedModel mean = loaded(model);
    EXPECT_TRUE(
        mean.says("emission maps with other texture coordinates than the base colour are "
                  "replaced by their mean (1: brass)"))
        << mean.told;
    EXPECT_EQ(mean.scene.lights().radiance.at(mean.light("left")).x(), 0.5f);
}

TEST(Gltf, RequiredUnknownExtensionsAreErrors) {
    Json model = document();
    model["extensionsUsed"].push_back("EXT_nonsense");
    const LoadedModel used = loaded(model);
    EXPECT_TRUE(used.says("the extension EXT_nonsense is ignored")) << used.told;
    model["extensionsRequired"] = Json::array({"KHR_lights_punctual", "EXT_nonsense"});
    const TemporaryFolder folder;
    const auto path = folder.write("m.gltf", model.dump());
    expect_input_error(
        "m.gltf: the file requires the extension \"EXT_nonsense\", which is unsupported",
        [&] { LoadedModel read(path); });
    expect_input_error("EXT_nonsense", [&] { load_mesh_file(path, "m"); });
}

TEST(Gltf, NamesExtensionsThatAreIgnored) {
    for (const char *name : {"KHR_materials_unlit", "KHR_materials_anisotropy", "EXT_anything"}) {
        const LoadedModel model = with_extension(name, Json::object());
        EXPECT_TRUE(model.says("the extension " + std::string(name) + " is ignored (1: brass)"))
            << model.told;
    }
    const LoadedModel textured =
        with_extension("KHR_materials_specular", {{"specularTexture", {{"index", 0}}}});
    EXPECT_TRUE(textured.says(
        "textures of KHR_materials_specular are ignored, such as specularTexture (1: brass)"))
        << textured.told;
}

TEST(Gltf, ReadsTheDocumentOfBinaryFiles) {
    const std::string text = [] {
        Json model = document();
        model["extensionsRequired"] = Json::array({"EXT_nonsense"});
        return model.dump();
    }();
    const auto word = [](size_t value) {
        std::string bytes(4, '\0');
        for (size_t i = 0; i < 4; ++i) {
            bytes[i] = static_cast<char>(value >> (8 * i));
        }
        return bytes;
    };
    const std::string binary =
        "glTF" + word(2) + word(20 + text.size()) + word(text.size()) + "JSON" + text;
    const TemporaryFolder folder;
    expect_input_error("requires the extension \"EXT_nonsense\"",
                       [&] { LoadedModel read(folder.write("m.glb", binary)); });
    // A file that was cut, and one with a changed line ending.
    for (const std::string &damaged : {binary.substr(0, binary.size() - 1), binary + "\r"}) {
        expect_input_error(" bytes, but its header states ",
                           [&] { LoadedModel read(folder.write("m.glb", damaged)); });
    }
}

TEST(Gltf, TextureTransformsAreHonoured) {
    Json model = document();
    model["images"] = {{{"uri", checker}}};
    model["textures"] = {{{"source", 0}}};
    model["extensionsUsed"].push_back("KHR_texture_transform");
    Json &texture = model["materials"][0]["pbrMetallicRoughness"]["baseColorTexture"];
    texture = {{"index", 0}};
    Json &transform = texture["extensions"]["KHR_texture_transform"];
    const Vector2f corners[] = {{0, 0}, {1, 0}, {0, 1}};  // in our coordinates

    transform = {{"offset", {0.25, 0.5}}, {"scale", {2, 4}}};
    const LoadedModel scaled = loaded(model);
    const TextureArrays &t = scaled.scene.arrays().textures;
    ASSERT_EQ(t.uv_scale, std::vector<Vector2d>{Vector2d(2, 4)});
    // glTF's v points down: 1 - (0.5 + 4 * (1 - v)) = 4 * v - 3.5.
    EXPECT_LT((t.uv_offset[0] - Vector2d(0.25, -3.5)).norm(), 1e-12);
    for (size_t i = 0; i < 3; ++i) {
        EXPECT_EQ(scaled.scene.meshes().uv[i], corners[i]);
    }

    // The example of the extension: the lower left quadrant of the image, rotated clockwise.
    transform = {{"offset", {0, 1}}, {"rotation", pi / 2}, {"scale", {0.5, 0.5}}};
    const LoadedModel rotated = loaded(model);
    EXPECT_EQ(rotated.scene.arrays().textures.uv_scale, std::vector<Vector2d>{Vector2d(1, 1)});
    // In glTF's coordinates (0, 1) -> (0.5, 1), (1, 1) -> (0.5, 0.5), (0, 0) -> (0, 1).
    const Vector2f expected[] = {{0.5f, 0}, {0.5f, 0.5f}, {0, 0}};
    for (size_t i = 0; i < 3; ++i) {
        EXPECT_LT((rotated.scene.meshes().uv[i] - expected[i]).norm(), 1e-6f) << i;
    }
    EXPECT_FALSE(rotated.says("rotations")) << rotated.told;
}

TEST(Gltf, UsesTheTextureCoordinatesThatTheTextureNames) {
    Json model = document();
    model["images"] = {{{"uri", checker}}};
    model["textures"] = {{{"source", 0}}};
    model["extensionsUsed"].push_back("KHR_texture_transform");
    // The second set of coordinates is the first two numbers of three other floats per vertex.
    Json &attributes = model["meshes"][0]["primitives"][0]["attributes"];
    Json second = model["accessors"][attributes["POSITION"].get<size_t>()];
    second["type"] = "VEC2";
    second.erase("min");
    second.erase("max");
    attributes["TEXCOORD_1"] = model["accessors"].size();
    model["accessors"].push_back(second);
    Json &texture = model["materials"][0]["pbrMetallicRoughness"]["baseColorTexture"];
    texture = {{"index", 0}};
    const auto uv = [&] { return loaded(model).scene.meshes().uv; };
    const auto first = uv();
    texture["texCoord"] = 1;
    const auto by_texture = uv();
    EXPECT_NE(by_texture, first);
    texture["texCoord"] = 0;
    texture["extensions"]["KHR_texture_transform"] = {{"texCoord", 1}};
    EXPECT_EQ(uv(), by_texture);
}

TEST(Gltf, SharedLightsAndRepeatedNamesKeepTheirPlaces) {
    Json model = document();
    Json &nodes = model["nodes"];
    const size_t first = nodes.size();
    const auto add = [&](const Json &node) {
        nodes[0]["children"].push_back(nodes.size());
        nodes.push_back(node);
    };
    const auto lit = [](const char *name, double x, size_t light) {
        return Json{{"name", name},
                    {"translation", {x, 0, 0}},
                    {"extensions", {{"KHR_lights_punctual", {{"light", light}}}}}};
    };
    add(lit("second bulb", 5, 0));
    add(lit("bulb", 7, 1));
    add(Json{{"name", "eye"}, {"translation", {9, 0, 0}}, {"camera", 0}});
    add(Json{{"name", "3"}, {"translation", {11, 0, 0}}});  // a name like an index
    ASSERT_EQ(nodes.size(), first + 4);
    const LoadedModel read = loaded(model);
    const LightArrays &lights = read.scene.lights();
    EXPECT_EQ(lights.name.size(), 5u);
    const auto x_of = [&](const char *name) {
        return lights.world_from_light.at(read.light(name))(0, 3);
    };
    EXPECT_EQ(x_of("bulb light"), 0);
    EXPECT_EQ(x_of("second bulb light"), 5);
    EXPECT_EQ(x_of("bulb light_2"), 7);
    EXPECT_EQ(lights.kind.at(read.light("bulb light_2")), LightArrays::Kind::spot);
    ASSERT_EQ(read.scene.cameras().name.size(), 2u);
    EXPECT_EQ(read.scene.cameras().world_from_camera[0](2, 3), 5);
    EXPECT_EQ(read.scene.cameras().world_from_camera[1](0, 3), 9);
}

TEST(Gltf, DecodesNamesOfFiles) {
    Json model = document();
    model["images"] = {{{"uri", "my%20im%61ge%.png"}}};
    model["textures"] = {{{"source", 0}}};
    model["materials"][0]["pbrMetallicRoughness"]["baseColorTexture"] = {{"index", 0}};
    const TemporaryFolder folder;
    folder.write("my image%.png", bytes_of(corpus / "checker.png"));
    EXPECT_EQ(LoadedModel(folder.write("m.gltf", model.dump())).scene.arrays().textures.name,
              std::vector<std::string>{"my image%"});
}

TEST(Gltf, IntegerAttributesAreErrors) {
    for (const char *attribute : {"POSITION", "NORMAL", "TEXCOORD_0"}) {
        Json model = document();
        const Json &index = model["meshes"][0]["primitives"][0]["attributes"][attribute];
        model["accessors"][index.get<size_t>()]["componentType"] = 5123;
        expect_input_error("mesh 'triangle': " + std::string(attribute) + " is stored as integers",
                           [&] { loaded(model); });
    }
}

TEST(Gltf, HonoursTheFilterOfTheSampler) {
    Json model = document();
    model["images"] = {{{"uri", checker}}};
    model["textures"] = {{{"source", 0}, {"sampler", 0}}};
    model["materials"][0]["pbrMetallicRoughness"]["baseColorTexture"] = {{"index", 0}};
    using Filter = TextureArrays::Filter;
    for (const auto &[stated, filter] :
         {std::pair(9728, Filter::nearest), std::pair(9729, Filter::bilinear)}) {
        model["samplers"] = {{{"magFilter", stated}}};
        EXPECT_EQ(loaded(model).scene.arrays().textures.filter, std::vector<Filter>{filter});
    }
    // Textures that differ in the filter alone are not shared.
    model["samplers"] = {{{"magFilter", 9728}}, {{"magFilter", 9729}}};
    model["textures"].push_back({{"source", 0}, {"sampler", 1}});
    model["materials"].push_back(model["materials"][0]);
    model["materials"][1]["pbrMetallicRoughness"]["baseColorTexture"] = {{"index", 1}};
    model["meshes"][0]["primitives"].push_back(model["meshes"][0]["primitives"][0]);
    model["meshes"][0]["primitives"][1]["material"] = 1;
    EXPECT_EQ(loaded(model).scene.arrays().textures.filter,
              (std::vector<Filter>{Filter::nearest, Filter::bilinear}));
}

TEST(Gltf, HonoursTheWrapModesOfTheSampler) {
    Json model = document();
    model["images"] = {{{"uri", checker}}};
    model["textures"] = {{{"source", 0}, {"sampler", 0}}};
    model["materials"][0]["pbrMetallicRoughness"]["baseColorTexture"] = {{"index", 0}};
    using Wrap = TextureArrays::Wrap;
    for (const auto &[stated, wrap] :
         {std::pair(33071, Wrap::clamp), std::pair(10497, Wrap::repeat),
          std::pair(33648, Wrap::mirror)}) {
        model["samplers"] = {{{"wrapS", stated}, {"wrapT", stated}}};
        EXPECT_EQ(loaded(model).scene.arrays().textures.wrap, std::vector<Wrap>{wrap});
    }
}

TEST(Gltf, CamerasMayBeOrthographic) {
    Json model = document();
    model["cameras"][0] = {
        {"type", "orthographic"},
        {"orthographic", {{"xmag", 3}, {"ymag", 1.5}, {"znear", 0.1}, {"zfar", 10}}}};
    const LoadedModel read = loaded(model);
    EXPECT_EQ(read.scene.cameras().view_size.at(0), 6);
    EXPECT_EQ(read.scene.film_width(), 2 * read.scene.film_height());
}

TEST(Gltf, NamesWhatIsDropped) {
    Json model = document();
    model["scenes"].push_back(model["scenes"][0]);
    model["extensions"]["KHR_lights_punctual"]["lights"][0]["range"] = 5;
    model["materials"][0]["emissiveFactor"] = {1, 1, 1};
    model["materials"][0]["doubleSided"] = true;
    const LoadedModel read = loaded(model);
    for (const char *text :
         {"only the default scene is used", "ranges of lights are ignored (1: bulb)",
          "emission of two-sided materials leaves the front only (1: brass)"}) {
        EXPECT_TRUE(read.says(text)) << text << "\n" << read.told;
    }
}

TEST(Gltf, NotesBuffersThatAreLongerThanStated) {
    Json model = document();
    model["buffers"][0]["uri"] = "m.bin";
    const TemporaryFolder folder;
    folder.write("m.bin", std::string(102, '\0'));
    const auto path = folder.write("m.gltf", model.dump());
    EXPECT_FALSE(LoadedModel(path).says("longer than stated"));
    folder.write("m.bin", std::string(106, '\0'));
    EXPECT_TRUE(LoadedModel(path).says("buffers are longer than stated"));
}

TEST(Gltf, MaterialsWithoutNamesKeepTheirExtensions) {
    Json model = document();
    model["extensionsUsed"].push_back("KHR_materials_emissive_strength");
    Json lamp = model["materials"][0];
    lamp.erase("name");
    lamp["emissiveFactor"] = {1, 1, 1};
    model["materials"] = Json::array();
    // The first mesh has the last material.
    for (const double strength : {2, 3, 4}) {
        lamp["extensions"]["KHR_materials_emissive_strength"] = {{"emissiveStrength", strength}};
        model["materials"].push_back(lamp);
    }
    model["meshes"].push_back(model["meshes"][0]);
    model["meshes"][0]["primitives"][0]["material"] = 2;
    model["meshes"][1]["primitives"][0]["material"] = 1;
    for (Json &node : model["nodes"]) {
        if (node.contains("mesh")) {
            node["mesh"] = node["name"] == "left" ? 0 : 1;
        }
    }
    const LoadedModel read = loaded(model);
    const LightArrays &lights = read.scene.lights();
    EXPECT_EQ(lights.radiance.at(read.light("left")), Vector3f::Constant(4));
    EXPECT_EQ(lights.radiance.at(read.light("right")), Vector3f::Constant(3));
}

TEST(Gltf, TransmissionIsAMixtureOfBaseAndRefraction) {
    Json model = document();
    Json &material = model["materials"][0];
    model["extensionsUsed"] =
        Json::array({"KHR_materials_transmission", "KHR_materials_volume", "KHR_materials_ior"});
    material["pbrMetallicRoughness"] = {
        {"baseColorFactor", {0.8, 0.6, 0.4, 1}}, {"metallicFactor", 0}, {"roughnessFactor", 0}};
    material["extensions"] = {{"KHR_materials_ior", {{"ior", 1.4}}},
                              {"KHR_materials_transmission", {{"transmissionFactor", 0.25}}},
                              {"KHR_materials_volume", {{"thicknessFactor", 1}}}};
    const LoadedModel quarter = loaded(model);
    const auto part = quarter.material("brass");
    ASSERT_EQ(part.size(), 3u);
    EXPECT_EQ(part[0].kind, Kind::ideal_reflection);
    EXPECT_DOUBLE_EQ(part[0].eta[0], 1.4);
    EXPECT_EQ(part[1].kind, Kind::lambert);
    EXPECT_LT((part[1].weight - Vector3f(0.6f, 0.45f, 0.3f)).norm(), 1e-6f);
    EXPECT_EQ(part[2].kind, Kind::ideal_refraction);
    EXPECT_LT((part[2].weight - Vector3f(0.2f, 0.15f, 0.1f)).norm(), 1e-6f);
    EXPECT_TRUE(part[2].complement);
    EXPECT_FALSE(quarter.says("thin walls")) << quarter.told;

    material["extensions"]["KHR_materials_transmission"]["transmissionFactor"] = 1;
    material["extensions"]["KHR_materials_volume"] = {{"thicknessFactor", 0.5},
                                                      {"attenuationDistance", 0.25},
                                                      {"attenuationColor", {1, 0.5, 0.25}}};
    const LoadedModel full = loaded(model);
    const auto glass = full.material("brass");
    ASSERT_EQ(glass.size(), 2u);
    // Two lengths of attenuation are passed by two crossings, so each has one.
    EXPECT_LT((glass[1].weight - Vector3f(0.8f, 0.3f, 0.1f)).norm(), 1e-6f);
    EXPECT_TRUE(full.says("absorption in volumes is replaced by a colour at each crossing"))
        << full.told;
}

TEST(Gltf, SpecularScalesTheReflectanceOfTheCoat) {
    Json model = document();
    model["extensionsUsed"].push_back("KHR_materials_specular");
    Json &material = model["materials"][0];
    material["pbrMetallicRoughness"]["metallicFactor"] = 0;
    Json &specular = material["extensions"]["KHR_materials_specular"];
    specular = {{"specularFactor", 0.25}};
    const LoadedModel quarter = loaded(model);
    const auto coat = quarter.material("brass");
    ASSERT_EQ(coat.size(), 2u);
    // A reflectance of 0.04 / 4 is that of (1 + 0.1) / (1 - 0.1).
    EXPECT_NEAR(coat[0].eta[0], 1.1 / 0.9, 1e-12);
    EXPECT_TRUE(quarter.says("KHR_materials_specular is honoured at normal incidence only"))
        << quarter.told;
    specular = {{"specularFactor", 0}};
    const auto bare = loaded(model).material("brass");
    ASSERT_EQ(bare.size(), 1u);
    EXPECT_EQ(bare[0].kind, Kind::lambert);
}

/// A Collada file with a spot light at (0, 0, 2), whose element has these statements.
std::string spot_file(const std::string &statements) {
    std::string text = bytes_of(corpus / "plane.dae");
    const size_t begin = text.find("<point>");
    const size_t end = text.find("</point>");
    EXPECT_NE(begin, std::string::npos);
    EXPECT_NE(end, std::string::npos);
    return text.replace(begin, end + 8 - begin,
                        "<spot><color>4 3 2</color>" + statements + "</spot>");
}

TEST(Collada, TheFalloffAngleIsTheFullCone) {
    const TemporaryFolder folder;
    const LoadedModel model(
        folder.write("spot.dae", spot_file("<falloff_angle>60</falloff_angle>")));
    const LightArrays &lights = model.scene.lights();
    ASSERT_EQ(lights.kind, std::vector<LightArrays::Kind>{LightArrays::Kind::spot});
    EXPECT_NEAR(2 * std::tan(lights.outer_angle[0]), 1.1547, 1e-4);  // lit radius at distance 2
    EXPECT_LT(lights.inner_angle[0], lights.outer_angle[0]);
    EXPECT_GT(lights.inner_angle[0], 0.98 * lights.outer_angle[0]);
    const LoadedModel soft(
        folder.write("soft.dae", spot_file("<falloff_angle>60</falloff_angle>"
                                           "<falloff_exponent>2</falloff_exponent>")));
    EXPECT_NEAR(soft.scene.lights().outer_angle[0], 30 * degree, 1e-5);
    EXPECT_TRUE(soft.says("falloff_exponent of spot lights is ignored")) << soft.told;
}

TEST(Fbx, LengthsAreInMetres) {
    Assimp::Importer importer;
    const aiScene *squares = importer.ReadFile((corpus / "triangle.stl").string(), 0);
    ASSERT_NE(squares, nullptr);
    const TemporaryFolder folder;
    const std::string path = (folder.path() / "a.fbx").string();
    ASSERT_EQ(Assimp::Exporter().Export(squares, "fbxa", path), aiReturn_SUCCESS);
    const LoadedModel centimetres(path);
    EXPECT_TRUE(centimetres.says("lengths are converted to metres by the factor 0.01"))
        << centimetres.told;
    std::string text = bytes_of(path);
    const std::string before = "\"UnitScaleFactor\", \"double\", \"Number\", \"\", 1";
    const size_t at = text.find(before);
    ASSERT_NE(at, std::string::npos) << text;
    const LoadedModel metres(folder.write("b.fbx", text.insert(at + before.size(), "00")));
    EXPECT_FALSE(metres.says("lengths are converted")) << metres.told;
    const double size = metres.scene.graph().bounds().diagonal().norm();
    EXPECT_NEAR(centimetres.scene.graph().bounds().diagonal().norm(), 0.01 * size, 1e-9 * size);
}

TEST(Fbx, LightsAndGeometryHaveOneUnit) {
    // A square of 8 m in centimetres, and a spot light 2 m above it.
    const TemporaryFolder folder;
    const LoadedModel model(folder.write("spot.fbx", R"(; FBX 7.3.0 project file
FBXHeaderExtension: {
    FBXHeaderVersion: 1003
    FBXVersion: 7300
}
GlobalSettings: {
    Version: 1000
    Properties70: {
        P: "UnitScaleFactor", "double", "Number", "",1
    }
}
Objects: {
    Geometry: 1, "Geometry::Plane", "Mesh" {
        Vertices: *12 {
            a: -400,0,400,400,0,400,-400,0,-400,400,0,-400
        }
        PolygonVertexIndex: *4 {
            a: 0,1,3,-3
        }
        GeometryVersion: 124
    }
    NodeAttribute: 2, "NodeAttribute::Spot", "Light" {
        TypeFlags: "Light"
        GeometryVersion: 124
        Properties70: {
            P: "LightType", "enum", "", "",2
            P: "Color", "Color", "", "A",1,0.5,0.25
            P: "Intensity", "Number", "", "A",10000
            P: "DecayType", "enum", "", "",2
            P: "InnerAngle", "Number", "", "A",30
            P: "OuterAngle", "Number", "", "A",60
        }
    }
    Model: 3, "Model::Plane", "Mesh" {
        Version: 232
    }
    Model: 4, "Model::Spot", "Light" {
        Version: 232
        Properties70: {
            P: "Lcl Translation", "Lcl Translation", "", "A",0,200,0
        }
    }
}
Connections: {
    C: "OO",3,0
    C: "OO",4,0
    C: "OO",1,3
    C: "OO",2,4
}
)"));
    const Eigen::AlignedBox3d bounds = model.scene.graph().bounds();
    EXPECT_LT((bounds.min() - Vector3d(-4, 0, -4)).norm(), 1e-6);
    EXPECT_LT((bounds.max() - Vector3d(4, 0, 4)).norm(), 1e-6);
    const LightArrays &lights = model.scene.lights();
    ASSERT_EQ(lights.kind, std::vector<LightArrays::Kind>{LightArrays::Kind::spot});
    EXPECT_LT((lights.world_from_light[0].col(3) - Eigen::Vector4d(0, 2, 0, 1)).norm(), 1e-6);
    EXPECT_LT((lights.world_from_light[0].col(2) - Eigen::Vector4d(0, 1, 0, 0)).norm(), 1e-6);
    EXPECT_LT((lights.radiance[0] - Vector3f(100, 50, 25)).norm(), 1e-3f);
    EXPECT_NEAR(lights.outer_angle[0], 30 * degree, 1e-6);
    EXPECT_NEAR(lights.inner_angle[0], 15 * degree, 1e-6);
}

}  // namespace
}  // namespace rtrays
