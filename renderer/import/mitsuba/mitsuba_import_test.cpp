// SPDX-License-Identifier: MIT
// Tests the import of each element of a Mitsuba scene. Expected values are from Mitsuba's
// documentation and, if it does not specify them, from Mitsuba 3.9 itself.
#include <Eigen/Geometry>
#include <cmath>
#include <fstream>

#include "renderer/base/angles.h"
#include "renderer/base/files.h"
#include "renderer/import/images/texture_file.h"
#include "renderer/import/load_scene.h"
#include "renderer/import/mitsuba/plastic.h"
#include "renderer/scene/cores/transform.h"
#include "renderer/testing/mitsuba_scenes.h"

namespace rtrays {
namespace {

using Eigen::Matrix4d;
using Eigen::Vector2d;
using Eigen::Vector3d;
using Eigen::Vector3f;
using Kind = BxdfComponent::Kind;
using Fresnel = BxdfComponent::Fresnel;

/// Returns the unit normal of the front of a triangle.
Vector3d front(const MeshArrays &meshes, size_t triangle) {
    const Triangle &t = meshes.triangle[triangle];
    const Vector3d a = meshes.position[t[0]].cast<double>();
    return (meshes.position[t[1]].cast<double>() - a)
        .cross(meshes.position[t[2]].cast<double>() - a)
        .normalized();
}

/// Returns the position to which `operations` move a point light.
Vector3d moved_by(const std::string &operations) {
    const Scene scene = parse_elements(R"(<emitter type="point"><transform name="to_world">)" +
                                       operations + "</transform></emitter>");
    return scene.lights().world_from_light[0].topRightCorner<3, 1>();
}

/// Returns the components of a BSDF that a rectangle has.
std::vector<BxdfComponent> components_of(const std::string &bsdf) {
    return parse_elements(R"(<shape type="rectangle">)" + bsdf + "</shape>").materials().component;
}

bool two_sided(const std::string &bsdf) {
    return parse_elements(R"(<shape type="rectangle">)" + bsdf + "</shape>")
               .materials()
               .two_sided[0] != 0;
}

void expect_near(const Vector3d &a, const Vector3d &b, double tolerance = 1e-12) {
    EXPECT_LT((a - b).norm(), tolerance) << a.transpose() << "\n" << b.transpose();
}

TEST(MitsubaTransforms, ApplyInTheOrderWritten) {
    expect_near(moved_by(R"(<translate x="1" y="2"/><scale value="2"/>)"), {2, 4, 0});
    expect_near(moved_by(R"(<scale value="2"/><translate value="1, 2, 3"/>)"), {1, 2, 3});
    expect_near(moved_by(R"(<translate x="1"/><rotate z="1" angle="90"/>)"), {0, 1, 0});
    expect_near(moved_by(R"(<translate value="1 1 1"/><scale x="2" z="3"/>)"), {2, 1, 3});
    expect_near(
        moved_by(R"(<translate x="1"/><matrix value="0 0 1 5  1 0 0 6  0 1 0 7  0 0 0 1"/>)"),
        {5, 7, 7});
    expect_near(moved_by(R"(<translate y="1"/><matrix value="0 1 0 1 0 0 0 0 1"/>)"), {1, 0, 0});
    // The object's +z axis points to the target, so one unit along it is one unit nearer.
    expect_near(moved_by(R"(<translate z="1"/><lookat origin="0,0,5" target="0,0,0" up="0,1,0"/>)"),
                {0, 0, 4});
    expect_near(moved_by(R"(<translate x="1"/><lookat origin="0,0,5" target="0,0,0" up="0,1,0"/>)"),
                {-1, 0, 5});
}

TEST(MitsubaDocument, SubstitutesParametersAndIncludesFiles) {
    std::ofstream(testing::TempDir() + "part.xml")
        << R"(<scene version="3.0.0"><default name="b" value="7"/><emitter type="point" id="$name">
            <point name="position" x="$a" y="$b" z="$ab"/></emitter></scene>)";
    // The first value of a name is used, and `$` matches the longest known name.
    const Scene scene = parse_elements(R"(<default name="a" value="2"/><default name="a" value="9"/>
        <default name="ab" value="$a5"/><default name="name" value="lamp$a"/><include filename="part.xml"/>)");
    EXPECT_EQ(scene.lights().name[0], "lamp2");
    expect_near(scene.lights().world_from_light[0].topRightCorner<3, 1>(), {2, 7, 25});
}

TEST(MitsubaCameras, LookAlongZWithXToTheLeft) {
    const Scene scene = parse_mitsuba(R"(<scene version="3.0.0"><sensor type="perspective">
        <transform name="to_world"><lookat origin="1,2,3" target="1,2,0" up="0,1,0"/></transform></sensor></scene>)");
    const Matrix4d &world = scene.cameras().world_from_camera[0];
    // RTRays' camera looks along -z and has +x to the right.
    EXPECT_TRUE(world.isApprox(translation({1, 2, 3}), 1e-15)) << world;
    EXPECT_EQ(scene.film_width(), 768);
    EXPECT_EQ(scene.film_height(), 576);
    // 50 mm on the diagonal of 36 x 24 mm is 38.1848 degrees along x for 4:3, as Mitsuba prints it.
    EXPECT_NEAR(scene.cameras().fov[0] / degree, 38.1848, 5e-5);
    EXPECT_EQ(scene.cameras().fov_axis[0], CameraArrays::FovAxis::x);
    EXPECT_EQ(scene.cameras().aperture_radius[0], 0);
}

TEST(MitsubaCameras, HaveAnglesAlongEveryAxisAndALens) {
    const auto camera = [](const std::string &type, const std::string &properties) {
        return parse_mitsuba(R"(<scene version="3.0.0"><sensor type=")" + type +
                             R"("><film type="hdrfilm">
            <integer name="width" value="64"/><integer name="height" value="48"/></film>)" +
                             properties + "</sensor></scene>");
    };
    const auto fov = [&](const std::string &axis) {
        return camera(
            "perspective",
            R"(<float name="fov" value="40"/><string name="fov_axis" value=")" + axis + R"("/>)");
    };
    EXPECT_EQ(fov("x").cameras().fov_axis[0], CameraArrays::FovAxis::x);
    EXPECT_EQ(fov("y").cameras().fov_axis[0], CameraArrays::FovAxis::y);
    EXPECT_EQ(fov("smaller").cameras().fov_axis[0], CameraArrays::FovAxis::smaller);
    EXPECT_EQ(fov("larger").cameras().fov_axis[0], CameraArrays::FovAxis::larger);
    EXPECT_NEAR(fov("larger").cameras().fov[0], 40 * degree, 1e-15);
    EXPECT_NEAR(fov("diagonal").cameras().fov[0] / degree, 32.468605, 1e-6);  // Mitsuba's x_fov
    EXPECT_EQ(fov("diagonal").cameras().fov_axis[0], CameraArrays::FovAxis::x);
    const Scene lens = camera(
        "thinlens", R"(<float name="fov" value="40"/><float name="aperture_radius" value="0.5"/>
        <float name="focus_distance" value="7"/>)");
    EXPECT_EQ(lens.cameras().aperture_radius[0], 0.5);
    EXPECT_EQ(lens.cameras().focus_distance[0], 7);
}

TEST(MitsubaShapes, RectanglesAndCubesAreMeshes) {
    const Scene scene = parse_elements(R"(<shape type="rectangle" id="tile.1"/>
        <shape type="cube" id="tile_1"><transform name="to_world"><translate x="5"/></transform></shape>
        <shape type="rectangle"><boolean name="flip_normals" value="true"/></shape>
        <shape type="rectangle"><transform name="to_world"><scale x="-1"/></transform></shape>)");
    const MeshArrays &meshes = scene.meshes();
    EXPECT_EQ(meshes.name, (std::vector<std::string>{"tile_1", "tile_1_2", "shape", "shape_2"}));
    expect_near(front(meshes, 0), {0, 0, 1});
    EXPECT_EQ(meshes.position[0], Vector3f(-1, -1, 0));
    EXPECT_EQ(meshes.uv[2], Eigen::Vector2f(1, 1));
    ASSERT_EQ(meshes.triangle_count[1], 12u);
    for (uint32_t i = meshes.first_triangle[1]; i < meshes.first_triangle[2]; ++i) {
        const Vector3d centre =
            (meshes.position[meshes.triangle[i][0]] + meshes.position[meshes.triangle[i][2]])
                    .cast<double>() /
                2 -
            Vector3d(5, 0, 0);
        EXPECT_NEAR(front(meshes, i).dot(centre), 1, 1e-12) << i;  // every side faces outwards
    }
    expect_near(front(meshes, meshes.first_triangle[2]), {0, 0, -1});
    // A reflection does not move the front to the other side.
    expect_near(front(meshes, meshes.first_triangle[3]), {0, 0, 1});
    expect_consistent(scene.graph());
}

TEST(MitsubaShapes, RoundOnesAreShapes) {
    const Scene scene = parse_elements(R"(
        <shape type="sphere"><point name="center" x="1" y="2" z="3"/><float name="radius" value="0.5"/>
            <transform name="to_world"><scale value="2"/><translate x="10"/></transform></shape>
        <shape type="disk"><boolean name="flip_normals" value="true"/></shape>
        <shape type="cylinder"><point name="p0" x="1" y="0" z="0"/><point name="p1" value="1,3,1"/>
            <float name="radius" value="0.5"/></shape>)");
    const ShapeArrays &shapes = scene.arrays().shapes;
    ASSERT_EQ(shapes.kind,
              (std::vector<ShapeArrays::Kind>{ShapeArrays::Kind::sphere, ShapeArrays::Kind::disc,
                                              ShapeArrays::Kind::cylinder}));
    EXPECT_TRUE(shapes.world_from_object[0].isApprox(translation({12, 4, 6}), 1e-15));
    expect_near(shapes.world_from_object[1].col(2).head<3>(), {0, 0, -1});
    // Mitsuba prints this matrix for the cylinder.
    Matrix4d expected;
    expected << 0.5, 0, 0, 1, 0, 0.158114, 3, 0, 0, -0.474342, 1, 0, 0, 0, 0, 1;
    EXPECT_LT((shapes.world_from_object[2] - expected).cwiseAbs().maxCoeff(), 1e-6)
        << shapes.world_from_object[2];
}

TEST(MitsubaShapes, InstancesAreCopiesOfAGroup) {
    const Scene scene = parse_elements(R"(<bsdf type="diffuse" id="paint"/>
        <shape type="instance"><ref id="g"/><transform name="to_world"><translate x="10"/></transform></shape>
        <shape type="shapegroup" id="g">
            <shape type="sphere" id="ball"><float name="radius" value="2"/><ref id="paint"/></shape>
            <shape type="cube" id="box"><transform name="to_world"><translate y="5"/></transform></shape></shape>
        <shape type="instance"><ref id="g"/><transform name="to_world"><scale x="3"/></transform></shape>)");
    const ShapeArrays &shapes = scene.arrays().shapes;
    EXPECT_EQ(shapes.name, (std::vector<std::string>{"ball", "ball_2"}));
    EXPECT_TRUE(
        shapes.world_from_object[0].isApprox(translation({10, 0, 0}) * scaling({2, 2, 2}), 1e-15));
    EXPECT_TRUE(shapes.world_from_object[1].isApprox(scaling({6, 2, 2}), 1e-15));
    EXPECT_EQ(scene.meshes().name, (std::vector<std::string>{"box", "box_2"}));
    EXPECT_EQ(scene.materials().name.size(), 2u);  // paint, and grey of the boxes
}

TEST(MitsubaShapes, ShareWhatIsTheSame) {
    const Scene scene = parse_elements(R"(<bsdf type="diffuse" id="paint"/>
        <shape type="sphere"><ref id="paint"/></shape><shape type="sphere"><ref id="paint"/></shape>)");
    EXPECT_EQ(scene.materials().name, std::vector<std::string>{"paint"});
}

/// Writes two triangles that meet in an edge, the front half of a pyramid, as OBJ and as PLY.
void write_models() {
    std::ofstream(testing::TempDir() + "roof.obj")
        << "v 0 0 0\nv 1 0 0\nv 1 1 1\nv 0 1 0\nvt 0 0.25\nvt 1 "
           "0\nvt 1 1\nvt 0 1\nf 1/1 2/2 3/3\nf 1/1 3/3 4/4\n";
    std::ofstream(testing::TempDir() + "roof.ply")
        << "ply\nformat ascii 1.0\nelement vertex 4\nproperty float x\nproperty float y\nproperty "
           "float z\n"
           "property float u\nproperty float v\nelement face 2\nproperty list uchar int "
           "vertex_indices\nend_header\n"
           "0 0 0 0 0.25\n1 0 0 1 0\n1 1 1 1 1\n0 1 0 0 1\n3 0 1 2\n3 0 2 3\n";
}

TEST(MitsubaShapes, ModelFilesGetTheNormalsThatMitsubaMakes) {
    write_models();
    for (const std::string type : {"obj", "ply"}) {
        const auto read = [&](const std::string &properties) {
            return parse_elements("<shape type=\"" + type +
                                  R"("><string name="filename" value="roof.)" + type + "\"/>" +
                                  properties + "</shape>");
        };
        const auto normal_at = [](const MeshArrays &meshes, const Vector3f &position) {
            for (size_t i = 0; i < meshes.position.size(); ++i) {
                if ((meshes.position[i] - position).norm() < 1e-6f) {
                    return Vector3d(meshes.normal[i].cast<double>());
                }
            }
            return Vector3d(0, 0, 0);
        };
        const Scene smooth = read("");
        ASSERT_EQ(smooth.meshes().has_normals[0], 1) << type;
        // Mitsuba prints these normals.
        expect_near(normal_at(smooth.meshes(), {0, 0, 0}), {-0.4082, -0.4082, 0.8165}, 1e-4);
        expect_near(normal_at(smooth.meshes(), {1, 0, 0}), {0, -0.7071, 0.7071}, 1e-4);
        // Mirrored, stretched and flipped. Mitsuba prints the normals for -1 along x; the others
        // are computed by hand.
        const Scene mirrored = read(R"(<transform name="to_world"><scale x="-1"/></transform>)");
        expect_near(normal_at(mirrored.meshes(), {0, 0, 0}), {-0.4082, 0.4082, -0.8165}, 1e-4);
        expect_near(front(mirrored.meshes(), 0), Vector3d(0, 1, -1).normalized(), 1e-6);
        const Scene flipped = read(R"(<boolean name="flip_normals" value="true"/>)");
        expect_near(normal_at(flipped.meshes(), {1, 0, 0}), {0, 0.7071, -0.7071}, 1e-4);
        expect_near(front(flipped.meshes(), 0), Vector3d(0, 1, -1).normalized(), 1e-6);
        const Scene flat = read(R"(<boolean name="face_normals" value="true"/>)");
        EXPECT_EQ(flat.meshes().has_normals[0], 0);
        EXPECT_EQ(flat.meshes().has_uv[0], 1);
        expect_near(front(flat.meshes(), 0), Vector3d(0, -1, 1).normalized(), 1e-6);
    }
}

TEST(MitsubaBsdfs, AreOneSidedUnlessTheySayOtherwise) {
    EXPECT_FALSE(two_sided(R"(<bsdf type="diffuse"/>)"));
    EXPECT_FALSE(two_sided(R"(<bsdf type="roughconductor"/>)"));
    EXPECT_FALSE(two_sided(""));
    EXPECT_TRUE(two_sided(R"(<bsdf type="twosided"><bsdf type="diffuse"/></bsdf>)"));
    EXPECT_TRUE(two_sided(R"(<bsdf type="dielectric"/>)"));
}

TEST(MitsubaBsdfs, Diffuse) {
    const auto weight = [](const std::string &bsdf) { return components_of(bsdf)[0].weight; };
    EXPECT_EQ(weight(""), Vector3f(0.5f, 0.5f, 0.5f));
    EXPECT_EQ(weight(R"(<bsdf type="diffuse"/>)"), Vector3f(0.5f, 0.5f, 0.5f));
    EXPECT_EQ(
        weight(R"(<bsdf type="diffuse"><rgb name="reflectance" value="0.1, 0.2 0.3"/></bsdf>)"),
        Vector3f(0.1f, 0.2f, 0.3f));
    for (const char *tag : {"rgb", "spectrum", "float"}) {
        EXPECT_EQ(weight(std::string(R"(<bsdf type="diffuse"><)") + tag +
                         R"( name="reflectance" value="0.25"/></bsdf>)"),
                  Vector3f(0.25f, 0.25f, 0.25f));
    }
    const Vector3f half =
        weight(R"(<bsdf type="diffuse"><srgb name="reflectance" value="#80ff00"/></bsdf>)");
    EXPECT_NEAR(half[0], 0.2158605f, 1e-6f);  // IEC 61966-2-1 of 128 / 255
    EXPECT_EQ(half[1], 1);
    EXPECT_EQ(half[2], 0);
    EXPECT_EQ(weight(R"(<bsdf type="diffuse"><srgb name="reflectance" value="0, 1, 0"/></bsdf>)"),
              Vector3f(0, 1, 0));
    // An emissive shape without a BSDF is black.
    EXPECT_EQ(parse_elements(R"(<shape type="rectangle"><emitter type="area"/></shape>)")
                  .materials()
                  .component[0]
                  .weight,
              Vector3f(0, 0, 0));
}

TEST(MitsubaBsdfs, Dielectrics) {
    const auto smooth = components_of(R"(<bsdf type="dielectric"/>)");
    ASSERT_EQ(smooth.size(), 2u);
    EXPECT_EQ(smooth[0].kind, Kind::ideal_reflection);
    EXPECT_EQ(smooth[1].kind, Kind::ideal_refraction);
    EXPECT_TRUE(smooth[1].complement);
    EXPECT_NEAR(smooth[1].eta[0], 1.50418, 5e-6);  // as Mitsuba prints it
    const auto rough =
        components_of(R"(<bsdf type="roughdielectric"><string name="int_ior" value="water"/>
        <float name="ext_ior" value="1"/><float name="alpha" value="0.3"/><boolean name="sample_visible" value="false"/>
        <rgb name="specular_transmittance" value="0.5, 1, 1"/></bsdf>)");
    EXPECT_EQ(rough[0].kind, Kind::microfacet_reflection);
    EXPECT_EQ(rough[1].kind, Kind::microfacet_refraction);
    EXPECT_EQ(rough[0].distribution, BxdfComponent::Distribution::beckmann);
    EXPECT_EQ(rough[1].alpha, Vector2d(0.3, 0.3));
    EXPECT_EQ(rough[1].eta[0], 1.333);
    EXPECT_EQ(rough[1].weight, Vector3f(0.5f, 1, 1));
}

TEST(MitsubaBsdfs, Conductors) {
    const auto mirror = components_of(R"(<bsdf type="conductor"/>)");
    EXPECT_EQ(mirror[0].kind, Kind::ideal_reflection);
    EXPECT_EQ(mirror[0].fresnel, Fresnel::ideal);
    const auto gold =
        components_of(R"(<bsdf type="conductor"><string name="material" value="Au"/></bsdf>)");
    EXPECT_EQ(gold[0].fresnel, Fresnel::conductor);
    // Mitsuba prints these indices.
    EXPECT_LT((gold[0].eta - Vector3d(0.143036, 0.375307, 1.44205)).norm(), 1e-3);
    EXPECT_LT((gold[0].k - Vector3d(3.983, 2.38556, 1.60336)).norm(), 1e-3);
    const auto rough = components_of(
        R"(<bsdf type="roughconductor"><rgb name="eta" value="1,2,3"/><rgb name="k" value="4"/>
        <string name="distribution" value="ggx"/><float name="alpha_u" value="0.1"/><float name="alpha_v" value="0.2"/>
        <rgb name="specular_reflectance" value="0.3"/></bsdf>)");
    EXPECT_EQ(rough[0].kind, Kind::microfacet_reflection);
    EXPECT_EQ(rough[0].distribution, BxdfComponent::Distribution::ggx);
    EXPECT_EQ(rough[0].alpha, Vector2d(0.1, 0.2));
    EXPECT_EQ(rough[0].eta, Vector3d(1, 2, 3));
    EXPECT_EQ(rough[0].k, Vector3d(4, 4, 4));
    EXPECT_EQ(rough[0].weight, Vector3f(0.3f, 0.3f, 0.3f));
}

TEST(MitsubaBsdfs, PlasticsWeighTheirBaseAsMitsubaDoes) {
    // fdr_int and eta, as Mitsuba prints them for the default plastic.
    constexpr double internal = 0.590479;
    constexpr double eta = 1.48959;
    const auto plastic = components_of(R"(<bsdf type="plastic"/>)");
    ASSERT_EQ(plastic.size(), 2u);
    EXPECT_EQ(plastic[0].kind, Kind::ideal_reflection);
    EXPECT_EQ(plastic[1].kind, Kind::lambert);
    EXPECT_EQ(plastic[1].fresnel, Fresnel::dielectric);
    EXPECT_TRUE(plastic[1].complement);
    EXPECT_NEAR(plastic[1].eta[0], eta, 5e-6);
    EXPECT_NEAR(plastic[1].weight[0], 0.5 / (eta * eta * (1 - internal)), 5e-6);
    const auto deep = components_of(R"(<bsdf type="plastic"><boolean name="nonlinear" value="true"/>
        <rgb name="diffuse_reflectance" value="0.25, 0.5, 1"/></bsdf>)");
    EXPECT_NEAR(deep[1].weight[0], 0.25 / (eta * eta * (1 - 0.25 * internal)), 5e-6);
    EXPECT_NEAR(deep[1].weight[2], 1 / (eta * eta * (1 - internal)), 5e-6);
}

TEST(MitsubaBsdfs, BlendsWeighBothBsdfs) {
    const std::string blend =
        R"(<bsdf type="blendbsdf"><float name="weight" value="0.25"/>
        <bsdf type="plastic"><rgb name="diffuse_reflectance" value="1"/></bsdf>
        <bsdf type="roughconductor"><rgb name="eta" value="1,2,3"/><rgb name="k" value="4"/>
        <string name="distribution" value="ggx"/><float name="alpha" value="0.2"/></bsdf></bsdf>)";
    const auto parts = components_of(blend);
    const auto plastic =
        components_of(R"(<bsdf type="plastic"><rgb name="diffuse_reflectance" value="1"/></bsdf>)");
    ASSERT_EQ(parts.size(), 3u);
    for (size_t i = 0; i < 2; ++i) {
        EXPECT_EQ(parts[i].kind, plastic[i].kind);
        EXPECT_EQ(parts[i].fresnel, Fresnel::dielectric);
        EXPECT_EQ(parts[i].complement, plastic[i].complement);
        EXPECT_EQ(parts[i].eta[0], plastic[i].eta[0]);
        EXPECT_EQ(parts[i].weight, Vector3f(0.75f * plastic[i].weight));
    }
    EXPECT_EQ(parts[2].kind, Kind::microfacet_reflection);
    EXPECT_EQ(parts[2].fresnel, Fresnel::conductor);
    EXPECT_EQ(parts[2].distribution, BxdfComponent::Distribution::ggx);
    EXPECT_EQ(parts[2].alpha, Vector2d(0.2, 0.2));
    EXPECT_EQ(parts[2].eta, Vector3d(1, 2, 3));
    EXPECT_EQ(parts[2].k, Vector3d(4, 4, 4));
    EXPECT_EQ(parts[2].weight, Vector3f(0.25f, 0.25f, 0.25f));
    EXPECT_FALSE(two_sided(blend));
    EXPECT_TRUE(two_sided("<bsdf type=\"twosided\">" + blend + "</bsdf>"));
}

TEST(MitsubaBsdfs, MasksHaveAnOpacity) {
    const auto opacity = [](const std::string &property) {
        return parse_elements(
                   R"(<shape type="rectangle"><bsdf type="mask">)" + property +
                   R"(<bsdf type="twosided"><bsdf type="diffuse"/></bsdf></bsdf></shape>)")
            .materials();
    };
    const MaterialArrays materials = opacity(R"(<float name="opacity" value="0.25"/>)");
    EXPECT_EQ(materials.opacity[0].value, 0.25);
    EXPECT_EQ(materials.component[0].kind, Kind::lambert);
    EXPECT_EQ(materials.two_sided[0], 1);
    EXPECT_EQ(opacity("").opacity[0].value, 0.5);
    EXPECT_NEAR(opacity(R"(<rgb name="opacity" value="1, 0.5, 0"/>)").opacity[0].value,
                0.2126 + 0.5 * 0.7152, 1e-12);
}

class MitsubaTextures : public WithImages {};

/// Writes an image of 1 x 2 texels.
void write_image() {
    std::ofstream(testing::TempDir() + "two.ppm", std::ios::binary)
        << "P6 1 2 255\n"
        << std::string("\xff\x80\x01\x40\x20\x10");
}

TEST_F(MitsubaTextures, AreNormalAndBumpMaps) {
    write_image();
    const std::string raw =
        R"(<texture type="bitmap" name="normalmap"><string name="filename" value="two.ppm"/>
           <boolean name="raw" value="true"/></texture>)";
    const auto maps = [](const std::string &bsdf) {
        const Scene scene =
            parse_mitsuba_xml(mitsuba_scene(R"(<shape type="rectangle">)" + bsdf + "</shape>"),
                              "in.xml", "in", testing::TempDir());
        return scene.materials().normal_map.at(0);
    };
    const std::string diffuse = R"(<bsdf type="diffuse"/>)";
    using Map = NormalMap::Kind;
    const Notices notices;
    EXPECT_TRUE(maps(R"(<bsdf type="normalmap">)" + raw + diffuse + "</bsdf>") ==
                (NormalMap{Map::normals, 0, 1, true, false, false}));
    EXPECT_TRUE(maps(R"(<bsdf type="bumpmap"><float name="scale" value="-2"/>
                <boolean name="use_shadowing_function" value="false"/>)" +
                     raw + R"(<bsdf type="twosided">)" + diffuse + "</bsdf></bsdf>") ==
                (NormalMap{Map::heights, 0, -2, false, false, false}));
    EXPECT_TRUE(maps(R"(<bsdf type="mask"><bsdf type="twosided"><bsdf type="normalmap">)" + raw +
                     diffuse + "</bsdf></bsdf></bsdf>") ==
                (NormalMap{Map::normals, 0, 1, true, false, true}))
        << "turned before the map applies";
    for (const std::string &text : notices.texts()) {
        EXPECT_EQ(text.find("raw is false"), std::string::npos) << text;
    }
    maps(R"(<bsdf type="normalmap"><texture type="bitmap" name="normalmap">
            <string name="filename" value="two.ppm"/></texture>)" +
         diffuse + "</bsdf>");
    const std::vector<std::string> texts = notices.texts();
    EXPECT_TRUE(std::any_of(texts.begin(), texts.end(), [](const std::string &text) {
        return text.find("raw is false, so the map is decoded from sRGB, as in Mitsuba") !=
               std::string::npos;
    }));
}

TEST_F(MitsubaTextures, AreLookedUpWhereMitsubaDoes) {
    write_image();
    const std::string textured =
        R"(<bsdf type="diffuse" id="paper"><texture type="bitmap" name="reflectance">
        <string name="filename" value="two.ppm"/><string name="filter_type" value="nearest"/>
        <string name="wrap_mode" value="clamp"/><transform name="to_uv"><scale x="2" y="4"/>
        <translate x="0.125" y="0.25"/></transform></texture></bsdf>)";
    const Scene scene =
        parse_elements(textured + R"(<shape type="rectangle"><ref id="paper"/></shape>
        <shape type="sphere"><ref id="paper"/></shape><shape type="cube"><ref id="paper"/></shape>)");
    const TextureArrays &textures = scene.arrays().textures;
    ASSERT_EQ(textures.image.size(), 2u);
    EXPECT_EQ(textures.image[0], textures.image[1]);
    EXPECT_TRUE(textures.image[0]->srgb);
    EXPECT_EQ(textures.filter[0], TextureArrays::Filter::nearest);
    EXPECT_EQ(textures.wrap[0], TextureArrays::Wrap::clamp);
    const Scene mirrored =
        parse_elements(std::string(textured).replace(textured.find("clamp"), 5, "mirror") +
                       R"(<shape type="rectangle"><ref id="paper"/></shape>)");
    EXPECT_EQ(mirrored.arrays().textures.wrap[0], TextureArrays::Wrap::mirror);
    // Mitsuba's row from the top is 4 v + 1/4 of the height. RTRays' row from the bottom is
    // uv_scale v' + uv_offset, where v' is Mitsuba's v on rectangles and cubes and 1 - v on
    // spheres.
    for (const double v : {0.0, 0.3, 1.0}) {
        EXPECT_NEAR(textures.uv_scale[0][1] * v + textures.uv_offset[0][1], 1 - (4 * v + 0.25),
                    1e-15);
        EXPECT_NEAR(textures.uv_scale[1][1] * (1 - v) + textures.uv_offset[1][1],
                    1 - (4 * v + 0.25), 1e-15);
    }
    EXPECT_EQ(textures.uv_scale[0][0], 2);
    EXPECT_EQ(textures.uv_offset[1][0], 0.125);
    EXPECT_EQ(scene.materials().name, (std::vector<std::string>{"paper", "paper_2"}));
}

TEST_F(MitsubaTextures, AreDecodedUnlessRaw) {
    write_image();
    const auto image = [](const std::string &properties) {
        return parse_elements(
                   R"(<texture type="bitmap" id="t"><string name="filename" value="two.ppm"/>)" +
                   properties +
                   R"(</texture><shape type="rectangle"><bsdf type="diffuse"><ref name="reflectance" id="t"/>
                                  </bsdf></shape>)")
            .arrays()
            .textures.image[0];
    };
    EXPECT_TRUE(image("")->srgb);
    EXPECT_FALSE(image(R"(<boolean name="raw" value="true"/>)")->srgb);
}

TEST_F(MitsubaTextures, NeedCoordinatesInCommon) {
    write_image();
    const auto on = [](const std::string &shape) {
        return [shape] {
            parse_elements("<shape type=\"" + shape +
                           R"("><bsdf type="diffuse"><texture type="bitmap" name="reflectance">
<string name="filename" value="two.ppm"/></texture></bsdf></shape>)");
        };
    };
    std::ofstream(testing::TempDir() + "bare.obj") << "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n";
    expect_input_error(
        "<texture type=\"bitmap\" name=\"reflectance\">: this shape has no texture "
        "coordinates",
        [] {
            parse_elements(R"(<shape type="obj"><string name="filename" value="bare.obj"/>
                <bsdf type="diffuse"><texture type="bitmap" name="reflectance">
                <string name="filename" value="two.ppm"/></texture></bsdf></shape>)");
        });
    EXPECT_NO_THROW(on("cylinder")());
    EXPECT_NO_THROW(on("disk")());
}

TEST_F(MitsubaTextures, Environments) {
    std::ofstream(testing::TempDir() + "sky.pfm", std::ios::binary) << "PF\n2 3\n-1.0\n"
                                                                    << std::string(72, '\0');
    const Scene scene =
        parse_elements(R"(<emitter type="envmap"><string name="filename" value="sky.pfm"/>
        <float name="scale" value="3"/><transform name="to_world"><rotate y="1" angle="90"/></transform></emitter>)");
    const LightArrays &lights = scene.lights();
    EXPECT_EQ(lights.kind[0], LightArrays::Kind::environment);
    EXPECT_EQ(lights.radiance[0], Vector3f(3, 3, 3));
    EXPECT_EQ(lights.image[0]->width, 2);
    expect_near(lights.world_from_light[0].col(2).head<3>(), {1, 0, 0}, 1e-12);
}

TEST(MitsubaEmitters, BecomeLights) {
    const Scene scene = parse_elements(R"(
        <shape type="rectangle"><emitter type="area"><rgb name="radiance" value="1, 2, 3"/><float name="sampling_weight" value="2"/></emitter></shape>
        <emitter type="point"><point name="position" x="1" y="2" z="3"/><rgb name="intensity" value="4"/></emitter>
        <emitter type="spot"><float name="cutoff_angle" value="40"/><transform name="to_world">
            <lookat origin="0, 5, 0" target="0, 0, 0" up="1, 0, 0"/></transform></emitter>
        <emitter type="directional"><vector name="direction" x="0" y="-2" z="0"/><rgb name="irradiance" value="5"/></emitter>
        <emitter type="directional"><transform name="to_world"><rotate x="1" angle="90"/></transform></emitter>
        <emitter type="constant"><spectrum name="radiance" value="2"/><float name="sampling_weight" value="3"/></emitter>)");
    const LightArrays &lights = scene.lights();
    using Light = LightArrays::Kind;
    ASSERT_EQ(lights.kind,
              (std::vector<Light>{Light::diffuse_area, Light::point, Light::spot,
                                  Light::directional, Light::directional, Light::dome}));
    EXPECT_EQ(lights.radiance[0], Vector3f(1, 2, 3));
    EXPECT_DOUBLE_EQ(lights.area[0], 4);
    EXPECT_EQ(lights.radiance[1], Vector3f(4, 4, 4));
    expect_near(lights.world_from_light[1].topRightCorner<3, 1>(), {1, 2, 3});
    const auto shines = [&](size_t light) {
        return Vector3d(-lights.world_from_light[light].col(2).head<3>());
    };
    expect_near(shines(2), {0, -1, 0});
    expect_near(lights.world_from_light[2].topRightCorner<3, 1>(), {0, 5, 0});
    EXPECT_NEAR(lights.inner_angle[2], 30 * degree, 1e-15);  // three quarters of the cutoff
    EXPECT_NEAR(lights.outer_angle[2], 40 * degree, 1e-15);
    EXPECT_EQ(lights.radiance[2], Vector3f(1, 1, 1));
    expect_near(shines(3), {0, -1, 0});
    EXPECT_EQ(lights.radiance[3], Vector3f(5, 5, 5));
    expect_near(shines(4), {0, -1, 0});  // +z rotated about x
    // Illuminant E, as Mitsuba prints it.
    expect_near(lights.radiance[5].cast<double>(), {2.40959, 1.89658, 1.81783}, 1e-5);
    expect_consistent(scene.graph());
}

TEST(MitsubaNotices, NameWhatIsReplaced) {
    const Notices notices;
    const Scene scene =
        parse_mitsuba_xml(R"(<scene version="3.0.0"><default name="depth" value="6"/>
        <integrator type="$unknown"><integer name="max_depth" value="$depth"/></integrator>
        <sensor type="perspective"><float name="near_clip" value="0.5"/><sampler type="independent">
        <integer name="sample_count" value="32"/></sampler></sensor></scene>)",
                          "in.xml", "in");
    ASSERT_EQ(notices.texts().size(), 1u);
    for (const char *part :
         {"integrator '$unknown'", "max_depth 6, use --set integrator.max_depth=5",
          "rfilter 'gaussian'", "sampler 'independent' of 32", "near_clip 0.5"}) {
        EXPECT_NE(notices.texts()[0].find(part), std::string::npos) << notices.texts()[0];
    }
    parse_mitsuba_xml(mitsuba_scene(R"(<integrator type="direct"/>)"), "in.xml", "in");
    EXPECT_NE(notices.texts()[1].find("'direct' (use --set integrator.max_depth=1)"),
              std::string::npos)
        << notices.texts()[1];
}

/// Loads third-party scenes from the folder RTRAYS_MESHES; see docs/importers.md.
TEST(MitsubaScenesOfOthers, Load) {
    const char *meshes = std::getenv("RTRAYS_MESHES");
    if (meshes == nullptr) {
        GTEST_SKIP() << "RTRAYS_MESHES is not set";
    }
    const Notices silent;
    const Scene box = load_scene(std::string(meshes) + "/cornell-box-bitterli/scene.xml");
    EXPECT_EQ(box.name(), "cornell-box-bitterli");
    EXPECT_EQ(box.meshes().name.size(), 8u);
    EXPECT_EQ(box.film_width(), 1024);
    const Scene veach = load_scene(std::string(meshes) + "/veach-mis/scene.xml");
    EXPECT_EQ(veach.arrays().shapes.name.size(), 3u);
    EXPECT_EQ(veach.lights().name.size(), 3u);
    // The first scene lacks its mesh files, and the second uses an unsupported BSDF.
    expect_input_error(
        "breakfast-room/scene.xml:157: <shape type=\"obj\" id=\"FrostedGlass_0001\">: ",
        [&] { load_scene(std::string(meshes) + "/breakfast-room/scene.xml"); });
    expect_input_error("bistro-interior/scene.xml:",
                       [&] { load_scene(std::string(meshes) + "/bistro-interior/scene.xml"); });
}

}  // namespace
}  // namespace rtrays
