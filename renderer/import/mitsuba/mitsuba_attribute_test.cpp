// SPDX-License-Identifier: MIT
// Tests the import of Mitsuba's mesh attributes: colours of vertices.
#include <fstream>

#include "renderer/testing/mitsuba_scenes.h"

namespace rtrays {
namespace {

/// Writes a triangle as painted.ply, with the float properties `names` of 0.5, 0.25 and 1.
void write_triangle(const std::string &names) {
    std::ofstream file(testing::TempDir() + "painted.ply");
    file << "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\n"
            "property float z\n"
         << names
         << "element face 1\nproperty list uchar int vertex_indices\nend_header\n"
            "0 0 0 0.5 0.25 1\n1 0 0 0.5 0.25 1\n0 1 0 0.5 0.25 1\n3 0 1 2\n";
}

const std::string rgb = "property float r\nproperty float g\nproperty float b\n";
const std::string other = "property float p\nproperty float q\nproperty float s\n";

/// A shape with a diffuse BSDF, whose reflectance is a mesh attribute with these properties.
std::string shape(const std::string &shape, const std::string &properties) {
    return "<shape type=" + shape +
           R"(><bsdf type="diffuse"><texture type="mesh_attribute" name="reflectance">)" +
           properties + "</texture></bsdf></shape>";
}

const std::string ply = R"("ply"><string name="filename" value="painted.ply"/)";
const std::string name = R"(<string name="name" value="vertex_color"/>)";

TEST(MitsubaAttributes, VertexColoursAreATexture) {
    write_triangle(rgb);
    const Scene scene = parse_elements(shape(ply, name));
    EXPECT_EQ(scene.meshes().colour, std::vector<Rgb>(3, Rgb(0.5f, 0.25f, 1)));
    ASSERT_EQ(scene.materials().component[0].texture, 0u);
    EXPECT_TRUE(scene.arrays().textures.has_vertex_colours(0));
    EXPECT_EQ(scene.arrays().textures.image[0]->bytes, std::vector<uint8_t>(3, 255));

    const Scene scaled = parse_elements(shape(ply, name + R"(<float name="scale" value="0.5"/>)"));
    EXPECT_EQ(scaled.arrays().textures.image[0]->floats, std::vector<float>(3, 0.5f));
    // A mesh without normals whose transform shears is baked. It keeps its colours.
    const Scene sheared = parse_elements(
        shape(ply, name).replace(shape(ply, name).find("<bsdf"), 0,
                                 R"(<transform name="to_world"><scale x="2"/></transform>)"));
    EXPECT_EQ(sheared.meshes().colour, scene.meshes().colour);
}

TEST(MitsubaAttributes, ErrorsNameTheAttributeOrTheShape) {
    write_triangle(rgb);
    const auto expect = [](const std::string &message, const std::string &body) {
        expect_input_error(message, [&] { parse_elements(body); });
    };
    expect(
        "in.xml:3: <texture type=\"mesh_attribute\" name=\"reflectance\">: unsupported attribute "
        "'face_color'; the "
        "supported one is vertex_color",
        shape(ply, R"(<string name="name" value="face_color"/>)"));
    expect("unsupported attribute ''", shape(ply, ""));
    expect("scale: -1 is negative", shape(ply, name + R"(<float name="scale" value="-1"/>)"));
    expect("<shape type=\"sphere\">: has no vertex_color, which texture 'vertex_color' of its",
           shape("\"sphere\"", name));
    expect("add up to 3 in red", shape(ply, name + R"(<float name="scale" value="3"/>)"));
    write_triangle(other);
    expect("<shape type=\"ply\">: has no vertex_color", shape(ply, name));
    write_triangle(rgb);
    std::string mask = shape(ply, name);
    mask.replace(mask.find("reflectance"), 11, "opacity");
    mask.replace(mask.find("diffuse"), 7, "mask");
    mask.insert(mask.find("</bsdf>"), R"(<bsdf type="diffuse"/>)");
    expect("texture 'vertex_color' of its opacity has vertex_colours", mask);
}

}  // namespace
}  // namespace rtrays
