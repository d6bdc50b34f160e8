// SPDX-License-Identifier: MIT
// Tests the sides of the surfaces of Mitsuba scenes: normals that oppose the winding, flipped and
// stretched shapes, shapes that emit, and emitters that are hidden or referenced.
#include <Eigen/Geometry>
#include <cmath>
#include <filesystem>

#include "renderer/base/angles.h"
#include "renderer/export/mitsuba_xml.h"
#include "renderer/import/load_scene.h"
#include "renderer/testing/mitsuba_scenes.h"
#include "renderer/testing/temporary_folder.h"

namespace rtrays {
namespace {

using Eigen::Vector3d;
using Eigen::Vector3f;

Vector3f front(const MeshArrays &meshes, size_t triangle) {
    const Triangle &t = meshes.triangle[triangle];
    const Vector3f &a = meshes.position[t[0]];
    return (meshes.position[t[1]] - a).cross(meshes.position[t[2]] - a);
}

/// Returns the number of triangles whose front is on the side of their stored normals.
size_t agreeing(const MeshArrays &meshes) {
    size_t count = 0;
    for (size_t i = 0; i < meshes.triangle.size(); ++i) {
        const Triangle &t = meshes.triangle[i];
        const Vector3f normal = meshes.normal[t[0]] + meshes.normal[t[1]] + meshes.normal[t[2]];
        count += front(meshes, i).dot(normal) > 0 ? 1 : 0;
    }
    return count;
}

/// Two triangles facing +z, with normals that face +z and -z.
constexpr const char *two_sides =
    "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 1 1 0\nvn 0 0 1\nvn 0 0 -1\n"
    "f 1//1 2//1 3//1\nf 2//2 4//2 3//2\n";

class MitsubaSides : public testing::Test {
  protected:
    Scene load(const std::string &elements) {
        const Notices silent;
        return load_scene(folder_.write("in.xml", mitsuba_scene(elements)).string());
    }

    /// Returns the z coordinates of the fronts of the triangles of `two_sides`.
    std::vector<float> fronts(const std::string &properties) {
        folder_.write("sides.obj", two_sides);
        const Scene scene =
            load(R"(<shape type="obj"><string name="filename" value="sides.obj"/>)" + properties +
                 "</shape>");
        std::vector<float> z;
        for (size_t i = 0; i < scene.meshes().triangle.size(); ++i) {
            z.push_back(front(scene.meshes(), i)[2]);
        }
        return z;
    }

    TemporaryFolder folder_;
};

TEST_F(MitsubaSides, AreThoseOfStoredNormals) {
    using Fronts = std::vector<float>;
    EXPECT_EQ(fronts(""), (Fronts{1, -1}));
    EXPECT_EQ(fronts(R"(<boolean name="flip_normals" value="true"/>)"), (Fronts{-1, 1}));
    // Normals keep their side under a mirroring along x.
    EXPECT_EQ(fronts(R"(<transform name="to_world"><scale x="-1"/></transform>)"), (Fronts{1, -1}));
    // Without the stored normals, the winding decides.
    EXPECT_EQ(fronts(R"(<boolean name="face_normals" value="true"/>)"), (Fronts{1, 1}));
}

TEST_F(MitsubaSides, AreExportedWithNormalsInFront) {
    // The winding decides in a scene of ours.
    folder_.write("sides.obj", two_sides);
    const Notices silent;
    const Scene scene = load_scene((folder_.path() / "sides.obj").string());
    ASSERT_EQ(agreeing(scene.meshes()), 1u);
    export_mitsuba_xml(scene, folder_.path() / "out.xml");
    const Scene back = load_scene((folder_.path() / "out.xml").string());
    ASSERT_EQ(back.meshes().triangle.size(), 2u);
    EXPECT_EQ(agreeing(back.meshes()), 2u);
    for (size_t i = 0; i < 2; ++i) {
        EXPECT_EQ(front(back.meshes(), i), front(scene.meshes(), i));
    }
}

TEST_F(MitsubaSides, FlippedSpheresAreMeshes) {
    const std::string flipped =
        R"(<shape type="sphere"><float name="radius" value="3"/><boolean name="flip_normals" value="true"/>)";
    const Scene dome = load(flipped + R"(<emitter type="area"/></shape>)");
    ASSERT_EQ(dome.lights().kind.size(), 1u);
    EXPECT_NEAR(dome.lights().area[0], 4 * pi * 9, 4 * pi * 9 * 1e-5);
    const MeshArrays &meshes = dome.meshes();
    EXPECT_EQ(agreeing(meshes), meshes.triangle.size());
    for (size_t i = 0; i < meshes.position.size(); ++i) {
        EXPECT_NEAR(meshes.normal[i].dot(meshes.position[i].normalized()), -1, 1e-5f);
    }
    EXPECT_EQ(load(flipped + R"(<bsdf type="diffuse"/></shape>)").meshes().name.size(), 1u);
    EXPECT_EQ(load(flipped + R"(<bsdf type="dielectric"/></shape>)").meshes().name.size(), 1u);
    // Both sides of a two-sided surface are the same.
    const Scene same =
        load(flipped + R"(<bsdf type="twosided"><bsdf type="diffuse"/></bsdf></shape>)");
    EXPECT_EQ(same.arrays().shapes.name.size(), 1u);
}

TEST_F(MitsubaSides, MayHaveTwoBsdfs) {
    const Scene scene = load(R"(<shape type="rectangle"><bsdf type="twosided">
        <bsdf type="plastic"/><bsdf type="diffuse"><rgb name="reflectance" value="0.25"/></bsdf>
        </bsdf></shape>)");
    const std::vector<BxdfComponent> &parts = scene.materials().component;
    ASSERT_EQ(parts.size(), 3u);
    EXPECT_EQ(parts[0].side, BxdfComponent::Side::front);
    EXPECT_EQ(parts[1].side, BxdfComponent::Side::front);
    EXPECT_EQ(parts[2].side, BxdfComponent::Side::back);
    EXPECT_EQ(parts[2].kind, BxdfComponent::Kind::lambert);
    EXPECT_EQ(parts[2].weight, Vector3f::Constant(0.25f));
    EXPECT_EQ(scene.materials().two_sided[0], 1);
}

TEST_F(MitsubaSides, MirroredSpheresAreFlipped) {
    // In Mitsuba, the front of such a sphere is its inside. No other shape is like that.
    const auto mirrored = [&](const std::string &type, const std::string &properties) {
        return load("<shape type=\"" + type +
                    R"("><transform name="to_world"><scale x="-1"/></transform>)" + properties +
                    "</shape>");
    };
    const Scene inside = mirrored("sphere", R"(<emitter type="area"/>)");
    ASSERT_EQ(inside.meshes().name.size(), 1u);
    for (size_t i = 0; i < inside.meshes().triangle.size(); ++i) {
        const Triangle &t = inside.meshes().triangle[i];
        EXPECT_LT(front(inside.meshes(), i).dot(inside.meshes().position[t[0]]), 0);
    }
    const std::string flipped = R"(<boolean name="flip_normals" value="true"/>)";
    EXPECT_TRUE(mirrored("sphere", flipped + R"(<emitter type="area"/>)").meshes().name.empty());
    EXPECT_TRUE(mirrored("cylinder", R"(<bsdf type="diffuse"/>)").meshes().name.empty());

    const Scene ours = mirrored("sphere", flipped + R"(<bsdf type="diffuse"/>)");
    export_mitsuba_xml(ours, folder_.path() / "out.xml");
    const Notices silent;
    const Scene back = load_scene((folder_.path() / "out.xml").string());
    EXPECT_EQ(back.arrays().shapes.world_from_object, ours.arrays().shapes.world_from_object);
}

TEST_F(MitsubaSides, CylindersThatEmitAreMeshes) {
    const std::string cylinder =
        R"(<shape type="cylinder" id="tube"><float name="radius" value="0.5"/><point name="p1" x="0" y="0" z="2"/><emitter type="area"/>)";
    const Notices notices;
    const Scene outside =
        load_scene(folder_.write("in.xml", mitsuba_scene(cylinder + "</shape>")).string());
    EXPECT_NEAR(outside.lights().area[0], 2 * pi, 2 * pi * 1e-4);
    EXPECT_EQ(outside.lights().name[0], "tube");
    for (size_t i = 0; i < outside.meshes().position.size(); ++i) {
        const Vector3f &p = outside.meshes().position[i];
        EXPECT_NEAR(outside.meshes().normal[i].dot(Vector3f(2 * p[0], 2 * p[1], 0)), 1, 1e-5f);
    }
    EXPECT_EQ(agreeing(outside.meshes()), 512u);
    ASSERT_FALSE(notices.texts().empty());
    EXPECT_NE(
        notices.texts()[0].find("<shape type=\"cylinder\" id=\"tube\">: replaced by a mesh of "
                                "512 triangles, because this shape cannot emit here"),
        std::string::npos)
        << notices.texts()[0];
}

TEST_F(MitsubaSides, ShapesWithANormalMapBecomeMeshes) {
    const std::string map = R"(<bsdf type="twosided"><bsdf type="normalmap">
        <texture type="checkerboard" name="normalmap"/><bsdf type="diffuse"/></bsdf></bsdf></shape>)";
    for (const char *type : {"sphere", "cylinder"}) {
        const Notices notices;
        const Scene scene =
            parse_mitsuba_xml(mitsuba_scene(std::string("<shape type=\"") + type + "\">" + map),
                              "in.xml", "in", testing::TempDir());
        EXPECT_TRUE(scene.arrays().shapes.name.empty());
        EXPECT_EQ(scene.meshes().has_uv, std::vector<uint8_t>{1});
        ASSERT_FALSE(notices.texts().empty());
        EXPECT_NE(
            notices.texts()[0].find("because this shape cannot have a normal or bump map here"),
            std::string::npos)
            << notices.texts()[0];
    }
}

TEST_F(MitsubaSides, DisksWithATextureBecomeMeshesWithPolarCoordinates) {
    for (const bool flip : {false, true}) {
        const Notices notices;
        const Scene scene = parse_mitsuba_xml(
            mitsuba_scene(
                std::string(R"(<shape type="disk"><boolean name="flip_normals" value=")") +
                (flip ? "true" : "false") + R"("/><bsdf type="twosided"><bsdf type="diffuse">
                <texture type="checkerboard" name="reflectance"/></bsdf></bsdf></shape>)"),
            "in.xml", "in", testing::TempDir());
        const MeshArrays &meshes = scene.meshes();
        ASSERT_EQ(meshes.uv.size(), meshes.position.size());
        double area = 0;
        for (const Triangle &t : meshes.triangle) {
            const Vector3f &a = meshes.position[t[0]];
            const Vector3f normal = (meshes.position[t[1]] - a).cross(meshes.position[t[2]] - a);
            area += 0.5 * static_cast<double>(normal.norm());
            EXPECT_EQ(normal.z() > 0, !flip);
        }
        EXPECT_NEAR(area, pi, 2e-3);
        for (size_t i = 0; i < meshes.uv.size(); ++i) {
            const auto radius = static_cast<double>(meshes.uv[i].x());
            const double angle = 2 * pi * static_cast<double>(meshes.uv[i].y());
            EXPECT_NEAR(meshes.position[i].x(), radius * std::cos(angle), 1e-5);
            EXPECT_NEAR(meshes.position[i].y(), radius * std::sin(angle), 1e-5);
        }
        ASSERT_FALSE(notices.texts().empty());
        EXPECT_NE(
            notices.texts()[0].find("because the texture coordinates of this shape are polar"),
            std::string::npos);
    }
    // Without a texture it stays a disk, also where the material is shared.
    EXPECT_EQ(parse_elements(R"(<shape type="disk"/>)").arrays().shapes.name.size(), 1u);
}

TEST_F(MitsubaSides, CylindersMayBeStretchedAlongTheirAxis) {
    const Scene scene = load(
        R"(<shape type="cylinder"><transform name="to_world"><scale x="10" y="10" z="4"/></transform></shape>
        <shape type="cylinder"><float name="radius" value="10"/><point name="p1" x="0" y="0" z="4"/></shape>)");
    const ShapeArrays &shapes = scene.arrays().shapes;
    EXPECT_TRUE(shapes.world_from_object[0].isApprox(shapes.world_from_object[1], 1e-12))
        << shapes.world_from_object[0];
}

constexpr const char *two_lamps = R"(
    <shape type="rectangle" id="a"><ref id="e"/></shape>
    <emitter type="area" id="e"><rgb name="radiance" value="3, 2, 1"/></emitter>)";

TEST(MitsubaBsdfs, ThinDielectricsDoNotBendLight) {
    const auto plate =
        parse_elements(R"(<shape type="rectangle"><bsdf type="thindielectric"/></shape>)")
            .materials()
            .component;
    ASSERT_EQ(plate.size(), 2u);
    EXPECT_EQ(plate[0].kind, BxdfComponent::Kind::ideal_reflection);
    EXPECT_EQ(plate[1].kind, BxdfComponent::Kind::ideal_refraction);
    EXPECT_TRUE(plate[1].complement);
    for (const BxdfComponent &part : plate) {
        EXPECT_EQ(part.fresnel, BxdfComponent::Fresnel::thin_dielectric);
        EXPECT_EQ(part.eta[0], 1);
        EXPECT_NEAR(part.eta[1], 1.50418, 5e-6);
    }
}

TEST(MitsubaCameras, MayBeOrthographic) {
    const auto camera = [](const std::string &scale) {
        return parse_mitsuba(
            "<scene version=\"3.0.0\"><sensor type=\"orthographic\">"
            "<transform name=\"to_world\">" +
            scale +
            "<lookat origin=\"0,0,4\" target=\"0,0,0\" up=\"0,1,0\"/></transform>"
            "<film type=\"hdrfilm\"><integer name=\"width\" value=\"8\"/>"
            "<integer name=\"height\" value=\"4\"/></film></sensor></scene>");
    };
    // Examples of Mitsuba scale x and y alone.
    for (const char *scale : {"<scale x=\"3\" y=\"3\"/>", "<scale value=\"3\"/>"}) {
        const Scene scene = camera(scale);
        EXPECT_NEAR(scene.cameras().view_size.at(0), 6, 1e-12);
        EXPECT_EQ(scene.cameras().fov_axis.at(0), CameraArrays::FovAxis::x);
        const Vector3d position = scene.cameras().world_from_camera[0].topRightCorner<3, 1>();
        EXPECT_LT((position - Vector3d(0, 0, 4)).norm(), 1e-12);
        EXPECT_NEAR(scene.cameras().world_from_camera[0](2, 2), 1, 1e-12);
    }
    expect_input_error("scales x and y differently", [&] { camera("<scale x=\"3\" y=\"2\"/>"); });
}

TEST(MitsubaFilms, MayBeCropped) {
    const auto film = [](const std::string &crop) {
        return parse_mitsuba(
            "<scene version=\"3.0.0\"><sensor type=\"perspective\"><film type=\"hdrfilm\">"
            "<integer name=\"width\" value=\"8\"/><integer name=\"height\" value=\"4\"/>" +
            crop + "</film></sensor></scene>");
    };
    const Scene scene = film(
        "<integer name=\"crop_offset_x\" value=\"5\"/><integer name=\"crop_offset_y\" value=\"1\"/>"
        "<integer name=\"crop_width\" value=\"3\"/><integer name=\"crop_height\" value=\"2\"/>");
    EXPECT_EQ(scene.film_width(), 8);
    ASSERT_TRUE(scene.crop());
    EXPECT_EQ(scene.crop()->x, 5);
    EXPECT_EQ(scene.crop()->y, 1);
    EXPECT_EQ(scene.crop()->width, 3);
    EXPECT_EQ(scene.crop()->height, 2);
    EXPECT_FALSE(film("<integer name=\"crop_width\" value=\"8\"/>").crop());
}

TEST(MitsubaTexturedEmitters, AreMaterialsWithATextureOfEmission) {
    const std::string texture =
        R"(<texture type="checkerboard" name="radiance"><rgb name="color0" value="4,2,0"/>
        <float name="color1" value="1"/></texture>)";
    const auto shape = [&](const std::string &type, const std::string &bsdf) {
        return parse_elements("<shape type=\"" + type + "\"><emitter type=\"area\">" + texture +
                              "<float name=\"sampling_weight\" value=\"2\"/></emitter>" + bsdf +
                              "</shape>");
    };
    for (const char *bsdf : {"", R"(<bsdf type="diffuse" id="wall"/>)"}) {
        const Scene scene = shape("rectangle", bsdf);
        EXPECT_EQ(scene.lights().radiance.at(0), Vector3f(1, 1, 1));
        ASSERT_EQ(scene.materials().emission_texture.at(0), 0u);
        EXPECT_EQ(scene.arrays().textures.image.at(0)->floats[0], 4);
        EXPECT_EQ(scene.materials().component.at(0).weight[0], *bsdf != 0 ? 0.5f : 0.0f);
    }
    EXPECT_NEAR(shape("disk", "").lights().area.at(0), pi, 2e-3);
    // The BSDF does not emit where it is used without the emitter.
    const Scene two = parse_elements(
        R"(<bsdf type="diffuse" id="wall"/><shape type="rectangle"><ref id="wall"/></shape>
        <shape type="rectangle"><ref id="wall"/><emitter type="area">)" +
        texture + "</emitter></shape>");
    EXPECT_EQ(two.lights().name.size(), 1u);
    EXPECT_EQ(two.materials().name.size(), 2u);
}

TEST(MitsubaEmitterReferences, MayPrecedeTheEmitter) {
    const Scene scene = parse_elements(two_lamps);
    ASSERT_EQ(scene.lights().kind.size(), 1u);
    EXPECT_EQ(scene.lights().radiance[0], Vector3f(3, 2, 1));
    EXPECT_EQ(scene.lights().name[0], "a");
}

TEST(MitsubaEmitterReferences, UnusedEmittersAreReported) {
    const Notices notices;
    const Scene scene = parse_mitsuba_xml(
        mitsuba_scene(R"(<emitter type="area" id="e"/><shape type="cube"/>)"), "in.xml", "in");
    EXPECT_TRUE(scene.lights().kind.empty());
    ASSERT_EQ(notices.texts().size(), 2u);
    EXPECT_EQ(
        notices.texts()[1],
        "in.xml:3: <emitter type=\"area\" id=\"e\">: no shape refers to this emitter, so it is "
        "left out");
}

TEST(MitsubaHiddenEmitters, AreErrors) {
    const auto scene = [](const std::string &integrator, const std::string &emitter) {
        return [=] { parse_elements(integrator + emitter); };
    };
    const std::string hides =
        "<integrator type=\"path\"><boolean name=\"hide_emitters\" value=\"True\"/></integrator>";
    const std::string nested = "<integrator type=\"aov\">" + hides + "</integrator>";
    const std::string shows =
        "<integrator type=\"path\"><boolean name=\"hide_emitters\" value=\"false\"/></integrator>";
    for (const char *emitter : {"<shape type=\"cube\"><emitter type=\"area\"/></shape>",
                                "<emitter type=\"constant\"/>"}) {
        for (const std::string &integrator : {hides, nested}) {
            expect_input_error(
                "in.xml:3: <boolean name=\"hide_emitters\">: unsupported: emitters cannot be "
                "hidden",
                scene(integrator, emitter));
        }
        EXPECT_NO_THROW(scene(shows, emitter)());
    }
    // A point light cannot be seen.
    EXPECT_NO_THROW(scene(hides, "<emitter type=\"point\"/>")());
}

TEST(MitsubaNull, ShapesAreLeftOut) {
    const Notices notices;
    const Scene scene = parse_mitsuba_xml(
        mitsuba_scene(
            R"(<bsdf type="null" id="air"/><shape type="cube" id="room"><ref id="air"/></shape>
            <shape type="sphere"><bsdf type="null"/></shape><shape type="cube"/>)"),
        "in.xml", "in");
    EXPECT_EQ(scene.meshes().name.size(), 1u);
    EXPECT_TRUE(scene.arrays().shapes.name.empty());
    ASSERT_EQ(notices.texts().size(), 2u);
    EXPECT_NE(notices.texts()[1].find("are left out: room, shape"), std::string::npos);
}

TEST(MitsubaLookat, HasTheRollOfMitsubaWithoutUp) {
    // Mitsuba prints these matrices; its objects have +x to the left and look along +z.
    const auto world = [](const std::string &lookat) {
        const Scene scene = parse_elements("<shape type=\"sphere\"><transform name=\"to_world\">" +
                                           lookat + "</transform></shape>");
        return Eigen::Matrix3d(scene.arrays().shapes.world_from_object[0].topLeftCorner<3, 3>());
    };
    Eigen::Matrix3d expected;
    expected << 0, 0.97014248, 0.24253562, 1, 0, 0, 0, 0.24253562, -0.97014248;
    EXPECT_LT((world(R"(<lookat origin="0,0,4" target="1,0,0"/>)") - expected).norm(), 1e-7);
    expected << 0, 1, 0, 0, 0, -1, -1, 0, 0;
    EXPECT_LT((world(R"(<lookat origin="0,4,0" target="0,0,0"/>)") - expected).norm(), 1e-7);
    expected << -0.17676032, 0.41079897, -0.89442718, 0.94697189, -0.17676032, -0.26832816,
        -0.26832816, -0.89442718, -0.35777089;
    EXPECT_LT((world(R"(<lookat origin="1,2,3" target="-4,0.5,1"/>)") - expected).norm(), 1e-7);
    // A vector of zeros is no direction, too.
    EXPECT_EQ(world(R"(<lookat origin="0,0,4" target="1,0,0" up="0,0,0"/>)"),
              world(R"(<lookat origin="0,0,4" target="1,0,0"/>)"));
    for (const char *target : {"0,1,0", "0,-1,0", "0,0,1", "0,0,-1", "1,2,-0.1"}) {
        const Eigen::Matrix3d frame =
            world(R"(<lookat origin="0,0,0" target=")" + std::string(target) + R"("/>)");
        EXPECT_TRUE(frame.isUnitary(1e-12)) << target;
    }
}

TEST(MitsubaBooleans, HaveAnyCaseAndNumbersAPlus) {
    const Scene scene = parse_elements(R"(<shape type="rectangle">
        <boolean name="flip_normals" value="TRUE"/></shape>
        <emitter type="point"><point name="position" x="+42.5" y="+1e1" z="-1"/></emitter>)");
    EXPECT_LT(front(scene.meshes(), 0)[2], 0);
    const Vector3d position = scene.lights().world_from_light[0].topRightCorner<3, 1>();
    EXPECT_EQ(position + scene.origin(), Vector3d(42.5, 10, -1));
}

/// Returns the colour of a texture by nearest lookup at Mitsuba's (u, v) on a rectangle.
Vector3f texel_at(const TextureArrays &textures, double u, double v) {
    const TextureImage &image = *textures.image[0];
    const Eigen::Vector2d at =
        textures.uv_scale[0].cwiseProduct(Eigen::Vector2d(u, v)) + textures.uv_offset[0];
    const auto cell = [](double x, int n) {
        return std::min(static_cast<int>((x - std::floor(x)) * n), n - 1);
    };
    // Rows are stored from the top.
    const int column = cell(at[0], image.width);
    const int row = image.height - 1 - cell(at[1], image.height);
    const size_t first = 3 * static_cast<size_t>(row * image.width + column);
    return {image.floats[first], image.floats[first + 1], image.floats[first + 2]};
}

TEST(MitsubaCheckerboard, IsATextureOfFourTexels) {
    const Scene scene = parse_elements(R"(<shape type="rectangle"><bsdf type="diffuse">
        <texture type="checkerboard" name="reflectance"><rgb name="color0" value="0.5, 0.25, 0.125"/>
        <transform name="to_uv"><scale x="3" y="2"/><translate x="0.25" y="0.125"/></transform></texture></bsdf></shape>)");
    const TextureArrays &textures = scene.arrays().textures;
    EXPECT_EQ(textures.filter[0], TextureArrays::Filter::nearest);
    EXPECT_EQ(textures.wrap[0], TextureArrays::Wrap::repeat);
    for (int i = 0; i < 40; ++i) {
        for (int j = 0; j < 40; ++j) {
            const double u = (i + 0.37) / 40, v = (j + 0.41) / 40;
            // Mitsuba 3.9, src/textures/checkerboard.cpp.
            const double x = 3 * u + 0.25, y = 2 * v + 0.125;
            const bool same = (x - std::floor(x) > 0.5) == (y - std::floor(y) > 0.5);
            EXPECT_EQ(texel_at(textures, u, v),
                      same ? Vector3f(0.5f, 0.25f, 0.125f) : Vector3f(0.2f, 0.2f, 0.2f))
                << u << " " << v;
        }
    }
}

}  // namespace
}  // namespace rtrays
