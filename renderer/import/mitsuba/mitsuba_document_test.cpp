// SPDX-License-Identifier: MIT
// Tests the document of a Mitsuba scene: folders that are searched, included files, parameters,
// versions before 2, and the list of all errors.
#include <filesystem>

#include "renderer/import/load_scene.h"
#include "renderer/testing/mitsuba_scenes.h"
#include "renderer/testing/temporary_folder.h"

namespace rtrays {
namespace {

namespace fs = std::filesystem;
using Eigen::Vector3d;
using Eigen::Vector3f;

/// A triangle of this size as OBJ.
std::string triangle(int size) {
    const std::string s = std::to_string(size);
    return "v 0 0 0\nv " + s + " 0 0\nv 0 " + s + " 0\nf 1 2 3\n";
}

const std::string mesh = R"(<shape type="obj"><string name="filename" value="m/q.obj"/></shape>)";

/// A scene in a folder, with meshes and included files.
class MitsubaFiles : public testing::Test {
  protected:
    void write(const std::string &name, const std::string &content) {
        fs::create_directories((folder_.path() / name).parent_path());
        folder_.write(name, content);
    }

    void write_part(const std::string &name, const std::string &elements) {
        write(name, "<scene version=\"3.0.0\">" + elements + "</scene>");
    }

    /// Loads a scene of these elements. Returns the size of its triangle.
    float size_in(const std::string &elements) {
        write("top.xml", mitsuba_scene(elements));
        const Notices silent;
        const Scene scene = load_scene((folder_.path() / "top.xml").string());
        float size = 0;
        for (const Vector3f &position : scene.meshes().position) {
            size = std::max(size, position[0] + static_cast<float>(scene.origin()[0]));
        }
        return size;
    }

    TemporaryFolder folder_;
};

TEST_F(MitsubaFiles, MeshesAreBesideTheTopFile) {
    write("m/q.obj", triangle(1));
    EXPECT_EQ(size_in(mesh), 1);
    write_part("parts/shapes.xml", mesh);
    EXPECT_EQ(size_in("<include filename=\"parts/shapes.xml\"/>"), 1);
    // A mesh of that name beside the included file is another one.
    write("parts/m/q.obj", triangle(2));
    EXPECT_EQ(size_in("<include filename=\"parts/shapes.xml\"/>"), 1);
    fs::remove(folder_.path() / "m/q.obj");
    expect_input_error(
        "parts/shapes.xml:1: <shape type=\"obj\">: cannot find 'm/q.obj'; searched "
        "folders: '" +
            folder_.path().string() + "'",
        [&] { size_in("<include filename=\"parts/shapes.xml\"/>"); });
}

TEST_F(MitsubaFiles, IncludesAreBesideTheIncludingOrTheTopFile) {
    write("m/q.obj", triangle(1));
    write_part("parts/y.xml", mesh);
    write_part("parts/x.xml", "<include filename=\"y.xml\"/>");
    EXPECT_EQ(size_in("<include filename=\"parts/x.xml\"/>"), 1);
    write_part("parts/deep/x.xml", "<include filename=\"parts/y.xml\"/>");
    EXPECT_EQ(size_in("<include filename=\"parts/deep/x.xml\"/>"), 1);
}

TEST_F(MitsubaFiles, PathsOfTheTopFileComeFirst) {
    write("m/q.obj", triangle(1));
    write("lib/m/q.obj", triangle(2));
    write("other/m/q.obj", triangle(3));
    EXPECT_EQ(size_in("<path value=\"lib\"/>" + mesh), 2);
    EXPECT_EQ(size_in(mesh + "<path value=\"lib\"/><path value=\"other\"/>"), 3);
    const std::string absolute = (folder_.path() / "lib").string();
    EXPECT_EQ(size_in("<path value=\"" + absolute + "\"/>" + mesh), 2);
    // The path of an included file is for its own includes only.
    write_part("part.xml", "<path value=\"lib\"/>" + mesh);
    EXPECT_EQ(size_in("<include filename=\"part.xml\"/>"), 1);
    expect_input_error("in.xml:3: <path>: cannot find 'nowhere'; searched folders: ",
                       [] { parse_elements("<path value=\"nowhere\"/>"); });
    expect_input_error("<path>: '" + (folder_.path() / "top.xml").string() + "' is not a folder",
                       [&] { size_in("<path value=\"top.xml\"/>"); });
}

TEST(MitsubaParameters, AreDefinedByTheCaller) {
    const std::string scene = mitsuba_scene(R"(<default name="x" value="1"/>
        <emitter type="point" id="lamp"><point name="position" x="$x" y="0" z="0"/></emitter>)");
    const Notices silent;
    const auto x_with = [&](const std::map<std::string, std::string> &defines) {
        return parse_mitsuba_xml(scene, "in.xml", "in", ".", defines)
            .lights()
            .world_from_light[0](0, 3);
    };
    EXPECT_EQ(x_with({}), 1);
    EXPECT_EQ(x_with({{"x", "7"}}), 7);
    expect_input_error("in.xml: parameter 'y' is defined, but the file does not use $y", [&] {
        x_with({{"y", "7"}});
    });
    EXPECT_EQ(parse_defines({"a=1", "b=x=y", "c="}),
              (std::map<std::string, std::string>{{"a", "1"}, {"b", "x=y"}, {"c", ""}}));
    for (const char *text : {"a", "=1", ""}) {
        expect_input_error("expected NAME=VALUE", [&] { parse_defines({text}); });
    }
    expect_input_error("--define requires a Mitsuba scene", [] {
        load_scene(RTRAYS_SCENES "/cornell_box/scene.json", true, {{"a", "1"}});
    });
}

TEST(MitsubaParameters, AliasesAreFurtherNames) {
    const Scene scene =
        parse_elements(R"(<bsdf type="diffuse" id="paint"/><alias id="paint" as="wall"/>
        <shape type="cube"><ref id="wall"/></shape>)");
    EXPECT_EQ(scene.materials().name, std::vector<std::string>{"paint"});
    expect_input_error("<alias id=\"a\">: unknown id 'a'",
                       [] { parse_elements(R"(<alias id="a" as="b"/>)"); });
}

/// Returns a scene of Mitsuba 0.5, and the same scene as Mitsuba 3 upgrades it.
std::string old_scene(const std::string &elements) {
    return R"(<scene version="0.5.0"><integrator type="path"><integer name="maxDepth" value="5"/></integrator>
        <sensor type="perspective"><string name="fovAxis" value="smaller"/><float name="fov" value="40"/><float name="nearClip" value="0.1"/>
        <transform name="toWorld"><lookAt origin="0,1,5" target="0,1,0" up="0,1,0"/></transform>
        <film type="ldrfilm"><integer name="width" value="8"/><integer name="cropOffsetX" value="0"/>
        <string name="fileFormat" value="png"/><float name="gamma" value="2.2"/></film>
        <sampler type="sobol"><integer name="sampleCount" value="16"/></sampler></sensor>)" +
           elements + "</scene>";
}

class MitsubaOldVersions : public WithImages {};

TEST_F(MitsubaOldVersions, AreUpgradedAsMitsubaDoes) {
    std::ofstream(testing::TempDir() + "one.ppm", std::ios::binary) << "P6 1 1 255\nabc";
    const Scene scene = parse_mitsuba(old_scene(R"(
        <bsdf type="diffuse" id="paper"><texture type="bitmap" name="diffuseReflectance">
            <string name="filename" value="one.ppm"/><string name="filterType" value="nearest"/>
            <float name="uscale" value="2"/><float name="vscale" value="4"/>
            <float name="uoffset" value="0.25"/><float name="voffset" value="0.125"/></texture></bsdf>
        <shape type="rectangle"><transform name="toWorld"><scale value="2"/></transform><ref id="paper"/></shape>
        <shape type="sphere"><bsdf type="plastic"><float name="intIOR" value="1.4"/><float name="extIOR" value="1"/>
            <rgb name="diffuseReflectance" value="#ff8000"/></bsdf></shape>)"));
    EXPECT_EQ(scene.film_width(), 8);
    EXPECT_EQ(scene.cameras().fov_axis[0], CameraArrays::FovAxis::smaller);
    const TextureArrays &textures = scene.arrays().textures;
    // Mitsuba 3 scales after the offset: u is looked up at 2 (u + 0.25), the row from the top at
    // 4 (v + 0.125).
    EXPECT_EQ(textures.uv_scale[0], Eigen::Vector2d(2, -4));
    EXPECT_EQ(textures.uv_offset[0], Eigen::Vector2d(0.5, 1 - 0.5));
    EXPECT_EQ(textures.filter[0], TextureArrays::Filter::nearest);
    EXPECT_EQ(scene.meshes().position[0], Vector3f(-2, -2, 0));
    const std::vector<BxdfComponent> &components = scene.materials().component;
    EXPECT_EQ(components[1].eta[0], 1.4);
    // The digits of <rgb> are linear.
    EXPECT_NEAR(components[2].weight[1] / components[2].weight[0], 128.0f / 255, 1e-6f);
}

TEST_F(MitsubaOldVersions, AreAnnounced) {
    const Notices notices;
    parse_mitsuba_xml(old_scene(""), "in.xml", "in");
    ASSERT_FALSE(notices.texts().empty());
    for (const char *part :
         {"film 'ldrfilm'", "use --set integrator.max_depth=4", "'sobol' of 16", "near_clip 0.1"}) {
        EXPECT_NE(notices.texts()[0].find(part), std::string::npos) << notices.texts()[0];
    }
}

TEST_F(MitsubaOldVersions, OnlyOldFilesAreUpgraded) {
    const auto scene = [](const std::string &version) {
        return [version] {
            parse_mitsuba("<scene version=\"" + version +
                          "\"><sensor type=\"perspective\"><float name=\"nearClip\" "
                          "value=\"1\"/></sensor></scene>");
        };
    };
    for (const char *version : {"0.4.0", "0.5.0", "0.6.0"}) {
        EXPECT_NO_THROW(scene(version)()) << version;
    }
    for (const char *version : {"2.0.0", "3.9.1"}) {
        expect_input_error("unknown property of sensor type 'perspective'", scene(version));
    }
    expect_input_error("unsupported version '4.0.0'", scene("4.0.0"));
    // What Mitsuba 3 writes after an upgrade has the new names and the old version.
    EXPECT_NO_THROW(parse_mitsuba(R"(<scene version="0.6.0"><sensor type="perspective">
        <float name="near_clip" value="1"/></sensor></scene>)"));
}

TEST(MitsubaErrorList, NamesAllFaultsOfAFile) {
    const std::string message = error_of(ExitCode::bad_input, [] {
        parse_elements(R"(<bsdf type="mirror" id="a"/>
<shape type="cube"><ref id="a"/></shape><shape type="cube"><ref id="a"/></shape>
<shape type="torus"><bsdf type="plastic"><float name="sheen" value="1"/>
<texture type="bitmap" name="diffuse_reflectance"><string name="filename" value="none.png"/></texture></bsdf></shape>
<shape type="cube"><boolean name="round" value="true"/><boolean name="flat" value="true"/></shape>
<volume/>)");
    });
    std::istringstream lines(message);
    std::vector<std::string> starts;
    for (std::string line; std::getline(lines, line);) {
        starts.push_back(line.substr(0, line.find('>')));
    }
    EXPECT_EQ(starts, (std::vector<std::string>{
                          "in.xml: 7 errors", "in.xml:3: <bsdf type=\"mirror\" id=\"a\"",
                          "in.xml:5: <shape type=\"torus\"", "in.xml:5: <float name=\"sheen\"",
                          "in.xml:7: <boolean name=\"flat\"", "in.xml:7: <boolean name=\"round\"",
                          "in.xml:8: <volume",
                          "in.xml:6: <texture type=\"bitmap\" name=\"diffuse_reflectance\""}))
        << message;
}

TEST(MitsubaErrorList, IsCut) {
    std::string elements;
    for (int i = 0; i < 150; ++i) {
        elements += "<wrong id=\"" + std::to_string(i) + "\"/>";
    }
    const std::string message = error_of(ExitCode::bad_input, [&] { parse_elements(elements); });
    EXPECT_EQ(message.rfind("in.xml: 150 errors\n", 0), 0u);
    EXPECT_EQ(std::count(message.begin(), message.end(), '\n'), 101);
}

}  // namespace
}  // namespace rtrays
