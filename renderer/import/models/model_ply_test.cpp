// SPDX-License-Identifier: MIT
// Tests the import of PLY files, and the processing of faces to a mesh for all formats.
#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <cmath>

#include "renderer/base/notice.h"
#include "renderer/import/json/scene_json.h"
#include "renderer/import/models/geometry.h"
#include "renderer/import/models/model_file.h"
#include "renderer/import/models/ply.h"
#include "renderer/scene/cores/transform.h"
#include "renderer/testing/errors.h"
#include "renderer/testing/temporary_folder.h"

namespace rtrays {
namespace {

using Eigen::Vector2d;
using Eigen::Vector3d;
using Geometry = MeshCore::Geometry;

const std::filesystem::path corpus = RTRAYS_CORPUS;

/// Returns a PLY file with a header of vertices x, y, z and of faces, and a body.
std::string ply(const std::string &vertices, const std::string &faces, const std::string &body) {
    return "ply\nformat ascii 1.0\nelement vertex " + vertices +
           "\nproperty float x\nproperty float y\nproperty double z\nelement face " + faces +
           "\nproperty list uchar int vertex_index\nend_header\n" + body;
}

PlyFile read(const std::string &content) {
    const TemporaryFolder folder;
    ModelNotes notes("in.ply");
    return read_ply(folder.write("in.ply", content), notes, true);
}

TEST(Ply, ReadsEveryEncodingAlike) {
    for (const char *name : {"square.ply", "square_little.ply", "square_big.ply"}) {
        SCOPED_TRACE(name);
        ModelNotes notes(name);
        const PlyFile file = read_ply(corpus / name, notes, true);
        EXPECT_EQ(file.geometry.vertices,
                  (std::vector<Vector3d>{{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}, {0.5, 2, 0}}));
        EXPECT_EQ(file.geometry.triangles,
                  (std::vector<Triangle>{{0, 1, 2}, {0, 2, 3}, {3, 2, 4}}));
        EXPECT_EQ(file.geometry.normals, std::vector<Vector3d>(5, {0, 0, 1}));
        EXPECT_EQ(file.geometry.uvs,
                  (std::vector<Vector2d>{{0, 0}, {1, 0}, {1, 1}, {0, 1}, {0.5, 2}}));
        EXPECT_EQ(file.material, (std::vector<int64_t>{0, 0, 1}));
    }
}

TEST(Ply, ReadsNumbersInEveryLegalForm) {
    const PlyFile file = read(ply("3", "1", "+1e0 -2.5E-1\t3\r\n1e-400 0 0\n0 1 0\n\n3 0 1\n2"));
    EXPECT_EQ(file.geometry.vertices, (std::vector<Vector3d>{{1, -0.25, 3}, {0, 0, 0}, {0, 1, 0}}));
    EXPECT_TRUE(file.geometry.normals.empty());
    EXPECT_TRUE(file.material.empty());
}

TEST(Ply, LeavesOutWhatMeansNothingHereAndSaysSo) {
    std::vector<std::string> told;
    const NoticeReceiver receiver([&](const std::string &text) { told.push_back(text); });
    const TemporaryFolder folder;
    const auto path =
        folder.write("in.ply",
                     "ply\nformat ascii 1.0\nelement camera 1\nproperty list uchar float "
                     "view\nelement vertex 4\nproperty float x\n"
                     "property float y\nproperty float z\nproperty uchar red\nproperty list "
                     "uchar int near\nelement face 2\n"
                     "property list uchar int vertex_indices\nend_header\n2 0.5 0.5\n0 0 0 1 "
                     "0\n1 0 0 2 1 3\n1 1 0 3 2 1 2\n"
                     "0 1 0 4 0\n2 0 1\n4 0 1 2 3\n");
    const auto mesh = load_mesh_file(path, "m");
    EXPECT_EQ(mesh->vertices().size(), 4u);
    EXPECT_EQ(mesh->triangles().size(), 2u);
    ASSERT_EQ(told.size(), 4u);
    EXPECT_NE(told[0].find("points and lines are ignored (1: face 0 of in.ply)"), std::string::npos)
        << told[0];
    EXPECT_NE(told[1].find("unknown elements are ignored (1: camera)"), std::string::npos)
        << told[1];
    EXPECT_NE(told[2].find("(1: vertex near)"), std::string::npos) << told[2];
    EXPECT_NE(told[3].find("vertex colours without all of red"), std::string::npos) << told[3];
}

TEST(Ply, SaysWhatIsWrong) {
    const std::string three = "0 0 0\n1 0 0\n0 1 0\n";
    const struct {
        std::string content;
        const char *message;
    } cases[] = {
        {"", "is not a PLY file"},
        {"plyx\n", "is not a PLY file"},
        {"ply\nformat ascii 1.0\n", "header: missing end_header"},
        {"ply\nelement vertex 3\nend_header\n", "header: missing format"},
        {"ply\nformat utf8 1.0\nend_header\n", "unknown format 'utf8'; formats are: ascii, "},
        {"ply\nformat ascii 1.0\nproperty float x\nend_header\n", "before the first element"},
        {"ply\nformat ascii 1.0\nelement vertex 3\nproperty real x\nend_header\n",
         "unknown type 'real'; types are: char, "},
        {"ply\nformat ascii 1.0\nelement vertex -3\nend_header\n",
         "expected a number of elements, got '-3'"},
        {"ply\nformat ascii 1.0\nelement vertex 3\nelement vertex 3\nend_header\n",
         "duplicate element 'vertex'"},
        {"ply\nformat ascii 1.0\nelement vertex 3\nproperty int x\nproperty int x\nend_header\n",
         "duplicate property 'x'"},
        {"ply\nformat ascii 1.0\nelement face 1\nproperty list float int "
         "vertex_index\nend_header\n",
         "must have an integer type"},
        {"ply\nformat ascii 1.0\nelement face 9999999999999999999\nproperty int a\nend_header\n1\n",
         "too short for the"},
        {"ply\nformat ascii 1.0\nelement vertex 1\nproperty float x\nend_header\n0\n",
         "vertices require the properties x, y and z"},
        {"ply\nformat ascii 1.0\nelement face 1\nproperty int a\nend_header\n1\n",
         "faces require one list 'vertex_indices'"},
        {"ply\nformat ascii 1.0\nelement vertex 99999999999999999999999\nend_header\n",
         "expected a number of elements"},
        {"ply\nformat ascii 1.0\nelement void 4000000000000000000\nend_header\n",
         "the file has no faces"},
        {ply("4000000000", "1", three + "3 0 1 2\n"),
         "too short for the 4000000000 rows of 'vertex'"},
        {ply("3", "0", three), "the file has no faces"},
        {ply("3", "1", three + "2 0 1\n"), "the file has no faces"},
        {ply("3", "1", three + "3 0 1\n"), "face 0: unexpected end of file"},
        {ply("3", "1", three + "3 0 1 3\n"), "face 0 has vertex index 3, but there are only 3"},
        {ply("3", "1", three + "3 0 1 -2\n"), "face 0: -2 is not a valid vertex index"},
        {ply("3", "1", three + "-1 0 1 2\n"), "face 0: -1 is not a valid number of corners"},
        {ply("3", "1", three + "3 0 1 1.5\n"), "1.5 is not a valid vertex index"},
        {ply("3", "1", three + "3 0 1 2\n0\n"), "2 bytes follow the last element"},
        {ply("3", "0", three + "3 0 1 2\n"), "8 bytes follow the last element"},
        {ply("3", "1", "0 0 0\n1 x 0\n0 1 0\n3 0 1 2\n"), "vertex 1: expected a number"},
    };
    for (const auto &each : cases) {
        SCOPED_TRACE(each.message);
        const std::string message = error_of(ExitCode::bad_input, [&] { read(each.content); });
        EXPECT_NE(message.find(each.message), std::string::npos) << message;
        EXPECT_NE(message.find("in.ply: "), std::string::npos) << message;
    }
    ModelNotes notes("none.ply");
    expect_input_error("none.ply: cannot be read", [&] { read_ply("none.ply", notes, true); });
    for (const char *infinite : {"1e999", "inf", "nan"}) {
        const TemporaryFolder folder;
        const auto path = folder.write(
            "in.ply", ply("3", "1", "0 0 0\n1 0 0\n0 1 " + std::string(infinite) + "\n3 0 1 2\n"));
        expect_input_error("vertex 2 is not finite", [&] { load_mesh_file(path, "m"); });
    }
}

TEST(Ply, BytesAfterTheLastElementAreErrors) {
    const std::string header =
        "ply\nformat binary_little_endian 1.0\nelement vertex 3\nproperty char x\nproperty char y\n"
        "property char z\nelement face 1\nproperty list uchar uchar vertex_indices\nend_header\n";
    const std::string body("\0\0\0\x0a\0\0\0\1\0\3\0\1\2", 13);
    EXPECT_EQ(read(header + body).geometry.triangles.size(), 1u);
    expect_input_error("in.ply: 1 bytes follow the last element",
                       [&] { read(header + body + "\n"); });
    // A change of line endings made "\n" of the body "\r\n", which shifts what follows.
    std::string damaged = body;
    damaged.insert(3, "\r");
    expect_input_error("in.ply: ", [&] { read(header + damaged); });
    // The header states fewer faces than the file has.
    expect_input_error("bytes follow the last element; the header states too few elements",
                       [&] { read(header + body + std::string("\3\0\1\2", 4)); });
}

TEST(ModelGeometry, CountsNormalsThatOpposeTheWinding) {
    Geometry geometry;
    geometry.vertices = {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}};
    geometry.triangles = {{0, 1, 2}, {0, 3, 2}, {0, 0, 0}};
    EXPECT_EQ(count_opposed(MeshCore("m", geometry)), 0u);
    geometry.normals = std::vector<Vector3d>(4, {0, 0.9, 0.1});
    EXPECT_EQ(count_opposed(MeshCore("m", geometry)), 1u);
}

TEST(ModelGeometry, JoinsEqualVerticesOnly) {
    Geometry geometry;
    geometry.vertices = {{9, 9, 9},    {0, 0, 0}, {1, 0, 0}, {0, 1, 0},
                         {-0.0, 0, 0}, {0, 1, 0}, {1, 0, 0}};
    geometry.uvs = {{0, 0}, {0, 0}, {1, 0}, {0, 1}, {0, 0}, {0, 1}, {1, 0.5}};
    geometry.triangles = {{1, 2, 3}, {4, 5, 6}};
    join_vertices(geometry);
    EXPECT_EQ(geometry.triangles, (std::vector<Triangle>{{0, 1, 2}, {0, 2, 3}}));
    EXPECT_EQ(geometry.vertices,
              (std::vector<Vector3d>{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {1, 0, 0}}));
    EXPECT_EQ(geometry.uvs[3], Vector2d(1, 0.5));
}

TEST(ModelGeometry, SmoothNormalsOfACubeCornerAreItsDiagonal) {
    // Three sides meet at the origin. One consists of two triangles and would count twice without
    // weights.
    Geometry geometry;
    geometry.vertices = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}, {1, 1, 0}};
    geometry.triangles = {{0, 4, 1}, {0, 2, 4}, {0, 1, 3}, {0, 3, 2}};
    make_smooth_normals(geometry);
    EXPECT_LT((geometry.normals[0] - Vector3d(-1, -1, -1).normalized()).norm(), 1e-15);
    EXPECT_LT((geometry.normals[4] - Vector3d(0, 0, -1)).norm(), 1e-15);
}

TEST(ModelGeometry, RepairsOnlyBrokenNormals) {
    Geometry geometry;
    geometry.vertices = {{0, 0, 0}, {1e200, 0, 0}, {0, 1e200, 0}};
    geometry.triangles = {{0, 1, 2}};
    geometry.normals = {{0, 0, 0}, {0, 1, 1}, {std::nan(""), 0, 0}};
    ModelNotes notes("in");
    repair_normals(geometry, "m", notes);
    EXPECT_EQ(geometry.normals, (std::vector<Vector3d>{{0, 0, 1}, {0, 1, 1}, {0, 0, 1}}));
}

TEST(ModelGeometry, AppendsTransformedParts) {
    Geometry part;
    part.vertices = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}};
    part.triangles = {{0, 1, 2}};
    part.normals = std::vector<Vector3d>(3, Vector3d(0, 1, 1).normalized());
    Geometry all;
    append_geometry(all, part, Eigen::Matrix4d::Identity());
    append_geometry(all, part, scaling({1, 1, -2}));
    part.normals.clear();
    part.uvs = {{0, 0}, {1, 0}, {0, 1}};
    append_geometry(all, part, translation({0, 0, 5}));
    // A reflection reverses the vertex order. The front stays on the same side of the object, which
    // now is below.
    EXPECT_EQ(all.triangles, (std::vector<Triangle>{{0, 1, 2}, {3, 5, 4}, {6, 7, 8}}));
    EXPECT_LT((all.normals[3] - Vector3d(0, 1, -0.5).normalized()).norm(), 1e-15);
    EXPECT_EQ(all.normals[6], Vector3d(0, 0, 1));
    EXPECT_EQ(all.vertices[6], Vector3d(0, 0, 5));
    EXPECT_EQ(all.uvs[1], Vector2d(0, 0));
    EXPECT_EQ(all.uvs[7], Vector2d(1, 0));
}

TEST(ModelGeometry, SplitsByGroup) {
    Geometry geometry;
    geometry.vertices = {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}};
    geometry.triangles = {{0, 1, 2}, {0, 2, 3}, {2, 1, 0}};
    const auto parts = split_geometry(geometry, {7, 3, 7});
    ASSERT_EQ(parts.size(), 2u);
    EXPECT_EQ(parts.at(3).vertices, (std::vector<Vector3d>{{0, 0, 0}, {1, 1, 0}, {0, 1, 0}}));
    EXPECT_EQ(parts.at(7).triangles, (std::vector<Triangle>{{0, 1, 2}, {2, 1, 0}}));
}

TEST(ModelGeometry, SplitsPolygonsWithoutLosingArea) {
    Geometry geometry;
    geometry.vertices = {{0, 0, 0}, {2, 0, 0}, {2, 2, 0}, {1, 0.5, 0}, {0, 2, 0}};
    const uint32_t arrow[] = {0, 1, 2, 3, 4};
    ModelNotes notes("in");
    EXPECT_EQ(add_face(arrow, 5, 0, "m", geometry, notes), 3u);
    double area = 0;
    for (const Triangle &t : geometry.triangles) {
        const Vector3d &a = geometry.vertices[t[0]];
        const double signed_area =
            0.5 * (geometry.vertices[t[1]] - a).cross(geometry.vertices[t[2]] - a).z();
        EXPECT_GE(signed_area, 0);
        area += signed_area;
    }
    EXPECT_DOUBLE_EQ(area, 2.5);  // the square without the triangle (2, 2), (1, 0.5), (0, 2)
}

TEST(MeshFile, OptionsChooseNormalsAndFlipV) {
    MeshFileOptions options;
    EXPECT_EQ(load_mesh_file(corpus / "square.ply", "m", options)->normals().size(), 5u);
    options.normals = MeshFileOptions::Normals::none;
    options.flip_v = true;
    const auto flat = load_mesh_file(corpus / "square.ply", "m", options);
    EXPECT_TRUE(flat->normals().empty());
    EXPECT_EQ(flat->uvs()[4], Vector2d(0.5, -1));
    options.normals = MeshFileOptions::Normals::smooth;
    const TemporaryFolder folder;
    const auto path = folder.write("in.ply", ply("3", "1", "0 0 0\n0 1 0\n0 0 1\n3 0 1 2\n"));
    EXPECT_EQ(load_mesh_file(path, "m", options)->normals(),
              std::vector<Vector3d>(3, Vector3d(1, 0, 0)));
}

TEST(MeshFile, IsGeometryOfScenes) {
    const auto scene = [](const std::string &geometry) {
        return parse_scene_json(
            R"({"version": 1, "film": {"width": 8, "height": 8}, "nodes": [
            {"name": "eye", "camera": {"type": "pinhole", "fov": 60, "fov_axis": "x"}},
            {"name": "square", "geometry": )" +
                geometry +
                R"(, "material": {"type": "lambert", "reflectance": [0.5, 0.5, 0.5]}}]})",
            "in.json", "in", corpus);
    };
    EXPECT_TRUE(scene(R"({"type": "file", "file": "square.ply"})").meshes().has_normals[0]);
    const Scene flat =
        scene(R"({"type": "file", "file": "square.ply", "shading_normals": "none"})");
    EXPECT_FALSE(flat.meshes().has_normals[0]);
    EXPECT_EQ(flat.meshes().triangle_count[0], 3u);
    const std::string missing =
        error_of(ExitCode::bad_input, [&] { scene(R"({"type": "file", "file": "no.ply"})"); });
    EXPECT_NE(missing.find("in.json:3"), std::string::npos) << missing;
    EXPECT_NE(missing.find("no.ply: cannot be read"), std::string::npos) << missing;
    expect_input_error("shading_normals", [&] {
        scene(R"({"type": "file", "file": "square.ply", "shading_normals": 1})");
    });
}

}  // namespace
}  // namespace rtrays
