// SPDX-License-Identifier: MIT
// Tests the import of scene files: their meaning, and a clear message for each error.
#include "renderer/import/json/scene_json.h"

#include <Eigen/Geometry>
#include <cmath>
#include <filesystem>
#include <random>

#include "renderer/base/files.h"
#include "renderer/import/load_scene.h"
#include "renderer/import/models/triangulate.h"
#include "renderer/testing/scene_builder.h"

namespace rtrays {
namespace {

using Eigen::Vector3d;
using Eigen::Vector3f;

const std::string scenes = RTRAYS_SCENES;

Scene parse(const std::string &text) {
    return parse_scene_json(text, "in.json", "in");
}

/// Returns a valid scene that contains the given nodes.
std::string with_nodes(const std::string &nodes) {
    return R"({"version": 1, "film": {"width": 8, "height": 4},
"materials": {"white": {"type": "lambert", "reflectance": [0.5, 0.5, 0.5]}},
"geometries": {"tile": {"type": "mesh", "vertices": [[0,0,0],[1,0,0],[1,1,0],[0,1,0]], "polygons": [[0,1,2,3]]}},
"nodes": [{"name": "eye", "camera": {"type": "pinhole", "fov": 60, "fov_axis": "x"}},
)" + nodes +
           "]}";
}

/// Returns the unit normal of the front of a triangle.
Vector3d front(const MeshArrays &meshes, size_t triangle) {
    const Triangle &t = meshes.triangle[triangle];
    const Vector3d a = meshes.position[t[0]].cast<double>();
    return (meshes.position[t[1]].cast<double>() - a)
        .cross(meshes.position[t[2]].cast<double>() - a)
        .normalized();
}

TEST(SceneJson, HasTheUsualIndexOfRefractionAndAxisOfView) {
    const auto described = [](const std::string &material, const std::string &camera) {
        return parse(R"({"version": 1, "film": {"width": 8, "height": 4}, "nodes": [
            {"name": "a", "geometry": {"type": "rectangle"}, "material": {)" +
                     material + R"(}}, {"name": "b", "camera": {)" + camera + "}}]}")
            .describe();
    };
    const std::string pinhole = R"("type": "pinhole", "fov": 40)";
    for (const std::string type : {R"("type": "glass")", R"("type": "thin_glass")",
                                   R"("type": "refraction", "transmittance": [1, 1, 1])",
                                   R"("type": "plastic", "reflectance": [0.5, 0.5, 0.5])",
                                   R"("type": "coated_diffuse", "reflectance": [0.5, 0.5, 0.5])",
                                   R"("type": "car_paint", "base": [0.5, 0.5, 0.5])"}) {
        EXPECT_EQ(described(type, pinhole), described(type + R"(, "eta": 1.5)", pinhole)) << type;
        EXPECT_NE(described(type, pinhole), described(type + R"(, "eta": 1.4)", pinhole)) << type;
    }
    const std::string glass = R"("type": "glass")",
                      parallel = R"("type": "orthographic", "size": 2)";
    EXPECT_EQ(described(glass, pinhole), described(glass, pinhole + R"(, "fov_axis": "x")"));
    EXPECT_EQ(described(glass, parallel), described(glass, parallel + R"(, "size_axis": "x")"));
}

TEST(SceneJson, ReadsNodesCoresAndReferences) {
    Scene scene = parse(with_nodes(R"(
        {"name": "group", "material": "white", "transform": [{"scale": [2, 2, 2]}, {"translate": [0, 0, 1]}], "children": [
            {"name": "a", "geometry": "tile", "transform": [{"rotate": {"axis": [0, 0, 3], "degrees": 90}}]},
            {"name": "b", "geometry": "tile", "visible": false},
            {"name": "c", "geometry": {"type": "mesh", "vertices": [[0,0,0],[1,0,0],[0,1,0]], "polygons": [[0,1,2]]},
             "material": {"type": "lambert", "reflectance": [0, 0.25, 1]},
             "light": {"type": "diffuse_area", "radiance": [1, 2, 3]},
             "transform": [{"matrix": [[1,0,0,5],[0,1,0,0],[0,0,1,0],[0,0,0,1]]}]}]})"));
    EXPECT_EQ(scene.name(), "in");
    EXPECT_EQ(scene.film_width(), 8);
    EXPECT_EQ(scene.film_height(), 4);
    EXPECT_EQ(scene.active_camera(), 0);
    EXPECT_DOUBLE_EQ(scene.cameras().fov[0], std::acos(-1.0) / 3);
    const MeshArrays &meshes = scene.meshes();
    ASSERT_EQ(meshes.name, (std::vector<std::string>{"a", "c"}));
    // Operations apply in the order of the file: scaling, then translation. The child's rotation
    // applies before both.
    EXPECT_LT((meshes.position[1] - Vector3f(0, 2, 1)).norm(), 1e-6f);
    EXPECT_EQ(meshes.position[4], Vector3f(10, 0, 1));
    EXPECT_EQ(scene.materials().name, (std::vector<std::string>{"white", "c"}));
    EXPECT_EQ(scene.materials().component[1].weight, Vector3f(0, 0.25f, 1));
    EXPECT_EQ(scene.lights().radiance[0], Vector3f(1, 2, 3));
    EXPECT_DOUBLE_EQ(scene.lights().area[0], 2);
    scene.set_property("b.visible", "true");
    scene.update(0);
    EXPECT_EQ(meshes.name.size(), 3u);
    expect_consistent(scene.graph());
}

TEST(SceneJson, HashFollowsTheImageNotTheNames) {
    const std::string nodes = R"({"name": "a", "geometry": "tile", "material": "white"})";
    const std::string hash = parse(with_nodes(nodes)).hash();
    EXPECT_EQ(
        parse(with_nodes(
                  R"({"name": "b", "description": "x", "geometry": "tile", "material": "white"})"))
            .hash(),
        hash);
    for (const char *edit : {"a.translation=0,0,1e-6", "eye.fov=61", "eye.translation=1,0,0",
                             "a.visible=false", "a.reflectance=0.5,0.5,0.50001"}) {
        Scene scene = parse(with_nodes(nodes));
        const std::string text = edit;
        scene.set_property(text.substr(0, text.find('=')), text.substr(text.find('=') + 1));
        scene.update(0);
        EXPECT_NE(scene.hash(), hash) << edit;
    }
}

TEST(SceneJson, FarScenesAreMovedToTheOriginInDouble) {
    const char *nodes =
        R"({"name": "world", "transform": [{"translate": [1e6, -1e6, 0]}], "children": [
        {"name": "a", "geometry": "tile", "material": "white"},
        {"name": "view", "transform": [{"translate": [0.1, 0, 2]}], "camera": {"type": "pinhole", "fov": 60, "fov_axis": "x"}}]})";
    std::string text = with_nodes(nodes);
    text.insert(text.find("\"film\""), "\"camera\": \"view\", ");
    const Scene scene = parse(text);
    const Vector3d origin = scene.origin();
    EXPECT_GT(origin.norm(), 1e6);
    EXPECT_EQ(scene.active_camera(), 1);
    const Vector3d camera = scene.cameras().world_from_camera[1].topRightCorner<3, 1>();
    const Vector3d corner = scene.meshes().position[0].cast<double>();
    EXPECT_LT((camera - corner - Vector3d(0.1, 0, 2)).norm(), 1e-7);
    EXPECT_EQ(load_scene(scenes + "/cornell_box/scene.json").origin(), Vector3d(0, 0, 0));
}

struct BadScene {
    std::string nodes;    ///< added to a valid camera, material and geometry
    const char *message;  ///< fragment of the error message
};

const std::string three_vertices = "[[0,0,0],[1,0,0],[0,1,0]]";

std::string mesh_node(const std::string &vertices, const std::string &polygons) {
    return R"({"name": "a", "material": "white", "geometry": {"type": "mesh", "vertices": )" +
           vertices + R"(, "polygons": )" + polygons + "}}";
}

class BadScenes : public testing::TestWithParam<BadScene> {};

TEST_P(BadScenes, AreOneClearError) {
    expect_input_error(GetParam().message, [] { parse(with_nodes(GetParam().nodes)); });
}

INSTANTIATE_TEST_SUITE_P(
    SceneJson, BadScenes,
    testing::Values(
        BadScene{R"({"name": "a", "geometri": "tile"})",
                 "in.json:5: /nodes/1 (in 'a'): unknown key 'geometri'; allowed: animation, "
                 "camera, children, "
                 "description, geometry, import, light, "},
        BadScene{R"({"name": "a", "name": "b"})",
                 "in.json:5: /nodes/1/name (in 'a'): duplicate key 'name'"},
        BadScene{R"({"geometry": "tile"})", "in.json:5: /nodes/1: missing key 'name'"},
        BadScene{R"({"name": ""})", "/nodes/1/name"},
        BadScene{R"({"name": "a.b"})",
                 "in.json:5: /nodes/1/name: 'a.b': a name must not contain a dot"},
        BadScene{R"({"name": "eye"})", "in.json:5: /nodes/1/name: two nodes have the name 'eye'"},
        BadScene{R"({"name": "a", "geometry": "tiles", "material": "white"})",
                 "in.json:5: /nodes/1/geometry: unknown geometry 'tiles'; did you mean 'tile'? the "
                 "scene defines: tile"},
        BadScene{R"({"name": "a", "geometry": "tile", "material": "whit"})",
                 "in.json:5: /nodes/1/material: unknown material 'whit'; did you mean 'white'? the "
                 "scene defines: white"},
        BadScene{R"({"name": "a", "geometry": "tile"})", "mesh 'a' has no material"},
        BadScene{R"({"name": "a", "material": {"type": "phong", "reflectance": [0, 0, 0]}})",
                 "/nodes/1/material/type (in 'a'): \"phong\" is not one of: lambert"},
        BadScene{R"({"name": "a", "material": {"type": "lambert", "reflectance": [0, 0, 1.1]}})",
                 "/nodes/1/material/reflectance/2 (in 'a'): 1.1"},
        BadScene{R"({"name": "a", "material": {"type": "lambert", "reflectance": [0, 0, -0.1]}})",
                 "/nodes/1/material/reflectance/2"},
        BadScene{R"({"name": "a", "material": {"type": "lambert", "reflectance": [0, 0]}})",
                 "/nodes/1/material/reflectance (in 'a')"},
        BadScene{R"({"name": "a", "material": {"type": "lambert"}})", "missing key 'reflectance'"},
        BadScene{R"({"name": "a", "light": {"type": "diffuse_area", "radiance": [1, 1, 1]}})",
                 "light 'a': an area light needs geometry"},
        BadScene{R"({"name": "a", "light": {"type": "diffuse_area", "radiance": [1, 1, 1e39]}})",
                 "/nodes/1/light/radiance: radiance: [1, 1, 1e+39] is not within"},
        BadScene{R"({"name": "a", "light": {"type": "diffuse_area", "radiance": [1, -1, 1]}})",
                 "/nodes/1/light/radiance/1"},
        BadScene{
            R"({"name": "a", "light": {"type": "laser", "radiance": [1, 1, 1]}})",
            "\"laser\" is not one of: diffuse_area, point, spot, directional, dome, environment"},
        BadScene{
            R"({"name": "a", "material": "white", "light": {"type": "diffuse_area", "radiance": [1, 1, 1]},
                     "geometry": {"type": "mesh", "vertices": [[0,0,0],[1,0,0],[2,0,0]], "polygons": [[0,1,2]]}})",
            "light 'a': its mesh has no area"},
        BadScene{mesh_node("[[0,0,0],[1,0,0],[0,null,0]]", "[[0,1,2]]"),
                 "/nodes/1/geometry/vertices/2/1 (in 'a'): null is not of type number"},
        BadScene{mesh_node("[[0,0,0],[1e999,0,0],[0,1,0]]", "[[0,1,2]]"),
                 "/nodes/1/geometry/vertices/1/0 (in 'a'): number overflow"},
        BadScene{mesh_node("[[0,0,0],[NaN,0,0],[0,1,0]]", "[[0,1,2]]"),
                 "/nodes/1/geometry/vertices/1/0 (in 'a'): syntax error"},
        BadScene{mesh_node("[[0,0,0],[1e39,0,0],[0,1,0]]", "[[0,1,2]]"),
                 "mesh 'a': vertex 1, [1e+39, 0, 0], is beyond the range of float"},
        BadScene{
            mesh_node(three_vertices, "[[0,1,3]]"),
            "in.json:5: /nodes/1/geometry/polygons/0: mesh 'a': polygon 0 has vertex index 3, but "
            "there are only "
            "3 vertices"},
        BadScene{mesh_node(three_vertices, "[[0,1,4294967296]]"),
                 "has vertex index 4294967296, but"},
        BadScene{mesh_node(three_vertices, "[[0,1,-1]]"),
                 "/nodes/1/geometry/polygons/0/2 (in 'a'): -1"},
        BadScene{mesh_node(three_vertices, "[[0,1,1.5]]"), "1.5 is not of type integer"},
        BadScene{mesh_node(three_vertices, "[[0,1]]"), "/nodes/1/geometry/polygons/0"},
        BadScene{mesh_node("[]", "[]"), "mesh 'a' has no triangle"},
        BadScene{
            R"({"name": "a", "geometry": {"type": "mesh", "vertices": [[0,0,0],[1,1,0],[1,0,0],[0,2,0]], "polygons": [[0,1,2,3]]}})",
            "mesh 'a': polygon 0 crosses itself"},
        BadScene{R"({"name": "a", "transform": [{"translate": [0, 0, 1]}, {"scale": [1, 0, 1]}]})",
                 "in.json:5: /nodes/1/transform/1: transform: the matrix is not invertible"},
        BadScene{R"({"name": "a", "transform": [{"turn": [1, 0, 1]}]})",
                 "unknown key 'turn'; allowed: look_at, matrix, rotate, scale, translate"},
        BadScene{R"({"name": "a", "transform": [{"scale": [1, 1, 1], "translate": [0, 0, 0]}]})",
                 "/nodes/1/transform/0"},
        BadScene{R"({"name": "a", "transform": [{}]})", "/nodes/1/transform/0"},
        BadScene{R"({"name": "a", "transform": [{"rotate": {"axis": [0, 0, 0], "degrees": 1}}]})",
                 "rotate: the axis has no direction"},
        BadScene{R"({"name": "a", "camera": {"type": "pinhole", "fov": 40, "fov_axis": "x"}})",
                 "the scene has several cameras; select one by \"camera\": eye, a"},
        BadScene{R"({"name": "a", "camera": {"type": "pinhole", "fov": 180, "fov_axis": "x"}})",
                 "/nodes/1/camera/fov"},
        BadScene{
            R"({"name": "a", "camera": {"type": "pinhole", "fov": 40, "fov_axis": "diagonal"}})",
            "\"diagonal\" is not one of: x, y, smaller, larger"},
        BadScene{R"({"name": "a", "children": {"name": "b"}})", "/nodes/1/children (in 'b')"}));

TEST(SceneJson, DocumentsThatAreWrongAsAWhole) {
    const char *film = R"("film": {"width": 4, "height": 4})";
    const auto document = [&](const std::string &rest) {
        return "{" + std::string(film) + rest + "}";
    };
    expect_input_error("missing key 'version'", [&] { parse(document(R"(, "nodes": [])")); });
    expect_input_error("/version: 2 is not one of: 1",
                       [&] { parse(document(R"(, "version": 2, "nodes": [])")); });
    expect_input_error("the scene has no camera",
                       [&] { parse(document(R"(, "version": 1, "nodes": [])")); });
    expect_input_error("unknown key 'shapes'; allowed: camera, description, film, ",
                       [&] { parse(document(R"(, "version": 1, "nodes": [], "shapes": [])")); });
    expect_input_error("/film/width", [&] {
        parse(R"({"version": 1, "film": {"width": 0, "height": 1}, "nodes": []})");
    });
    std::string text = with_nodes(R"({"name": "a"})");
    text.insert(1, R"("camera": "a", )");
    expect_input_error("unknown camera 'a'; cameras are: eye", [&] { parse(text); });
    for (const char *not_a_scene :
         {"", "[]", "null", "7", "\"scene\"", "{}", "\x1f\x8b", "<scene/>"}) {
        expect_input_error("in.json:1", [&] { parse(not_a_scene); });
    }
}

TEST(SceneJson, ASceneMayHaveNoLightAndNoGeometry) {
    const Scene scene = parse(with_nodes(R"({"name": "a"})"));
    EXPECT_TRUE(scene.lights().name.empty());
    EXPECT_TRUE(scene.meshes().triangle.empty());
    EXPECT_FALSE(scene.hash().empty());
}

TEST(SceneJson, NestsAsDeepAsDocumentsMay) {
    const auto nested = [](int levels) {
        std::string open;
        std::string close;
        for (int i = 0; i < levels; ++i) {
            open += "{\"name\": \"n" + std::to_string(i) + "\", \"children\": [";
            close += "]}";
        }
        return with_nodes(open + close);
    };
    EXPECT_NO_THROW(parse(nested(120)));
    expect_input_error("nested deeper than 256 levels", [&] { parse(nested(5000)); });
}

TEST(SceneJson, FilesThatAreNone) {
    expect_input_error("none.json: cannot be read: No such file",
                       [] { load_scene(scenes + "/none.json"); });
    expect_input_error("is a directory", [] { load_scene(scenes); });
    expect_input_error("unknown scene format '.md'; known formats are: .json",
                       [] { load_scene(scenes + "/README.md"); });
}

TEST(SceneJson, TruncatedFilesAreErrors) {
    const std::string text = read_file(scenes + "/cornell_box/scene.json");
    const size_t end = text.find_last_of('}');
    ASSERT_GT(end, 3000u);
    for (size_t size = 0; size <= end; ++size) {
        expect_input_error("in.json:", [&] { parse(text.substr(0, size)); });
    }
    EXPECT_NO_THROW(parse(text.substr(0, end + 1)));
}

TEST(SceneJson, DamagedFilesLoadOrAreErrors) {
    const std::string text = read_file(scenes + "/cornell_box/scene.json");
    std::minstd_rand random(7);
    int refused = 0;
    constexpr int rounds = 1500;
    for (int i = 0; i < rounds; ++i) {
        std::string damaged = text;
        const size_t at = random() % damaged.size();
        switch (random() % 3) {
            case 0:
                damaged[at] = static_cast<char>(random() % 256);
                break;
            case 1:
                damaged.erase(at, 1 + random() % 40);
                break;
            default:
                damaged.insert(at, text.substr(random() % text.size(), random() % 40));
        }
        try {
            const Scene scene = parse(damaged);
            expect_consistent(scene.graph());
        } catch (const Error &error) {  // any other exception fails the test
            ++refused;
            EXPECT_EQ(error.exit_code(), ExitCode::bad_input) << error.what();
        }
    }
    EXPECT_GT(refused, rounds / 4);
    EXPECT_LT(refused, rounds) << "some damage must be a valid edit";
}

TEST(Scenes, CornellBoxIsTheMeasuredOne) {
    const Scene scene = load_scene(scenes + "/cornell_box/scene.json");
    EXPECT_EQ(scene.name(), "cornell_box");
    EXPECT_EQ(scene.film_width(), 256);
    const MeshArrays &meshes = scene.meshes();
    ASSERT_EQ(meshes.triangle.size(), 32u);
    ASSERT_EQ(scene.lights().name, (std::vector<std::string>{"luminaire"}));
    EXPECT_NEAR(scene.lights().area[0], 130.0 * 105.0, 1e-6);
    const Vector3d centre(278, 274, 280);
    for (size_t triangle = 0; triangle < meshes.triangle.size(); ++triangle) {
        const std::string &name = meshes.name[meshes.triangle_mesh[triangle]];
        const Triangle &t = meshes.triangle[triangle];
        const Vector3d middle =
            (meshes.position[t[0]] + meshes.position[t[1]] + meshes.position[t[2]]).cast<double>() /
            3;
        if (name == "luminaire") {
            EXPECT_EQ(front(meshes, triangle), Vector3d(0, -1, 0));
        } else if (name == "small_box" || name == "large_box") {
            const Vector3d inside =
                name == "small_box" ? Vector3d(186, 82, 169) : Vector3d(368, 165, 351);
            EXPECT_GT(front(meshes, triangle).dot(middle - inside), 0) << name << ' ' << triangle;
        } else {
            EXPECT_GT(front(meshes, triangle).dot(centre - middle), 0) << name << ' ' << triangle;
        }
    }
    // The red wall, at +x, is on the left of the image.
    const Eigen::Matrix4d &pose = scene.cameras().world_from_camera[0];
    EXPECT_TRUE(pose.col(0).head<3>().isApprox(Vector3d(-1, 0, 0)));
    EXPECT_TRUE((-pose.col(2).head<3>()).isApprox(Vector3d(0, 0, 1)));
    EXPECT_NEAR(scene.cameras().fov[0] * 180 / std::acos(-1.0), 39.3077, 1e-12);
}

TEST(Scenes, FurnacesAreClosedAndFaceInwards) {
    for (const char *name : {"050", "090"}) {
        const Scene scene = load_scene(scenes + "/analytic/furnace_" + name + ".json");
        const MeshArrays &meshes = scene.meshes();
        ASSERT_EQ(meshes.triangle.size(), 12u);
        double volume = 0;
        for (size_t triangle = 0; triangle < 12; ++triangle) {
            const Triangle &t = meshes.triangle[triangle];
            volume +=
                meshes.position[t[0]].cast<double>().dot(meshes.position[t[1]].cast<double>().cross(
                    meshes.position[t[2]].cast<double>())) /
                6;
            EXPECT_LT(front(meshes, triangle).dot(meshes.position[t[0]].cast<double>()), 0);
        }
        EXPECT_NEAR(volume, -8, 1e-12) << "the surface must be closed, with fronts inwards";
        EXPECT_EQ(scene.lights().mesh.size(), 1u);
    }
}

TEST(Scenes, EmitterFacesTheFloor) {
    const Scene scene = load_scene(scenes + "/analytic/emitter_direct.json");
    EXPECT_EQ(scene.meshes().name, (std::vector<std::string>{"floor", "emitter"}));
    EXPECT_EQ(front(scene.meshes(), 0), Vector3d(0, 1, 0));
    EXPECT_EQ(front(scene.meshes(), 2), Vector3d(0, -1, 0));
    EXPECT_NEAR(scene.lights().area[0], 4, 1e-12);
}

TEST(Triangulate, SplitsPolygonsIntoTheirArea) {
    const auto area = [](const std::vector<Vector3d> &v, const std::vector<Triangle> &triangles) {
        Vector3d sum(0, 0, 0);
        for (const Triangle &t : triangles) {
            sum += 0.5 * (v[t[1]] - v[t[0]]).cross(v[t[2]] - v[t[0]]);
        }
        return sum;
    };
    const std::vector<Vector3d> square = {{0, 0, 5}, {2, 0, 5}, {2, 2, 5}, {0, 2, 5}};
    EXPECT_EQ(triangulate(square, {0, 1, 2, 3}), (std::vector<Triangle>{{0, 1, 2}, {0, 2, 3}}));
    EXPECT_EQ(triangulate(square, {3, 2, 1}), (std::vector<Triangle>{{3, 2, 1}}));
    EXPECT_EQ(area(square, triangulate(square, {3, 2, 1, 0})), Vector3d(0, 0, -4));

    // The polygon is a U in a plane perpendicular to y, seen from +y. Every triangle must keep the
    // orientation.
    std::vector<Vector3d> u = {{0, 1, 0}, {0, 1, 3}, {3, 1, 3}, {3, 1, 0},
                               {2, 1, 0}, {2, 1, 2}, {1, 1, 2}, {1, 1, 0}};
    const std::vector<Triangle> parts = triangulate(u, {0, 1, 2, 3, 4, 5, 6, 7});
    ASSERT_EQ(parts.size(), 6u);
    EXPECT_TRUE(area(u, parts).isApprox(Vector3d(0, 7, 0)));
    for (const Triangle &t : parts) {
        EXPECT_GE(area(u, {t}).y(), 0);
    }
    // Scale and position must not matter.
    for (Vector3d &vertex : u) {
        vertex = vertex * 1e-150 + Vector3d(0, 0, 0);
    }
    EXPECT_EQ(triangulate(u, {0, 1, 2, 3, 4, 5, 6, 7}), parts);

    const std::vector<Vector3d> line = {{0, 0, 0}, {1, 0, 0}, {2, 0, 0}, {3, 0, 0}};
    EXPECT_EQ(triangulate(line, {0, 1, 2, 3}).size(), 2u) << "a polygon without area is valid";
    const std::vector<Vector3d> star = {{0, 3, 0}, {2, -3, 0}, {-3, 1, 0}, {3, 1, 0}, {-2, -3, 0}};
    expect_input_error("crosses itself", [&] { triangulate(star, {0, 1, 2, 3, 4}); });
    expect_input_error("has 2 corners", [&] { triangulate(square, {0, 1}); });
    expect_input_error("has vertex index 4, but there are only 4", [&] {
        triangulate(square, {0, 1, 4});
    });
}

}  // namespace
}  // namespace rtrays
