// SPDX-License-Identifier: MIT
// Tests the scene model: the serialization of shapes, textures, lights, cameras and meshes of
// scene files.
#include <Eigen/Geometry>
#include <cmath>
#include <filesystem>
#include <fstream>

#include "renderer/base/angles.h"
#include "renderer/base/image.h"
#include "renderer/testing/parsed_scene.h"

namespace rtrays {
namespace {

using Eigen::Vector2d;
using Eigen::Vector2f;
using Eigen::Vector3d;
using Eigen::Vector3f;

/// Each case has a canonical point of a shape and its position under parameters and a transform.
TEST(Shapes, ParametersBecomePartOfTheTransform) {
    struct Case {
        const char *geometry;
        ShapeArrays::Kind kind;
        Vector3d canonical;
        Vector3d world;  ///< after scaling by 2 and translation by 10 along x
    };
    using Shape = ShapeArrays::Kind;
    for (
        const Case &c : {
            Case{R"({"type": "sphere", "radius": 3})", Shape::sphere, {1, 0, 0}, {16, 0, 0}},
            Case{R"({"type": "ellipsoid", "radii": [1, 2, 3]})",
                 Shape::sphere,
                 {0, 0, 1},
                 {10, 0, 6}},
            Case{R"({"type": "cylinder", "radius": 2, "height": 5})",
                 Shape::cylinder,
                 {1, 0, 1},
                 {14, 0, 10}},
            Case{R"({"type": "cone", "radius": 2, "height": 5})",
                 Shape::cone,
                 {0, 1, 0},
                 {10, 4, 0}},
            Case{R"({"type": "paraboloid", "radius": 2, "height": 5})",
                 Shape::paraboloid,
                 {1, 0, 1},
                 {14, 0, 10}},
            Case{R"({"type": "hyperboloid", "radius": 2, "height": 5, "flare": 3})",
                 Shape::hyperboloid,
                 {2, 0, -1},
                 {18, 0, -5}},
            Case{R"({"type": "disc", "radius": 2})", Shape::disc, {0, 1, 0}, {10, 4, 0}},
            Case{R"({"type": "plane"})", Shape::plane, {5, 0, 0}, {20, 0, 0}},
            Case{
                R"({"type": "julia", "constant": [-0.2, 0.8, 0, 0], "slice": 0.25, "iterations": 12})",
                Shape::julia,
                {1, 1, 1},
                {12, 2, 2}},
        }) {
        SCOPED_TRACE(c.geometry);
        const Scene scene = parse(
            R"({"name": "a", "material": {"type": "lambert", "reflectance": [0, 0, 0]},
                "transform": [{"scale": [2, 2, 2]}, {"translate": [10, 0, 0]}], "geometry": )" +
            std::string(c.geometry) + "}");
        const ShapeArrays &shapes = scene.arrays().shapes;
        ASSERT_EQ(shapes.kind, std::vector<Shape>{c.kind});
        EXPECT_EQ((shapes.world_from_object[0] * c.canonical.homogeneous()).head<3>(), c.world);
        EXPECT_EQ(shapes.flare[0], c.kind == Shape::hyperboloid ? 3 : 0);
        EXPECT_EQ(shapes.julia_iterations[0], c.kind == Shape::julia ? 12u : 0u);
        EXPECT_EQ(shapes.julia_slice[0], c.kind == Shape::julia ? 0.25 : 0);
        EXPECT_EQ(shapes.julia_constant[0][1], c.kind == Shape::julia ? 0.8 : 0);
    }
}

TEST(Shapes, FarScenesOfShapesAreMovedToTheOriginToo) {
    std::string text =
        R"({"version": 1, "film": {"width": 8, "height": 4}, "nodes": [{"name": "world",
        "transform": [{"translate": [1e7, 0, 0]}], "material": {"type": "lambert", "reflectance": [0, 0, 0]}, "children": [
        {"name": "eye", "transform": [{"translate": [0, 0, 5]}], "camera": {"type": "pinhole", "fov": 60, "fov_axis": "x"}},
        {"name": "ball", "geometry": {"type": "sphere"}},
        {"name": "lamp", "transform": [{"translate": [0, 2, 0]}], "light": {"type": "point", "intensity": [1, 1, 1]}},
        {"name": "floor", "geometry": {"type": "plane"}}]}]})";
    const Scene scene = parse_scene_json(text, "in.json", "in");
    EXPECT_EQ(scene.origin(), Vector3d(1e7, 0, 0));
    EXPECT_EQ(scene.arrays().shapes.world_from_object[0].col(3).head<3>(), Vector3d(0, 0, 0));
    EXPECT_EQ(scene.lights().world_from_light[0].col(3).head<3>(), Vector3d(0, 2, 0));
    EXPECT_EQ(scene.cameras().world_from_camera[0].col(3).head<3>(), Vector3d(0, 0, 5));
}

TEST(Meshes, BoxAndRectangleFaceOutAndCarryCoordinates) {
    const Scene scene = parse(
        R"({"name": "room", "material": {"type": "lambert", "reflectance": [0, 0, 0]}, "children": [
            {"name": "box", "geometry": {"type": "box"}}, {"name": "sheet", "geometry": {"type": "rectangle"}}]})");
    const MeshArrays &meshes = scene.meshes();
    ASSERT_EQ(meshes.triangle.size(), 14u);
    for (size_t i = 0; i < meshes.triangle.size(); ++i) {
        const Triangle &t = meshes.triangle[i];
        const Vector3f e1 = meshes.position[t[1]] - meshes.position[t[0]];
        const Vector3f e2 = meshes.position[t[2]] - meshes.position[t[0]];
        const Vector3f normal = e1.cross(e2).normalized();
        const Vector3f middle =
            (meshes.position[t[0]] + meshes.position[t[1]] + meshes.position[t[2]]) / 3;
        EXPECT_EQ(normal.dot(i < 12 ? middle : Vector3f(0, 0, 1)), 1) << i;
        // Seen from the front, (u, v) is a right-handed frame of half the size.
        const Vector2f u1 = meshes.uv[t[1]] - meshes.uv[t[0]];
        const Vector2f u2 = meshes.uv[t[2]] - meshes.uv[t[0]];
        EXPECT_EQ(u1.x() * u2.y() - u1.y() * u2.x(), 1) << i;
        EXPECT_EQ(4 * u1.dot(u2), e1.dot(e2)) << i;
    }
    EXPECT_TRUE(meshes.normal.empty());
}

TEST(Meshes, NormalsFollowTheSurface) {
    // The triangle is on the plane x + y = 1 and has the plane's normal. Under every transform, the
    // normal must remain perpendicular to the plane and on its front.
    const char *mesh =
        R"({"type": "mesh", "vertices": [[1, 0, 0], [0, 1, 0], [0, 1, 1]], "polygons": [[0, 1, 2]],
                           "normals": [[3, 3, 0], [1, 1, 0], [1e-200, 1e-200, 0]]})";
    for (const char *transform :
         {R"({"scale": [1, 1, 1]})", R"({"scale": [3, 1, 0.5]})", R"({"scale": [-1, 1, 1]})",
          R"({"scale": [1, 1e-18, 1]})", R"({"scale": [1, -2, -1]})",
          R"({"scale": [-1e-9, -1e9, -1]})",
          R"({"matrix": [[1, 2, 0, 0], [0, 1, 0.5, 0], [0.25, 0, -1, 0], [0, 0, 0, 1]]})"}) {
        SCOPED_TRACE(transform);
        const Scene scene = parse(
            std::string(R"({"name": "a", "material": {"type": "lambert", "reflectance": [0, 0, 0]},
            "geometry": )") +
            mesh + R"(, "transform": [)" + transform + "]}");
        const MeshArrays &meshes = scene.meshes();
        const Triangle &t = meshes.triangle[0];
        const Vector3d p0 = meshes.position[t[0]].cast<double>();
        const Vector3d front = (meshes.position[t[1]].cast<double>() - p0)
                                   .cross(meshes.position[t[2]].cast<double>() - p0)
                                   .stableNormalized();
        for (const Vector3f &normal : meshes.normal) {
            EXPECT_LT((normal.cast<double>() - front).norm(), 1e-6)
                << normal.transpose() << " / " << front.transpose();
        }
    }
}

TEST(Meshes, NormalsAndCoordinatesComeAndGoWithTheirMeshes) {
    SceneGraph graph;
    graph.root().set_core(grey("grey"));
    Node &plain = add_node(graph.root(), "plain");
    Node &other = add_node(graph.root(), "other");
    plain.set_core(right_triangle());
    graph.update(0);
    EXPECT_TRUE(graph.arrays().meshes.normal.empty());
    const MeshCore::Geometry bare{{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}, {{0, 1, 2}}};
    MeshCore::Geometry rich = bare;
    rich.normals.assign(3, Vector3d(0, 0, 2));
    rich.uvs = {{0, 0}, {1, 0}, {0, 1}};
    rich.colours = {{1, 0, 0}, {0, 1, 0}, {0, 0, 0.5}};
    const auto mesh = std::make_shared<MeshCore>("rich", rich);
    other.set_core(mesh);
    graph.update(0);
    expect_consistent(graph);
    EXPECT_EQ(graph.arrays().meshes.uv[4], Vector2f(1, 0));
    EXPECT_EQ(graph.arrays().meshes.colour[4], Rgb(0, 1, 0));
    EXPECT_EQ(graph.arrays().meshes.colour[2], Rgb(1, 1, 1));
    EXPECT_EQ(graph.arrays().meshes.normal[2], Vector3f(0, 0, 0));
    EXPECT_EQ(graph.arrays().meshes.normal[3], Vector3f(0, 0, 1));
    plain.set_core(std::make_shared<VisibilityCore>("", false));
    graph.update(0);
    expect_consistent(graph);
    EXPECT_EQ(graph.arrays().meshes.uv[1], Vector2f(1, 0));
    EXPECT_EQ(graph.arrays().meshes.colour[2], Rgb(0, 0, 0.5f));
    mesh->set_geometry(bare);
    graph.update(0);
    expect_consistent(graph);
    EXPECT_TRUE(graph.arrays().meshes.uv.empty());
    EXPECT_TRUE(graph.arrays().meshes.colour.empty());
}

TEST(Lights, StandWhereTheirNodesAre) {
    const Scene scene = parse(R"(
        {"name": "lamps", "transform": [{"rotate": {"axis": [0, 1, 0], "degrees": 90}}, {"translate": [1, 2, 3]}], "children": [
            {"name": "point", "light": {"type": "point", "intensity": [1, 2, 3]}, "transform": [{"scale": [1, -2, 3]}]},
            {"name": "spot", "light": {"type": "spot", "intensity": [4, 5, 6], "inner_degrees": 10, "outer_degrees": 30}},
            {"name": "sun", "light": {"type": "directional", "irradiance": [7, 8, 9]}, "transform": [{"scale": [1, 2, 3]}]},
            {"name": "sky", "light": {"type": "dome", "radiance": [0.5, 0.5, 0.5]}}]})");
    const LightArrays &lights = scene.lights();
    using Light = LightArrays::Kind;
    ASSERT_EQ(lights.kind,
              (std::vector<Light>{Light::point, Light::spot, Light::directional, Light::dome}));
    EXPECT_EQ(lights.radiance[0], Vector3f(1, 2, 3));
    EXPECT_EQ(lights.radiance[2], Vector3f(7, 8, 9));
    EXPECT_EQ(lights.world_from_light[0].col(3).head<3>(), Vector3d(1, 2, 3));
    EXPECT_EQ(lights.world_from_light[1].col(3).head<3>(), Vector3d(1, 2, 3));
    for (const int i : {1, 2}) {  // -z rotated by 90 degrees about y
        EXPECT_LT((-lights.world_from_light[i].col(2).head<3>() - Vector3d(-1, 0, 0)).norm(),
                  1e-15);
        const Eigen::Matrix3d axes = lights.world_from_light[i].topLeftCorner<3, 3>();
        EXPECT_TRUE((axes.transpose() * axes).isIdentity(1e-14));
        EXPECT_NEAR(axes.determinant(), 1, 1e-14);
    }
    EXPECT_DOUBLE_EQ(lights.inner_angle[1], pi / 18);
    EXPECT_DOUBLE_EQ(lights.outer_angle[1], pi / 6);
    EXPECT_TRUE(scene.meshes().light.empty());
}

TEST(Lights, AreasOfShapes) {
    Scene scene = parse(R"(
        {"name": "lamps", "material": {"type": "lambert", "reflectance": [0, 0, 0]},
         "transform": [{"scale": [2, 2, -2]}, {"rotate": {"axis": [1, 2, 3], "degrees": 40}}], "children": [
            {"name": "ball", "geometry": {"type": "sphere", "radius": 3}, "light": {"type": "diffuse_area", "radiance": [1, 1, 1]}},
            {"name": "disc", "geometry": {"type": "disc", "radius": 0.5}, "light": {"type": "diffuse_area", "radiance": [1, 1, 1]},
             "transform": [{"scale": [1, 3, 7]}]},
            {"name": "dark", "geometry": {"type": "sphere"}},
            {"name": "near", "geometry": {"type": "disc"}, "light": {"type": "point", "intensity": [1, 1, 1]}}]})");
    EXPECT_NEAR(scene.lights().area[0], 4 * pi * 36, 1e-11);
    EXPECT_NEAR(scene.lights().area[1], pi * 1 * 3, 1e-12);
    EXPECT_EQ(scene.lights().shape, (std::vector<uint32_t>{0, 1, no_index}));
    EXPECT_EQ(scene.arrays().shapes.light, (std::vector<uint32_t>{0, 1, no_index, no_index}));
    scene.set_property("ball.visible", "false");
    scene.update(0);
    expect_consistent(scene.graph());
    EXPECT_EQ(scene.arrays().shapes.light, (std::vector<uint32_t>{0, no_index, no_index}));
}

TEST(Lights, EmissiveMaterialsMakeLightsOfGeometry) {
    Scene scene = parse(
        R"(
        {"name": "lamps", "material": "glow", "children": [
            {"name": "sheet", "geometry": {"type": "rectangle"}}, {"name": "ball", "geometry": {"type": "sphere"}},
            {"name": "dark", "geometry": {"type": "plane"}, "material": {"type": "lambert", "reflectance": [0, 0, 0]}}]})",
        R"("materials": {"glow": {"type": "lambert", "reflectance": [0.5, 0.5, 0.5], "emission": [3, 2, 1]}},)");
    EXPECT_EQ(scene.lights().name, (std::vector<std::string>{"sheet", "ball"}));
    EXPECT_EQ(scene.lights().radiance[1], Vector3f(3, 2, 1));
    EXPECT_EQ(scene.lights().area[0], 4);
    scene.set_property("materials.glow.emission", "0,0,1");
    scene.update(0);
    expect_consistent(scene.graph());
    EXPECT_EQ(scene.lights().radiance[0], Vector3f(0, 0, 1));
    scene.set_property("materials.glow.emission", "0,0,0");
    scene.update(0);
    expect_consistent(scene.graph());
    EXPECT_TRUE(scene.lights().name.empty());
    scene.set_property("materials.glow.emission", "0,4,0");
    scene.update(0);
    expect_consistent(scene.graph());
    EXPECT_EQ(scene.lights().name.size(), 2u);
}

TEST(Cameras, ThinLensesGrowWithTheirNodes) {
    Scene scene = parse_scene_json(
        R"({"version": 1, "film": {"width": 8, "height": 4}, "nodes": [{"name": "eye",
        "transform": [{"scale": [2, 2, 2]}], "camera": {"type": "thin_lens", "fov": 60, "fov_axis": "y",
        "aperture_radius": 0.25, "focus_distance": 5}}]})",
        "in.json", "in");
    EXPECT_EQ(scene.cameras().aperture_radius[0], 0.5);
    EXPECT_EQ(scene.cameras().focus_distance[0], 10);
    const std::string hash = scene.hash();
    scene.set_property("eye.aperture_radius", "0.125");
    scene.update(0);
    EXPECT_EQ(scene.cameras().aperture_radius[0], 0.25);
    EXPECT_NE(scene.hash(), hash);
}

class Textures : public WithImages {};

void write_text(const std::string &name, const std::string &content) {
    std::ofstream(testing::TempDir() + name, std::ios::binary) << content;
}

TEST(Cameras, OrthographicViewsGrowWithTheirNodes) {
    const auto scene = [](const char *size) {
        return parse(std::string(R"({"name": "plan", "transform": [{"scale": [2, 2, 2]}],
            "camera": {"type": "orthographic", "size_axis": "y", "size": )") +
                         size + "}}",
                     R"("camera": "eye", )");
    };
    Scene plan = scene("3");
    EXPECT_EQ(plan.cameras().view_size, (std::vector<double>{0, 6}));
    EXPECT_FALSE(plan.cameras().is_orthographic(0));
    plan.set_active_camera("plan");
    const std::string hash = plan.hash();
    plan.set_property("plan.size", "4");
    plan.update(0);
    EXPECT_EQ(plan.cameras().view_size[1], 8);
    EXPECT_NE(plan.hash(), hash);
}

TEST(Films, MayBeCropped) {
    const auto film = [](const std::string &crop) {
        return parse_scene_json(
            R"({"version": 1, "film": {"width": 8, "height": 4, "crop": )" + crop +
                R"(}, "nodes": [{"name": "eye", "camera": {"type": "pinhole", "fov": 60, "fov_axis": "x"}}]})",
            "in.json", "in");
    };
    Scene scene = film(R"({"x": 2, "y": 1, "width": 6, "height": 3})");
    ASSERT_TRUE(scene.crop());
    EXPECT_EQ(scene.crop()->x, 2);
    EXPECT_EQ(scene.crop()->height, 3);
    EXPECT_THROW(film(R"({"x": 3, "y": 1, "width": 6, "height": 3})"), Error);
    EXPECT_THROW(film(R"({"x": 2, "y": 2, "width": 6, "height": 3})"), Error);
    scene.set_film_size(8, 4);
    EXPECT_FALSE(scene.crop());
}

TEST_F(Textures, AreSharedByMaterialsAndFilesByTextures) {
    write_text("two.ppm", std::string("P6 2 1 255\n") + "\x10\x20\x30\x40\x50\x60");
    Scene scene = parse(
        R"({"name": "a", "geometry": {"type": "sphere"}, "material": "one"},
           {"name": "b", "geometry": {"type": "sphere"}, "material": "two"},
           {"name": "c", "geometry": {"type": "sphere"}, "material": {"type": "mirror", "reflectance": [1, 1, 1],
            "reflectance_texture": {"file": "two.ppm", "encoding": "srgb", "filter": "nearest", "wrap": "clamp"}}})",
        R"("textures": {"wood": {"file": "two.ppm", "encoding": "srgb", "uv_scale": [2, 3], "uv_offset": [0.5, -1]}},
           "materials": {"one": {"type": "lambert", "reflectance": [1, 1, 1], "reflectance_texture": "wood"},
                         "two": {"type": "composite", "components": [
                             {"bxdf": "lambert", "weight": [0.5, 0.5, 0.5]},
                             {"bxdf": "lambert", "weight": [0.5, 0.5, 0.5], "weight_texture": "wood"}]}},)");
    const TextureArrays &textures = scene.arrays().textures;
    ASSERT_EQ(textures.name, (std::vector<std::string>{"wood", "c.reflectance_texture"}));
    EXPECT_EQ(textures.image[0], textures.image[1]) << "the image of a file must be shared";
    EXPECT_EQ(textures.image[0]->bytes, (std::vector<uint8_t>{0x10, 0x20, 0x30, 0x40, 0x50, 0x60}));
    EXPECT_EQ(textures.image[0]->width, 2);
    EXPECT_TRUE(textures.image[0]->srgb);
    EXPECT_EQ(textures.uv_scale[0], Vector2d(2, 3));
    EXPECT_EQ(textures.uv_offset[0], Vector2d(0.5, -1));
    EXPECT_EQ(textures.wrap[1], TextureArrays::Wrap::clamp);
    EXPECT_EQ(textures.filter[1], TextureArrays::Filter::nearest);
    std::vector<uint32_t> used;
    for (const BxdfComponent &component : scene.materials().component) {
        used.push_back(component.texture);
    }
    EXPECT_EQ(used, (std::vector<uint32_t>{0, no_index, 0, 1}));

    const std::string hash = scene.hash();
    scene.set_property("textures.wood.filter", "nearest");
    scene.set_property("textures.wood.uv_scale", "4");
    scene.update(0);
    EXPECT_EQ(textures.filter[0], TextureArrays::Filter::nearest);
    EXPECT_EQ(textures.uv_scale[0], Vector2d(4, 4));
    EXPECT_NE(scene.hash(), hash);

    // A texture disappears with the last material that uses it.
    scene.graph().find("c")->set_core(grey("plain"));
    scene.update(0);
    expect_consistent(scene.graph());
    EXPECT_EQ(textures.name, (std::vector<std::string>{"wood"}));
}

TEST_F(Textures, OfOpacitiesAreKeptWhileTheyAreUsed) {
    write_text("two.ppm", std::string("P6 2 1 255\n") + "\x10\x20\x30\x40\x50\x60");
    Scene scene = parse(
        R"({"name": "a", "geometry": {"type": "sphere"}, "material": {"type": "lambert", "reflectance": [1, 1, 1],
            "reflectance_texture": {"file": "two.ppm", "encoding": "srgb"}}},
           {"name": "b", "geometry": {"type": "sphere"}, "material": {"type": "lambert", "reflectance": [1, 1, 1],
            "opacity_texture": {"file": "two.ppm", "encoding": "linear"}}})");
    const std::vector<MaterialOpacity> &opacities = scene.materials().opacity;
    EXPECT_EQ(opacities[0].texture, no_index);
    EXPECT_EQ(opacities[1].texture, 1u);
    EXPECT_FALSE(opacities[1].is_opaque());
    scene.graph().find("a")->set_core(grey("plain"));
    scene.update(0);
    expect_consistent(scene.graph());
    EXPECT_EQ(scene.arrays().textures.name, (std::vector<std::string>{"b.opacity_texture"}));
    EXPECT_EQ(opacities[1].texture + opacities[0].texture, 0u + no_index) << "one has texture 0";
}

TEST_F(Textures, OfNormalMapsAreKeptWhileTheyAreUsed) {
    write_text("two.ppm", std::string("P6 2 1 255\n") + "\x10\x20\x30\x40\x50\x60");
    const char *plain =
        R"({"name": "a", "geometry": {"type": "rectangle"}, "material": {"type": "lambert", "reflectance": [1, 1, 1],
            "reflectance_texture": {"file": "two.ppm", "encoding": "srgb"}}})";
    const std::string hash = parse(plain).hash();
    Scene scene =
        parse(std::string(plain) +
              R"(, {"name": "b", "geometry": {"type": "rectangle"}, "material": {"type": "mirror",
            "reflectance": [1, 1, 1], "normal_map": 0.5, "map_follows_v": true, "map_shadowing": false,
            "normal_map_texture": {"file": "two.ppm", "encoding": "linear"}}},
           {"name": "c", "geometry": {"type": "rectangle"}, "material": {"type": "mirror",
            "reflectance": [1, 1, 1], "bump_map": -2, "map_mirrored_back": true,
            "bump_map_texture": {"file": "two.ppm", "encoding": "linear"}}})");
    const std::vector<NormalMap> &maps = scene.materials().normal_map;
    ASSERT_EQ(maps.size(), 3u);
    EXPECT_TRUE(maps[0] == NormalMap());
    EXPECT_TRUE(maps[1] == (NormalMap{NormalMap::Kind::normals, 1, 0.5, false, true, false}));
    EXPECT_TRUE(maps[2] == (NormalMap{NormalMap::Kind::heights, 2, -2, true, false, true}));
    const std::string mapped_hash = scene.hash();
    EXPECT_NE(mapped_hash, hash);
    scene.set_property("c.bump_map", "3");
    scene.update(0);
    EXPECT_EQ(maps[2].scale, 3);
    EXPECT_NE(scene.hash(), mapped_hash);
    scene.graph().find("a")->set_core(grey("plain"));
    scene.update(0);
    expect_consistent(scene.graph());
    EXPECT_EQ(scene.arrays().textures.name.size(), 2u);
}

TEST_F(Textures, EnvironmentsAreImagesOfFloats) {
    Image image = Image::rgb(2, 1);
    image.channel("R") = {1, 2};
    image.channel("G") = {3, 4};
    image.channel("B") = {5, 60000};
    write_exr(image, testing::TempDir() + "sky.exr");
    const char *node =
        R"({"name": "sky", "transform": [{"rotate": {"axis": [0, 1, 0], "degrees": 90}}, {"scale": [2, 2, 2]}],
                           "light": {"type": "environment", "file": "sky.exr", "scale": 0.5}})";
    Scene scene = parse(node);
    ASSERT_EQ(scene.lights().image.size(), 1u);
    EXPECT_EQ(scene.lights().image[0]->floats, (std::vector<float>{1, 3, 5, 2, 4, 60000}));
    EXPECT_EQ(scene.lights().radiance[0], Vector3f(0.5f, 0.5f, 0.5f));
    EXPECT_TRUE(scene.lights().world_from_light[0].isApprox(rotation({0, 1, 0}, pi / 2), 1e-15));
    const std::string hash = scene.hash();
    image.channel("B")[1] = 60032;
    write_exr(image, testing::TempDir() + "sky.exr");
    EXPECT_NE(parse(node).hash(), hash) << "the hash must depend on the image";
}

}  // namespace
}  // namespace rtrays
