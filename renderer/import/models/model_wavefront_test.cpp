// SPDX-License-Identifier: MIT
// Tests the readers of OBJ and MTL files.
#include <gtest/gtest.h>

#include <cmath>

#include "renderer/import/models/model_file.h"
#include "renderer/import/models/obj.h"
#include "renderer/scene/cores/material.h"
#include "renderer/testing/errors.h"
#include "renderer/testing/loaded_model.h"
#include "renderer/testing/temporary_folder.h"

namespace rtrays {
namespace {

using Eigen::Vector2d;
using Eigen::Vector3d;
using Eigen::Vector3f;
using Kind = BxdfComponent::Kind;
using Fresnel = BxdfComponent::Fresnel;

const std::filesystem::path corpus = RTRAYS_CORPUS;

/// Returns the triangles of an OBJ text, whose file is named in.obj.
MeshCore::Geometry geometry_of(const std::string &text) {
    const TemporaryFolder folder;
    const auto mesh = load_mesh_file(folder.write("in.obj", text), "m");
    return {mesh->vertices(), mesh->triangles(), mesh->normals(), mesh->uvs()};
}

/// A square with the material `m`, after other statements.
std::string square(const std::string &statements) {
    return statements +
           "v -1 -1 0\nv 1 -1 0\nv 1 1 0\nv -1 1 0\nvt 0 0\nvt 1 0\nvt 1 1\nvt 0 1\n"
           "usemtl m\nf 1/1 2/2 3/3 4/4\n";
}

/// Loads a square whose material `m` has these statements.
LoadedModel with_material(const std::string &statements) {
    const TemporaryFolder folder;
    folder.write("a.png", bytes_of(corpus / "checker.png"));
    folder.write("a.mtl", "newmtl m\n" + statements);
    return LoadedModel(folder.write("m.obj", square("mtllib a.mtl\n")));
}

/// Returns the message of the error about a material `m` with these statements.
std::string error_of_material(const std::string &statements) {
    return error_of(ExitCode::bad_input, [&] { with_material(statements); });
}

TEST(Obj, ReadsEveryFormOfTheSameMesh) {
    const MeshCore::Geometry plain =
        geometry_of("v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nv 3 3 3\nf 1 2 3\nf 1 3 4\n");
    EXPECT_EQ(plain.vertices, (std::vector<Vector3d>{{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}}));
    EXPECT_EQ(plain.triangles, (std::vector<Triangle>{{0, 1, 2}, {0, 2, 3}}));
    const char *const forms[] = {
        // comments after data
        "v 0 0 0 # 1 2\nv 1 0 0#3 4\nv 1 1 0 # 10 mm\nv 0 1 0\nf 1 2 3 # 4\nf 1 3 4# a\n",
        // numbers without a digit before or after the point, with signs and exponents
        "v .0 -.0 0.\nv +1 0 0\nv 1e0 10E-1 .0\nv 0 1. 0\nf 1 2 3\nf 1 3 4\n",
        // continued lines, also with CR LF
        "v 0 \\\n0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nf 1 2 \\\r\n3\nf \\\n1 \\\n3 4\n",
        // blanks at either end, tabs, empty lines
        "  v 0 0 0\n\tv\t1\t0\t0 \n\n   \n v 1 1 0\nv 0 1 0\n f 1 2 3  \n  f 1 3 4",
        // ends of lines of other systems, and a byte order mark
        "\xef\xbb\xbfv 0 0 0\r\nv 1 0 0\r\nv 1 1 0\r\nv 0 1 0\r\nf 1 2 3\r\nf 1 3 4\r\n",
        "v 0 0 0\rv 1 0 0\rv 1 1 0\rv 0 1 0\rf 1 2 3\rf 1 3 4\r",
        // indices from the end, and a quadrilateral
        "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nf -4 -3 -2 -1\n",
        // faces before their vertices
        "f 1 2 3\nf 1 3 4\nv 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\n",
        // colours and weights of vertices
        "v 0 0 0 1 0 0\nv 1 0 0 0 1 0\nv 1 1 0 1 1 1\nv 0 1 0 1\nf 1 2 3\nf 1 3 4\n"};
    for (const char *form : forms) {
        SCOPED_TRACE(form);
        const MeshCore::Geometry read = geometry_of(form);
        EXPECT_EQ(read.vertices, plain.vertices);
        EXPECT_EQ(read.triangles, plain.triangles);
    }
}

TEST(Obj, ReadsNormalsAndTextureCoordinates) {
    const std::string vertices = "v 0 0 0\nv 1 0 0\nv 0 1 0\nvt 0 0\nvt 1 0 0\nvt 0.5\nvn 0 0 2\n";
    const MeshCore::Geometry all = geometry_of(vertices + "f 1/1/1 2/2/-1 3/3/1\n");
    EXPECT_EQ(all.uvs, (std::vector<Vector2d>{{0, 0}, {1, 0}, {0.5, 0}}));
    EXPECT_EQ(all.normals, std::vector<Vector3d>(3, Vector3d(0, 0, 1)));
    const MeshCore::Geometry normals = geometry_of(vertices + "f 1//1 2//1 3//1\n");
    EXPECT_TRUE(normals.uvs.empty());
    EXPECT_EQ(normals.normals.size(), 3u);
    const MeshCore::Geometry partly = geometry_of(vertices + "f 1/1/1 2//1 3/3/1\n");
    EXPECT_TRUE(partly.uvs.empty());
    EXPECT_EQ(partly.normals.size(), 3u);
}

TEST(Obj, ErrorsNameTheLine) {
    const std::string three = "v 0 0 0\nv 1 0 0\nv 0 1 0\n";
    const struct {
        std::string content;
        const char *message;
    } cases[] = {
        {"v 0 0\n", "in.obj:1: a vertex needs 3 numbers, got 2"},
        {"v 0 0 0\n\nv 0 0 x\n", "in.obj:3: expected a number, got 'x'"},
        {"v 0 0 0 0 0 0 0 0 0\n", "in.obj:1: a vertex has more than 8 numbers"},
        {"v 0 1e999 0\n", "in.obj:1: '1e999' is not a finite number"},
        {"v 0 \\\n 0 nan\n", "in.obj:1: 'nan' is not a finite number"},
        {"vn 0 0\n", "in.obj:1: a normal needs 3 numbers, got 2"},
        {"vt\n", "in.obj:1: a texture coordinate needs 1 numbers, got 0"},
        {three + "f 1 2 4\n", "in.obj:4: the face has vertex index 4, but there are only 3"},
        {three + "f 1 2 -4\n", "in.obj:4: the face has vertex index -4, but there are only 3"},
        {three + "f 1/1 2/1 3/1\n", "in.obj:4: the face has texture coordinate index 1, but"},
        {three + "f 1 2 0\n", "in.obj:4: '0' is not a valid vertex index"},
        {three + "f 1 2 3.5\n", "in.obj:4: '3.5' is not a valid vertex index"},
        {three + "f 1 2 /3\n", "in.obj:4: '' is not a valid vertex index"},
        {three + "f 1/1/1/1 2 3\n", "in.obj:4: a corner has more than three indices"},
        {three + "l 1 2\n", "in.obj: the file has no faces"},
        {"", "in.obj: the file has no faces"},
    };
    for (const auto &each : cases) {
        SCOPED_TRACE(each.message);
        expect_input_error(each.message, [&] { geometry_of(each.content); });
    }
    expect_input_error("gone.obj: cannot be read", [] { load_mesh_file("gone.obj", "m"); });
}

TEST(Obj, NamesWhatItIgnores) {
    const TemporaryFolder folder;
    const LoadedModel model(folder.write("in.obj",
                                         "o tri\ns 1\nv 0 0 0 1 0 0\nv 1 0 0\nv 0 1 0 0.5\nvp 0 1\n"
                                         "usemtl lost\nf 1 2 3\nl 1 2\ncurv 0 1\n"));
    for (const char *text :
         {"vertex colours are decoded by the sRGB curve",
          "weights of vertices are ignored (1: line 5)", "points and lines are ignored (1: line 9)",
          "statements that are unsupported here are ignored (2: 'vp' in line 6, 'curv' in line 10)",
          "smoothing groups are ignored; faces without normals are flat (1: tri)",
          "materials without a definition have the colours of vertices (1: lost)"}) {
        EXPECT_TRUE(model.says(text)) << text << "\n" << model.told;
    }
    EXPECT_EQ(model.scene.meshes().name, std::vector<std::string>{"tri"});
}

TEST(Obj, CountsNormalsThatOpposeTheWinding) {
    const std::string text = "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nvn 0 0 1\nvn 0.6 0 -0.8\n";
    const TemporaryFolder folder;
    const LoadedModel opposed(
        folder.write("in.obj", text + "f 1//1 2//1 3//1\nf 1//2 3//2 4//2\n"));
    EXPECT_TRUE(
        opposed.says("normals oppose the winding, which decides what the front is (1: 1 of "
                     "2 triangles of "))
        << opposed.told;
    const LoadedModel agreeing(
        folder.write("in.obj", text + "f 1//1 2//1 3//1\nf 3//2 1//2 4//2\n"));
    EXPECT_FALSE(agreeing.says("oppose")) << agreeing.told;
}

TEST(Mtl, MapsTheMaterialsOfMtl) {
    const LoadedModel model(corpus / "materials.obj");
    EXPECT_EQ(model.scene.meshes().name.size(), 8u);
    EXPECT_EQ(model.scene.meshes().triangle.size(), 16u);
    EXPECT_EQ(model.scene.meshes().position.size(), 32u);  // merged; Assimp had six per square

    const auto matte = model.material("matte");
    ASSERT_EQ(matte.size(), 1u);
    EXPECT_EQ(matte[0].kind, Kind::lambert);
    EXPECT_EQ(matte[0].weight, Vector3f(0.5f, 0.25f, 0.125f));
    EXPECT_EQ(matte[0].texture, no_index);

    const auto checked = model.material("checked");
    ASSERT_EQ(checked.size(), 1u);
    ASSERT_NE(checked[0].texture, no_index);
    const TextureImage &image = *model.scene.arrays().textures.image[checked[0].texture];
    EXPECT_EQ(image.width, 4);
    EXPECT_TRUE(image.srgb);

    const auto shiny = model.material("shiny");
    ASSERT_EQ(shiny.size(), 2u);
    EXPECT_EQ(shiny[0].kind, Kind::lambert);
    EXPECT_EQ(shiny[1].kind, Kind::blinn);
    EXPECT_EQ(shiny[1].exponent, 50);
    EXPECT_EQ(shiny[1].weight, Vector3f::Constant(0.25f));

    const auto scaled = model.material("too_bright");  // the components would sum to 1.5 in red
    ASSERT_EQ(scaled.size(), 2u);
    EXPECT_LT((scaled[0].weight - Vector3f(0.5f, 1 / 3.0f, 1 / 3.0f)).norm(), 1e-6f);
    EXPECT_LT((scaled[1].weight - Vector3f(0.5f, 1 / 3.0f, 1 / 6.0f)).norm(), 1e-6f);
    EXPECT_TRUE(model.says("reflect more light than they receive are scaled down (1: too_bright)"))
        << model.told;

    const auto glass = model.material("glass");
    ASSERT_EQ(glass.size(), 2u);
    EXPECT_EQ(glass[0].kind, Kind::ideal_reflection);
    EXPECT_EQ(glass[1].kind, Kind::ideal_refraction);
    EXPECT_FLOAT_EQ(static_cast<float>(glass[1].eta[0]), 1.4f);
    EXPECT_EQ(glass[1].weight, Vector3f(0.9f, 0.8f, 0.7f));

    const auto metal = model.material("metal");
    ASSERT_EQ(metal.size(), 1u);
    EXPECT_EQ(metal[0].kind, Kind::microfacet_reflection);
    EXPECT_EQ(metal[0].fresnel, Fresnel::schlick);
    EXPECT_NEAR(metal[0].alpha[0], 0.1, 1e-12);  // 2 / (198 + 2) = 0.1^2
    EXPECT_LT((metal[0].eta - Vector3d(0.9, 0.6, 0.3)).norm(), 1e-6);

    const auto veil = model.material("veil");  // opacity 1/4
    ASSERT_EQ(veil.size(), 1u);
    EXPECT_EQ(veil[0].weight, Vector3f::Constant(0.5f));
    EXPECT_EQ(model.opacity("veil").value, 0.25);

    const LightArrays &lights = model.scene.lights();
    ASSERT_EQ(lights.name.size(), 1u);
    EXPECT_EQ(lights.kind[0], LightArrays::Kind::diffuse_area);
    EXPECT_EQ(lights.radiance[0], Vector3f(3, 2, 1));
    EXPECT_EQ(lights.area[0], 1);
    EXPECT_FALSE(model.says("it has no light"));
}

TEST(Mtl, TakesTheMaterialsOfPlyFromTheMtlBesideIt) {
    for (const char *name : {"square.ply", "square_little.ply", "square_big.ply"}) {
        SCOPED_TRACE(name);
        const LoadedModel model(corpus / name);
        EXPECT_EQ(model.scene.meshes().name, (std::vector<std::string>{"red", "blue"}));
        EXPECT_EQ(model.scene.meshes().triangle_count, (std::vector<uint32_t>{2, 1}));
        EXPECT_EQ(model.material("red")[0].weight, Vector3f(0.8f, 0.1f, 0.1f));
        EXPECT_EQ(model.material("blue")[0].weight, Vector3f(0.1f, 0.1f, 0.8f));
    }
    const TemporaryFolder folder;
    const auto alone = folder.write("alone.ply", bytes_of(corpus / "square.ply"));
    EXPECT_TRUE(LoadedModel(alone).says("alone.mtl is missing"));
    folder.write("alone.mtl", "newmtl only\nKd 0.5 0.5 0.5\n");
    expect_input_error("alone.ply: material_index 1 is out of range; alone.mtl has only 1",
                       [&] { LoadedModel model(alone); });
}

TEST(Mtl, ReadsColoursOfOneNumberAndOfThree) {
    EXPECT_EQ(with_material("Kd 0.8\n").material("m")[0].weight, Vector3f::Constant(0.8f));
    EXPECT_EQ(with_material("Kd 0.5 .25 1 # red\n").material("m")[0].weight,
              Vector3f(0.5f, 0.25f, 1));
    EXPECT_EQ(with_material("  kd .5\r\n\tKe 3\r\n").scene.lights().radiance[0], Vector3f(3, 3, 3));
}

TEST(Mtl, HonoursTheOptionsOfMaps) {
    const auto placement = [](const std::string &statement) {
        const LoadedModel model = with_material("Kd 1\n" + statement);
        const TextureArrays &t = model.scene.arrays().textures;
        EXPECT_EQ(t.name, std::vector<std::string>{"a"}) << statement;
        return std::tuple(t.uv_scale.at(0), t.uv_offset.at(0), t.wrap.at(0));
    };
    using Wrap = TextureArrays::Wrap;
    EXPECT_EQ(placement("map_Kd a.png\n"),
              std::tuple(Vector2d(1, 1), Vector2d(0, 0), Wrap::repeat));
    EXPECT_EQ(placement("map_Kd -s 2 3 1 a.png\n"),
              std::tuple(Vector2d(2, 3), Vector2d(0, 0), Wrap::repeat));
    EXPECT_EQ(placement("map_Kd -o 0.5 a.png\n"),
              std::tuple(Vector2d(1, 1), Vector2d(0.5, 0), Wrap::repeat));
    EXPECT_EQ(placement("map_Kd -clamp on -o .5 .25 0 -s 2 2 a.png # wood\n"),
              std::tuple(Vector2d(2, 2), Vector2d(0.5, 0.25), Wrap::clamp));
    const LoadedModel told = with_material("Kd 1\nmap_Kd -mm 0 2 -blendu off -t 1 1 1 a.png\n");
    EXPECT_TRUE(
        told.says("options of maps that are unsupported here are ignored (3: '-mm' in line "
                  "3, '-blendu' in line 3, '-t' in line 3)"))
        << told.told;
    EXPECT_NE(error_of_material("map_Kd -x 1 a.png\n").find("a.mtl:2: unknown option '-x'"),
              std::string::npos);
}

TEST(Mtl, MapsMultiplyTheEmission) {
    const LoadedModel model = with_material("Kd 0\nKe 3 2 1\nmap_Ke -s 2 2 a.png\n");
    EXPECT_EQ(model.scene.lights().radiance.at(0), Vector3f(3, 2, 1));
    const uint32_t texture = model.scene.materials().emission_texture.at(0);
    ASSERT_NE(texture, no_index);
    EXPECT_EQ(model.scene.arrays().textures.uv_scale.at(texture), Vector2d(2, 2));
    EXPECT_FALSE(model.says("emission")) << model.told;
}

TEST(Mtl, LooksForFilesBesideTheMtlFirst) {
    const TemporaryFolder folder;
    std::filesystem::create_directory(folder.path() / "mats");
    const auto model = folder.write("m.obj", square("mtllib mats/a.mtl\n"));
    folder.write("mats/a.mtl", "newmtl m\nKd 0.1\nmap_Kd a.hdr\n");
    folder.write("a.hdr", bytes_of(corpus / "sky.hdr"));
    const auto width = [&] {
        return LoadedModel(model).scene.arrays().textures.image.at(0)->width;
    };
    EXPECT_GT(width(), 0);
    folder.write("mats/a.hdr", "");
    expect_input_error("mats/a.hdr", [&] { LoadedModel read(model); });
}

TEST(Mtl, MissingFilesAreErrors) {
    const TemporaryFolder folder;
    const auto model = folder.write("m.obj", square("\nmtllib zz.mtl\n"));
    expect_input_error("m.obj:2: missing MTL file 'zz.mtl'", [&] { LoadedModel read(model); });
    EXPECT_EQ(load_mesh_file(model, "m")->triangles().size(), 2u);  // materials are not read
    folder.write("zz.mtl", "newmtl m\nmap_Kd nowhere.png\n");
    const std::string missing = error_of(ExitCode::bad_input, [&] { LoadedModel read(model); });
    EXPECT_NE(missing.find("material 'm'"), std::string::npos) << missing;
    EXPECT_NE(missing.find("nowhere.png: no such file"), std::string::npos) << missing;
    folder.write("nowhere.png", "not a picture");
    expect_input_error("nowhere.png", [&] { LoadedModel read(model); });
    // For a path of another machine, the file beside the MTL file is used.
    folder.write("zz.mtl", "newmtl m\nmap_Kd C:\\work\\tiles.png\n");
    folder.write("tiles.png", bytes_of(corpus / "checker.png"));
    EXPECT_EQ(LoadedModel(model).scene.arrays().textures.name, std::vector<std::string>{"tiles"});
}

TEST(Mtl, NamesThatTheSystemRefusesAreMissingFiles) {
    const TemporaryFolder folder;
    const std::string longest(5000, 'n');
    const auto model = folder.write("m.obj", square("\nmtllib zz.mtl\n"));
    folder.write("zz.mtl", "newmtl m\nmap_Kd " + longest + ".png\n");
    expect_input_error("no such file", [&] { LoadedModel read(model); });
    folder.write("m.obj", square("\nmtllib " + longest + "\n"));
    expect_input_error("m.obj:2: missing MTL file", [&] { LoadedModel read(model); });
}

TEST(Mtl, ReadsSeveralFilesAndNamesInAnyCase) {
    const TemporaryFolder folder;
    folder.write("a.mtl", "newmtl n\nKd 0.25\nnewmtl twice\nKd 0.1\n");
    folder.write("my b.mtl", "newmtl m\nKd 0.5\nnewmtl twice\nKd 0.2\n");
    folder.write("b.mtl", "newmtl m\nKd 0.75\n");
    const std::string more = "usemtl n\nf 1 2 3\nusemtl twice\nf 1 2 3\n";
    const LoadedModel model(
        folder.write("m.obj", square("mtllib A.MTL\nmtllib my b.mtl\n") + more));
    EXPECT_EQ(model.material("m")[0].weight, Vector3f::Constant(0.5f));
    EXPECT_EQ(model.material("n")[0].weight, Vector3f::Constant(0.25f));
    EXPECT_EQ(model.material("twice")[0].weight, Vector3f::Constant(0.1f));
    EXPECT_TRUE(model.says("differ in case from the files used (1: A.MTL is a.mtl)")) << model.told;
    EXPECT_TRUE(model.says("only the first of several materials of a name is used (1: twice)"))
        << model.told;
    const LoadedModel both(folder.write("m.obj", square("mtllib a.mtl b.mtl\n") + more));
    EXPECT_EQ(both.material("m")[0].weight, Vector3f::Constant(0.75f));
    // Exporters repeat the statement for every object.
    const LoadedModel repeated(folder.write("m.obj", square("mtllib b.mtl\nmtllib b.mtl\n")));
    EXPECT_FALSE(repeated.says("several materials")) << repeated.told;
}

TEST(Mtl, NamesInvisibleMaterialsAndContradictions) {
    const std::string invisible =
        "where 'Tr 1' or 'd 0' means opaque, set 'd 1' in the MTL file (1: m)";
    EXPECT_TRUE(with_material("Kd 0.5\nTr 1.0\n").says(invisible));
    EXPECT_TRUE(with_material("Kd 0.5\nd 0\n").says(invisible));
    const LoadedModel opaque = with_material("Kd 0.5\nd 1\nTr 1\n");
    EXPECT_FALSE(opaque.says(invisible));
    EXPECT_TRUE(opaque.says("'Tr' is ignored where it contradicts 'd' (1: m)")) << opaque.told;
    EXPECT_EQ(opaque.material("m").size(), 1u);
    EXPECT_EQ(with_material("Kd 0.5\nTr 0.75\n").opacity("m").value, 0.25);
}

TEST(Mtl, ReadsMapsOfTheOpacity) {
    // 2 x 1 texels: (10, 20, 30, 0) and (200, 100, 50, 255).
    std::string png;
    for (const char *at =
             "89504e470d0a1a0a0000000d4948445200000002000000010806000000f4227f8a000000114944"
             "4154789c63e4129163d81720f21f0006b1025f15db4efc0000000049454e44ae426082";
         *at != 0; at += 2) {
        png.push_back(static_cast<char>(std::stoi(std::string(at, 2), nullptr, 16)));
    }
    const auto load = [&](const std::string &statements) {
        const TemporaryFolder folder;
        folder.write("leaf.png", png);
        folder.write("mask.pgm", "P5 2 1 255\n\x07\x09");
        folder.write("a.mtl", "newmtl m\nKd 1\n" + statements);
        return LoadedModel(folder.write("m.obj", square("mtllib a.mtl\n")));
    };
    const std::vector<uint8_t> alpha = {0, 0, 0, 255, 255, 255};
    const LoadedModel stated = load("map_Kd leaf.png\nd 0.5\nmap_d -s 2 2 mask.pgm\n");
    EXPECT_EQ(stated.opacity("m").value, 0.5);
    EXPECT_EQ(stated.opacity_texels("m"), (std::vector<uint8_t>{7, 7, 7, 9, 9, 9}));
    EXPECT_EQ(stated.scene.arrays().textures.uv_scale[stated.opacity("m").texture], Vector2d(2, 2));
    EXPECT_EQ(load("map_d leaf.png\n").opacity_texels("m"), alpha)
        << "alpha counts if there is one";
    const LoadedModel implied = load("map_Kd leaf.png\n");
    EXPECT_EQ(implied.opacity_texels("m"), alpha);
    EXPECT_TRUE(implied.says("the alpha channel of map_Kd is the opacity (1: m)")) << implied.told;
    EXPECT_TRUE(load("map_Kd mask.pgm\n").opacity("m").is_opaque());
    EXPECT_TRUE(load("map_Tr mask.pgm\n").says("maps of Tr are ignored"));
}

TEST(Mtl, HasMapsOfNormalsAndHeights) {
    const auto load = [](const std::string &statements) {
        const TemporaryFolder folder;
        folder.write("grey.pgm", "P5 2 1 255\n\x07\x09");
        folder.write("blue.ppm", "P6 1 1 255\n\x80\x80\xff");
        folder.write("a.mtl", "newmtl m\nKd 1\n" + statements);
        return LoadedModel(folder.write("m.obj", square("mtllib a.mtl\n")));
    };
    using Map = NormalMap::Kind;
    const LoadedModel heights = load("map_Bump -bm 0.25 -s 2 2 grey.pgm\n");
    EXPECT_TRUE(heights.normal_map("m") == (NormalMap{Map::heights, 0, 0.25, true, true, false}));
    EXPECT_EQ(heights.scene.arrays().textures.uv_scale[0], Vector2d(2, 2));
    EXPECT_TRUE(heights.says("heights of map_Bump are in units of the model")) << heights.told;
    for (const char *keyword : {"norm", "map_Kn"}) {
        const LoadedModel normals = load(std::string(keyword) + " -bm 2 blue.ppm\nbump grey.pgm\n");
        EXPECT_TRUE(normals.normal_map("m") == (NormalMap{Map::normals, 0, 2, true, true, false}));
        EXPECT_FALSE(normals.scene.arrays().textures.image[0]->srgb) << "linear data";
        EXPECT_TRUE(normals.says("map_Bump is ignored beside a map of normals")) << normals.told;
    }
    const LoadedModel coloured = load("bump blue.ppm\n");
    EXPECT_TRUE(coloured.normal_map("m") == (NormalMap{Map::normals, 0, 1, true, true, false}));
    EXPECT_TRUE(coloured.says("coloured images of map_Bump are maps of normals")) << coloured.told;
    EXPECT_TRUE(load("").normal_map("m") == NormalMap());
}

TEST(Mtl, NamesWhatItIgnores) {
    const LoadedModel model = with_material(
        "Ka 1 1 1\nKd 0\nmap_Kd a.png\nmap_Ke a.png\ndisp none.png\nsharpness 60\n"
        "Pr 0.5\n");
    for (const char *text :
         {"ambient colours are ignored (1: m)", "displacement maps are ignored (1: m)",
          "statements that are unsupported here are ignored (1: 'sharpness' in line 7)",
          "map_Kd has no effect, because it is multiplied by 'Kd 0 0 0' (1: m)",
          "map_Ke has no effect, because it is multiplied by Ke, which is 0 (1: m)",
          "Pr without Pm and Pm without Pr are ignored (1: m)"}) {
        EXPECT_TRUE(model.says(text)) << text << "\n" << model.told;
    }
}

TEST(Mtl, MetalnessAndRoughnessMakeAMixture) {
    const auto m = with_material("Kd 0.8 0.6 0.4\nPr 0.5\nPm 0.25\n").material("m");
    ASSERT_EQ(m.size(), 3u);
    EXPECT_EQ(m[0].fresnel, Fresnel::schlick);
    EXPECT_EQ(m[0].weight, Vector3f::Constant(0.25f));
    EXPECT_DOUBLE_EQ(m[0].alpha[0], 0.25);
    EXPECT_EQ(m[1].eta[0], 1.5);
    EXPECT_TRUE(m[2].complement);
}

TEST(Mtl, ErrorsNameTheLine) {
    const struct {
        const char *statements;
        const char *message;
    } cases[] = {
        {"Kd 0.5 0.5\n", "a.mtl:2: expected one number or three, got 2"},
        {"\nKd x\n", "a.mtl:3: expected one number or three, got 'x'"},
        {"Kd spectral a.rfl\n", "a.mtl:2: colours of kind 'spectral' are unsupported"},
        {"Ns\n", "a.mtl:2: expected a number, got ''"},
        {"illum 11\n", "a.mtl:2: illum: 11 is not one of 0 to 10"},
        {"map_Kd -s 2 2\n", "a.mtl:2: map_Kd names no file"},
        {"Kd -1 0 0\n", "material 'm'"},
    };
    for (const auto &each : cases) {
        const std::string message = error_of_material(each.statements);
        EXPECT_NE(message.find(each.message), std::string::npos) << message;
    }
}

}  // namespace
}  // namespace rtrays
