// SPDX-License-Identifier: MIT
// Tests that each error in a Mitsuba scene, and each unsupported feature, has a clear message with
// a line number, and that damaged files either load or are errors.
#include <fstream>
#include <random>

#include "renderer/testing/mitsuba_scenes.h"

namespace rtrays {
namespace {

struct BadElement {
    std::string body;     ///< begins in line 3, added to a valid sensor
    const char *message;  ///< fragment of the error message
};

const char *const checks = "<texture type=\"checkerboard\" name=\"normalmap\"/>";

class BadElements : public testing::TestWithParam<BadElement> {};

TEST_P(BadElements, AreOneClearError) {
    expect_input_error(GetParam().message, [] { parse_elements(GetParam().body); });
}

std::string shape(const std::string &content, const std::string &type = "rectangle") {
    return "<shape type=\"" + type + "\">\n" + content + "\n</shape>";
}

std::string bsdf(const std::string &type, const std::string &properties = "") {
    return shape("<bsdf type=\"" + type + "\">\n" + properties + "\n</bsdf>");
}

std::string light(const std::string &type, const std::string &properties = "") {
    return "<emitter type=\"" + type + "\">\n" + properties + "\n</emitter>";
}

std::string placed(const std::string &operations) {
    return light("point", "<transform name=\"to_world\">\n" + operations + "\n</transform>");
}

INSTANTIATE_TEST_SUITE_P(
    Documents, BadElements,
    testing::Values(
        BadElement{"<shape", "in.xml:4: not well-formed XML: "},
        BadElement{"<shape type=\"cube\"></bsdf>", "in.xml:3: not well-formed XML: "},
        BadElement{"</scene><scene>", "in.xml:3: second root element <scene>"},
        BadElement{"words", "in.xml:1: <scene>: unexpected text '\nwords\n'; expected elements"},
        BadElement{"<medium type=\"homogeneous\"/>",
                   "in.xml:3: <medium type=\"homogeneous\">: unsupported element"},
        BadElement{"<shape/>", "in.xml:3: <shape>: needs a type"},
        BadElement{"\n<shape type=\"cube\" colour=\"1\"/>",
                   "in.xml:4: <shape type=\"cube\">: unknown attribute 'colour'; attributes are: "
                   "type, id"},
        BadElement{"<shape type=\"cube\" type=\"disk\"/>", "duplicate attribute 'type'"},
        BadElement{shape("<float value=\"1\"/>"), "in.xml:4: <float>: needs a name"},
        BadElement{
            shape("<boolean name=\"a\" value=\"true\"/><boolean name=\"a\" value=\"true\"/>"),
            "duplicate property 'a'"},
        BadElement{
            shape("<group/>"),
            "in.xml:4: <group>: unexpected element in <shape>; expected a property (float, "},
        BadElement{
            shape("<boolean name=\"flip_normal\" value=\"true\"/>"),
            "in.xml:4: <boolean name=\"flip_normal\">: unknown property of shape type 'rectangle'; "
            "properties are: flip_normals, to_world"},
        BadElement{shape("<ref id=\"b\"/>") + "<bsdf type=\"diffuse\" id=\"a\"/>",
                   "in.xml:4: <ref id=\"b\">: unknown id 'b'; ids are: a, eye"},
        BadElement{shape("<ref id=\"eye\"/>"),
                   "in.xml:4: <ref id=\"eye\">: shape type 'rectangle' accepts no sensor"},
        BadElement{"<shape type=\"cube\" id=\"eye\"/>",
                   "in.xml:3: <shape type=\"cube\" id=\"eye\">: duplicate id 'eye'"},
        BadElement{"<shape type=\"$kind\"/>",
                   "in.xml:3: <shape type=\"$kind\">: undefined parameter '$kind'; add <default "
                   "name=\"kind\""},
        BadElement{"<default name=\"a b\" value=\"1\"/>",
                   "in.xml:3: <default name=\"a b\">: needs a name"},
        BadElement{"<default name=\"a\"/>", "and a value"},
        BadElement{"<include filename=\"none.xml\"/>", "in.xml:3: <include>: "},
        BadElement{shape(shape("")),
                   "in.xml:4: <shape type=\"rectangle\">: shape type 'rectangle' accepts no shape"},
        BadElement{shape("", "instance"),
                   "in.xml:3: <shape type=\"instance\">: needs a reference to one shapegroup"},
        BadElement{shape(shape("", "cube"), "instance"), "needs a reference to one shapegroup"},
        BadElement{shape(shape(shape("", "instance"), "shapegroup"), "instance"),
                   "in.xml:5: <shape type=\"instance\">: unsupported shape type"},
        BadElement{shape(shape(shape("<emitter type=\"area\"/>"), "shapegroup"), "instance"),
                   "in.xml:6: <emitter type=\"area\">: unsupported in a shapegroup"}));

INSTANTIATE_TEST_SUITE_P(
    Values, BadElements,
    testing::Values(
        BadElement{placed("<scale value=\"0\"/>"),
                   "in.xml:5: <scale>: transform: the matrix is not invertible"},
        BadElement{placed("<translate x=\"1e999\"/>"),
                   "in.xml:5: <translate>: expected finite numbers, got '1e999'"},
        BadElement{placed("<translate x=\"nan\"/>"), "expected finite numbers, got 'nan'"},
        BadElement{placed("<translate x=\"1m\"/>"), "expected finite numbers, got '1m'"},
        BadElement{placed("<translate x=\"1 2\"/>"), "x: expected one number"},
        BadElement{placed("<translate value=\"1,2\"/>"), "value: expected three numbers"},
        BadElement{placed("<translate value=\"1\" x=\"2\"/>"), "has both 'value' and x, y or z"},
        BadElement{placed("<rotate z=\"2\" angle=\"90\"/>"),
                   "in.xml:5: <rotate>: the axis must have length 1, not 2"},
        BadElement{placed("<rotate z=\"1\"/>"), "needs an angle"},
        BadElement{placed("<matrix value=\"1 0 0\"/>"), "has 3 numbers; expected 16 or 9"},
        BadElement{placed("<matrix value=\"1 0 0 0 0 1 0 0 0 0 1 0 0 0 1 1\"/>"),
                   "in.xml:5: <matrix>: transform: the matrix is not affine"},
        BadElement{placed("<lookat origin=\"0 0 0\" target=\"0 1 0\" up=\"0 1 0\"/>"),
                   "in.xml:5: <lookat>: look_at: up must not be parallel"},
        BadElement{placed("<turn/>"),
                   "in.xml:5: <turn>: unknown transform; transforms are: translate, rotate,"},
        BadElement{light("point", "<point name=\"position\" x=\"1\" y=\"2\"/>"),
                   "in.xml:4: <point name=\"position\">: expected one number as z"},
        BadElement{light("point", "<point name=\"position\" value=\"1 2\"/>"),
                   "expected three numbers"},
        BadElement{light("point", "<rgb name=\"intensity\" value=\"1 2\"/>"),
                   "in.xml:4: <rgb name=\"intensity\">: expected three numbers, or one"},
        BadElement{light("point", "<rgb name=\"intensity\" value=\"1 -2 3\"/>"),
                   "in.xml:3: <emitter type=\"point\">: intensity: [1, -2, 3] is not within"},
        BadElement{light("point", "<string name=\"intensity\" value=\"1\"/>"),
                   "in.xml:4: <string name=\"intensity\">: must be a colour: <rgb "
                   "name=\"intensity\" .../>"},
        BadElement{light("point", "<spectrum name=\"intensity\" value=\"400:1 700\"/>"),
                   "in.xml:4: <spectrum name=\"intensity\">: expected pairs WAVELENGTH:VALUE"},
        BadElement{light("point", "<spectrum name=\"intensity\" value=\"400:1 300:2\"/>"),
                   "expected two or more wavelengths in increasing order"},
        BadElement{light("point", "<spectrum name=\"intensity\" value=\"400:1\"/>"),
                   "expected two or more wavelengths"},
        BadElement{light("point", "<spectrum name=\"intensity\" value=\"1 2\"/>"),
                   "expected one number, or pairs WAVELENGTH:VALUE"},
        BadElement{light("point", "<spectrum name=\"intensity\" filename=\"none.spd\"/>"),
                   "in.xml:4: <spectrum name=\"intensity\">: cannot find 'none.spd'"},
        BadElement{light("point", "<spectrum name=\"intensity\" type=\"irregular\"/>"),
                   "unsupported spectrum type; supported types are: blackbody, d65, srgb, uniform"},
        BadElement{
            light("point", "<spectrum name=\"intensity\" type=\"blackbody\"/>"),
            "in.xml:4: <spectrum type=\"blackbody\" name=\"intensity\">: expected a positive "
            "temperature, for an emission"},
        BadElement{light("point", "<rgb name=\"intensity\" value=\"#ffffff\"/>"),
                   "expected finite numbers, got '#ffffff'"},
        BadElement{light("point", "<rgb name=\"intensity\" value=\"+-1\"/>"),
                   "expected finite numbers, got '+-1'"},
        BadElement{bsdf("diffuse", "<rgb name=\"reflectance\" value=\"0 0 1.1\"/>"),
                   "in.xml:5: <rgb name=\"reflectance\">: [0, 0, 1.1] is not within [0, 1]"},
        BadElement{bsdf("diffuse", "<srgb name=\"reflectance\" value=\"#12345g\"/>"),
                   "in.xml:5: <srgb name=\"reflectance\">: expected a colour of the form #rrggbb, "
                   "got '#12345g'"},
        BadElement{bsdf("diffuse", "<srgb name=\"reflectance\" value=\"0 0 2\"/>"),
                   "2 is not within [0, 1], where the sRGB curve"},
        BadElement{shape("<boolean name=\"flip_normals\" value=\"yes\"/>"),
                   "in.xml:4: <boolean name=\"flip_normals\">: expected true or false, got 'yes'"},
        BadElement{shape("<float name=\"flip_normals\" value=\"1\"/>"),
                   "must be true or false: <boolean"},
        BadElement{shape("<boolean name=\"flip_normals\" value=\"true\"><rgb/></boolean>"),
                   "must not contain elements"}));

INSTANTIATE_TEST_SUITE_P(
    Shapes, BadElements,
    testing::Values(
        BadElement{shape("", "heightfield"),
                   "in.xml:3: <shape type=\"heightfield\">: unsupported shape type; supported "
                   "types are: obj, ply, serialized, rectangle, cube, sphere, disk, cylinder"},
        BadElement{shape("", "ply"), "in.xml:3: <shape type=\"ply\">: needs a filename"},
        BadElement{shape("<string name=\"filename\" value=\"none.ply\"/>", "ply"),
                   "in.xml:3: <shape type=\"ply\">: "},
        BadElement{shape("<float name=\"radius\" value=\"0\"/>", "sphere"),
                   "in.xml:4: <float name=\"radius\">: 0 is not positive"},
        BadElement{shape("<transform name=\"to_world\"><scale x=\"2\"/></transform>", "sphere"),
                   "in.xml:3: <shape type=\"sphere\">: a sphere cannot be sheared or stretched"},
        BadElement{
            shape("<transform name=\"to_world\"><scale x=\"2\"/></transform>", "cylinder"),
            "in.xml:3: <shape type=\"cylinder\">: a cylinder cannot be sheared or stretched; "
            "the transform scales its axes by 2, 1 and 1"},
        BadElement{shape("<point name=\"p1\" x=\"0\" y=\"0\" z=\"0\"/>", "cylinder"),
                   "p0 and p1 must be different points"},
        BadElement{shape("<bsdf type=\"null\"/><emitter type=\"area\"/>"),
                   "in.xml:4: <bsdf type=\"null\">: unsupported on a shape with an emitter"},
        BadElement{shape("<emitter type=\"area\"/><emitter type=\"area\"/>"),
                   "a shape takes at most one emitter and one BSDF"},
        BadElement{shape("<emitter type=\"point\"/>"),
                   "in.xml:4: <emitter type=\"point\">: unsupported emitter type on a shape; "
                   "supported types are: area"},
        BadElement{
            shape(
                "<emitter type=\"area\">\n<texture type=\"bitmap\" name=\"radiance\"/></emitter>"),
            "in.xml:5: <texture type=\"bitmap\" name=\"radiance\">: needs a filename"}));

INSTANTIATE_TEST_SUITE_P(
    Bsdfs, BadElements,
    testing::Values(
        BadElement{bsdf("hair"),
                   "in.xml:4: <bsdf type=\"hair\">: unsupported BSDF type; supported types are: "
                   "diffuse, dielectric, "},
        BadElement{bsdf("normalmap", "<bsdf type=\"diffuse\"/>"),
                   "in.xml:4: <bsdf type=\"normalmap\">: has 1 BSDFs and 0 textures of the map"},
        BadElement{bsdf("bumpmap", checks), "has 0 BSDFs and 1 textures of the map"},
        BadElement{bsdf("bumpmap", std::string(checks) + "<bsdf type=\"normalmap\">" + checks +
                                       "<bsdf type=\"diffuse\"/></bsdf>"),
                   "a map in a map is unsupported"},
        BadElement{bsdf("bumpmap", std::string(checks) +
                                       "<bsdf type=\"mask\"><bsdf type=\"diffuse\"/></bsdf>"),
                   "put the map inside the mask"},
        BadElement{
            bsdf("normalmap", std::string(checks) + "<boolean name=\"flip_invalid_normals\" "
                                                    "value=\"false\"/><bsdf type=\"diffuse\"/>"),
            "<boolean name=\"flip_invalid_normals\">: false is unsupported"},
        BadElement{bsdf("blendbsdf",
                        "<float name=\"weight\" value=\"0.5\"/><bsdf "
                        "type=\"diffuse\"/><bsdf type=\"bumpmap\">" +
                            std::string(checks) + "<bsdf type=\"diffuse\"/></bsdf>"),
                   "a blend of normal or bump maps is unsupported"},
        BadElement{bsdf("twosided", "<bsdf type=\"normalmap\">" + std::string(checks) +
                                        "<bsdf type=\"diffuse\"/></bsdf><bsdf type=\"diffuse\"/>"),
                   "a normal or bump map for one side only is unsupported"},
        BadElement{bsdf("thindielectric", "<float name=\"int_ior\" value=\"0\"/>"),
                   "int_ior and ext_ior must be positive"},
        BadElement{bsdf("diffuse", "<float name=\"alpha\" value=\"0.1\"/>"),
                   "in.xml:5: <float name=\"alpha\">: unknown property of bsdf type 'diffuse'; "
                   "properties are: reflectance"},
        BadElement{
            bsdf("diffuse", "<texture type=\"volume\" name=\"reflectance\"/>"),
            "in.xml:5: <texture type=\"volume\" name=\"reflectance\">: unsupported texture type; "
            "supported types are: bitmap, checkerboard"},
        BadElement{bsdf("diffuse",
                        "<texture type=\"checkerboard\" name=\"reflectance\"><texture "
                        "type=\"bitmap\" name=\"color0\"/></texture>"),
                   "'color0' must be a colour"},
        BadElement{bsdf("diffuse", "<texture type=\"bitmap\" name=\"reflectance\"/>"),
                   "needs a filename"},
        BadElement{bsdf("diffuse",
                        "<texture type=\"bitmap\" name=\"reflectance\"><string name=\"filename\" "
                        "value=\"none.png\"/></texture>"),
                   "in.xml:5: <texture type=\"bitmap\" name=\"reflectance\">: "},
        BadElement{
            bsdf("diffuse",
                 "<texture type=\"bitmap\" name=\"reflectance\"><string name=\"filename\" "
                 "value=\"a.png\"/>\n<string name=\"wrap_mode\" value=\"tile\"/></texture>"),
            "in.xml:6: <string name=\"wrap_mode\">: unknown value 'tile'; values are: repeat, "
            "clamp, mirror"},
        BadElement{bsdf("diffuse",
                        "<texture type=\"bitmap\" name=\"reflectance\"><string name=\"filename\" "
                        "value=\"a.png\"/>\n<transform name=\"to_uv\"><rotate z=\"1\" "
                        "angle=\"30\"/></transform></texture>"),
                   "in.xml:6: <transform name=\"to_uv\">: textures can only be scaled and "
                   "translated"},
        BadElement{bsdf("diffuse",
                        "<rgb name=\"reflectance\" value=\"1\"/><texture type=\"bitmap\" "
                        "name=\"reflectance\"/>"),
                   "duplicate property 'reflectance'"},
        BadElement{bsdf("diffuse", "<texture type=\"bitmap\" name=\"opacity\"/>"),
                   "in.xml:5: <texture type=\"bitmap\" name=\"opacity\">: bsdf type 'diffuse' "
                   "accepts no texture as 'opacity'"},
        BadElement{bsdf("twosided"), "in.xml:4: <bsdf type=\"twosided\">: has 0 BSDFs"},
        BadElement{bsdf("twosided",
                        "<bsdf type=\"diffuse\"/><bsdf type=\"diffuse\"/><bsdf type=\"diffuse\"/>"),
                   "has 3 BSDFs; expected one for both sides, or one for each side"},
        BadElement{bsdf("twosided", "<bsdf type=\"diffuse\"/><bsdf type=\"dielectric\"/>"),
                   "in.xml:5: <bsdf type=\"dielectric\">: already two-sided"},
        BadElement{bsdf("twosided", "<bsdf type=\"thindielectric\"/>"),
                   "in.xml:5: <bsdf type=\"thindielectric\">: already two-sided"},
        BadElement{"<bsdf type=\"blendbsdf\" id=\"a\"><float name=\"weight\" value=\"0\"/><ref "
                   "id=\"a\"/><ref id=\"a\"/></bsdf>" +
                       shape("<ref id=\"a\"/>"),
                   "in.xml:3: <bsdf type=\"blendbsdf\" id=\"a\">: BSDFs are nested deeper than 4"},
        BadElement{bsdf("blendbsdf", "<bsdf type=\"diffuse\"/>"), "has 1 BSDFs; expected two"},
        BadElement{bsdf("blendbsdf", "<bsdf type=\"diffuse\"/><bsdf type=\"diffuse\"/>"),
                   "expected a number from 0 to 1, or one texture, as weight"},
        BadElement{bsdf("blendbsdf",
                        "<float name=\"weight\" value=\"0.5\"/><bsdf type=\"diffuse\"/><bsdf "
                        "type=\"dielectric\"/>"),
                   "only one of the BSDFs is two-sided"},
        BadElement{bsdf("mask"), "has 0 BSDFs; expected one"},
        BadElement{bsdf("mask", "<float name=\"opacity\" value=\"2\"/><bsdf type=\"diffuse\"/>"),
                   "2 is not within [0, 1]"},
        BadElement{bsdf("mask", "<bsdf type=\"mask\"><bsdf type=\"diffuse\"/></bsdf>"),
                   "a mask in a mask is unsupported"},
        BadElement{bsdf("twosided", "<bsdf type=\"mask\"><bsdf type=\"diffuse\"/></bsdf>"),
                   "light passes it, so it cannot be two-sided"},
        BadElement{bsdf("blendbsdf",
                        "<float name=\"weight\" value=\"0.5\"/><bsdf type=\"diffuse\"/><bsdf "
                        "type=\"mask\"><bsdf type=\"diffuse\"/></bsdf>"),
                   "a blend of masks is unsupported"},
        BadElement{bsdf("dielectric", "<string name=\"int_ior\" value=\"butter\"/>"),
                   "in.xml:5: <string name=\"int_ior\">: unknown index of refraction 'butter'; "
                   "give a number or one of: vacuum, helium,"},
        BadElement{bsdf("dielectric", "<float name=\"ext_ior\" value=\"-1\"/>"),
                   "int_ior and ext_ior must be positive"},
        BadElement{
            bsdf("roughdielectric",
                 "<float name=\"int_ior\" value=\"1\"/><float name=\"ext_ior\" value=\"1\"/>"),
            "in.xml:4: <bsdf type=\"roughdielectric\">: eta: 1 does not refract"},
        BadElement{bsdf("roughdielectric", "<texture type=\"bitmap\" name=\"alpha_u\"/>"),
                   "in.xml:4: <bsdf type=\"roughdielectric\">: 'alpha_u' must be a number"},
        BadElement{
            bsdf("roughconductor", "<float name=\"alpha\" value=\"0\"/>"),
            "alpha: [0, 0] is not within [0.0001, 1]; for a smooth surface use type conductor"},
        BadElement{bsdf("roughconductor", "<float name=\"alpha_u\" value=\"0.1\"/>"),
                   "needs both alpha_u and alpha_v"},
        BadElement{
            bsdf("roughconductor",
                 "<float name=\"alpha\" value=\"0.1\"/><float name=\"alpha_u\" value=\"0.1\"/>"),
            "has both alpha and alpha_u or alpha_v"},
        BadElement{bsdf("roughconductor", "<string name=\"distribution\" value=\"phong\"/>"),
                   "unknown value 'phong'; values are: beckmann, ggx"},
        BadElement{
            bsdf("conductor", "<string name=\"material\" value=\"au\"/>"),
            "in.xml:5: <string name=\"material\">: unknown metal 'au'; give eta and k, or one of: "
            "Ag, Al, "},
        BadElement{bsdf("conductor", "<rgb name=\"eta\" value=\"1\"/>"),
                   "expected eta and k together, or a material"},
        BadElement{
            bsdf("conductor", "<rgb name=\"eta\" value=\"0\"/><rgb name=\"k\" value=\"1\"/>"),
            "in.xml:4: <bsdf type=\"conductor\">: eta: [0, 0, 0] is not within"},
        BadElement{bsdf("plastic",
                        "<boolean name=\"nonlinear\" value=\"true\"/><float name=\"int_ior\" "
                        "value=\"1\"/>"),
                   "in.xml:4: <bsdf type=\"plastic\">: eta: "},
        BadElement{
            bsdf("principled", "<float name=\"spec_trans\" value=\"0.5\"/>"),
            "in.xml:4: <bsdf type=\"principled\">: spec_trans: a surface that is only partly"},
        BadElement{bsdf("principled", "<float name=\"sheen\" value=\"2\"/>"),
                   "sheen: 2 is not within [0, 1]"},
        BadElement{bsdf("principled", "<float name=\"eta\" value=\"0.5\"/>"),
                   "0.5 is not within [1, 100]"},
        BadElement{bsdf("roughplastic",
                        "<float name=\"alpha_u\" value=\"0.3\"/>"
                        "<float name=\"alpha_v\" value=\"0.2\"/>"),
                   "alpha_u and alpha_v differ, which is an error in Mitsuba"},
        BadElement{
            shape("<bsdf type=\"roughconductor\"><float name=\"alpha_u\" value=\"0.1\"/><float "
                  "name=\"alpha_v\" value=\"0.2\"/></bsdf>",
                  "disk"),
            "in.xml:4: <bsdf type=\"roughconductor\">: alpha_u and alpha_v differ, but the "
            "tangents of this shape do not match"}));

INSTANTIATE_TEST_SUITE_P(
    Lights, BadElements,
    testing::Values(
        BadElement{light("projector"),
                   "in.xml:3: <emitter type=\"projector\">: unsupported emitter type; supported "
                   "types are: point, spot, directional, constant, envmap, and area on a shape"},
        BadElement{light("envmap"), "needs a filename"},
        BadElement{light("envmap", "<string name=\"filename\" value=\"none.exr\"/>"),
                   "in.xml:3: <emitter type=\"envmap\">: "},
        BadElement{light("spot", "<float name=\"beam_width\" value=\"30\"/>"),
                   "in.xml:3: <emitter type=\"spot\">: inner_degrees: 30 must be less than "
                   "outer_degrees, 20"},
        BadElement{light("spot", "<texture type=\"bitmap\" name=\"texture\"/>"),
                   "in.xml:4: <texture type=\"bitmap\" name=\"texture\">: emitter type 'spot' "
                   "accepts no texture as 'texture'"},
        BadElement{
            light("directional", "<vector name=\"direction\" value=\"0 0 0\"/>"),
            "in.xml:4: <vector name=\"direction\">: expected a direction of positive length"},
        BadElement{
            light("directional",
                  "<vector name=\"direction\" value=\"0 0 1\"/><transform name=\"to_world\"/>"),
            "has both direction and to_world"},
        BadElement{
            light("point",
                  "<point name=\"position\" value=\"0 0 1\"/><transform name=\"to_world\"/>"),
            "has both position and to_world"}));

TEST(MitsubaErrors, OfSensors) {
    const auto sensor = [](const std::string &type, const std::string &content) {
        return [=] {
            parse_mitsuba("<scene version=\"3.0.0\">\n<sensor type=\"" + type + "\">\n" + content +
                          "\n</sensor></scene>");
        };
    };
    const auto film = [&](const std::string &content) {
        return sensor("perspective", "<film type=\"hdrfilm\">\n" + content + "</film>");
    };
    expect_input_error("in.xml: the scene has no sensor",
                       [] { parse_mitsuba("<scene version=\"3.0.0\"/>"); });
    expect_input_error("in.xml:2: <sensor type=\"irradiancemeter\">: unsupported sensor type",
                       sensor("irradiancemeter", ""));
    expect_input_error("needs an aperture_radius", sensor("thinlens", ""));
    expect_input_error("in.xml:2: <sensor type=\"perspective\">: fov: 180 is not within",
                       sensor("perspective", "<float name=\"fov\" value=\"180\"/>"));
    expect_input_error(
        "in.xml:3: <string name=\"fov_axis\">: unknown value 'z'; values are: x, y, diagonal, "
        "smaller, larger",
        sensor("perspective", "<string name=\"fov_axis\" value=\"z\"/>"));
    expect_input_error(
        "in.xml:3: <string name=\"focal_length\">: expected finite numbers, got 'long",
        sensor("perspective", "<string name=\"focal_length\" value=\"longmm\"/>"));
    expect_input_error(
        "has both fov and focal_length",
        sensor("perspective",
               "<float name=\"fov\" value=\"40\"/><string name=\"focal_length\" value=\"50mm\"/>"));
    expect_input_error(
        "in.xml:3: <float name=\"principal_point_offset_x\">: off-centre principal points",
        sensor("perspective", "<float name=\"principal_point_offset_x\" value=\"0.1\"/>"));
    expect_input_error(
        "in.xml:3: <transform name=\"to_world\">: scales by 2, but a camera cannot be scaled",
        sensor("perspective", "<transform name=\"to_world\"><scale value=\"2\"/></transform>"));
    expect_input_error(
        "in.xml:2: <sensor type=\"perspective\">: a camera: its transform mirrors",
        sensor("perspective", "<transform name=\"to_world\"><scale x=\"-1\"/></transform>"));
    for (const char *name : {"crop_width", "crop_height", "crop_offset_x", "crop_offset_y"}) {
        const std::string property = "<integer name=\"" + std::string(name) + "\"";
        expect_input_error("in.xml:4: " + property + ">: expected an integer from 0 to 65536",
                           film(property + " value=\"-3\"/>"));
    }
    // As in Mitsuba, the size of the crop is by default that of the film.
    expect_input_error("in.xml:2: <sensor type=\"perspective\">: crop: the window of",
                       film("<integer name=\"crop_offset_x\" value=\"1\"/>"));
    expect_input_error("in.xml:4: <integer name=\"width\">: expected an integer from 1 to 65536",
                       film("<integer name=\"width\" value=\"0\"/>"));
    expect_input_error("unsupported film type", sensor("perspective", "<film type=\"specfilm\"/>"));
    expect_input_error("second film of this sensor",
                       sensor("perspective", "<film type=\"hdrfilm\"/><film type=\"hdrfilm\"/>"));
}

TEST(MitsubaErrors, OfDocumentsAsAWhole) {
    for (const char *none : {"", "{}", "<a/>", "\x1f\x8b", "<!-- -->", "<?xml version=\"1.0\"?>"}) {
        expect_input_error("in.xml:1: ", [&] { parse_mitsuba(none); });
    }
    expect_input_error(
        "in.xml:1: <scene>: unsupported version ''; expected a version of Mitsuba from 0.4.0 to 3",
        [] { parse_mitsuba("<scene/>"); });
    std::ofstream(testing::TempDir() + "self.xml")
        << "<scene version=\"3.0.0\"><include filename=\"self.xml\"/></scene>";
    expect_input_error("deeper than 16 files",
                       [] { parse_elements("<include filename=\"self.xml\"/>"); });
    std::string open, close;
    for (int i = 0; i < 5000; ++i) {
        open += "<bsdf type=\"twosided\">";
        close += "</bsdf>";
    }
    expect_input_error("nested deeper than 64 levels", [&] { parse_elements(open + close); });
}

/// Returns a scene with most of the supported elements, including references to files.
std::string large_scene() {
    std::ofstream(testing::TempDir() + "square.ply")
        << "ply\nformat ascii 1.0\nelement vertex 4\nproperty float x\nproperty float y\nproperty "
           "float z\n"
           "element face 1\nproperty list uchar int vertex_indices\nend_header\n0 0 0\n1 0 0\n1 1 "
           "0\n0 1 "
           "0\n4 0 1 2 3\n";
    return R"(<?xml version="1.0"?>
<scene version="3.0.0"><!-- all of it -->
<default name="depth" value="8"/><default name="w" value="16"/>
<integrator type="path"><integer name="max_depth" value="$depth"/></integrator>
<sensor type="thinlens"><float name="fov" value="40"/><string name="fov_axis" value="diagonal"/>
<float name="aperture_radius" value="0.1"/><float name="focus_distance" value="5"/>
<transform name="to_world"><lookat origin="0, 0, 5" target="0, 0, 0" up="0, 1, 0"/></transform>
<sampler type="independent"><integer name="sample_count" value="16"/></sampler>
<film type="hdrfilm"><integer name="width" value="$w"/><integer name="height" value="9"/><rfilter type="box"/></film></sensor>
<bsdf type="twosided" id="wall"><bsdf type="diffuse"><rgb name="reflectance" value="0.5, 0.25, 0.125"/></bsdf></bsdf>
<bsdf type="roughconductor" id="steel"><rgb name="eta" value="2, 2, 2"/><rgb name="k" value="3, 3, 3"/><float name="alpha" value="0.2"/></bsdf>
<shape type="rectangle" id="floor"><transform name="to_world"><rotate x="1" angle="-90"/><scale value="4"/></transform><ref id="wall"/></shape>
<shape type="cube"><ref id="steel"/></shape>
<shape type="sphere"><point name="center" x="1" y="1" z="1"/><float name="radius" value="0.5"/><bsdf type="dielectric"><string name="int_ior" value="bk7"/></bsdf></shape>
<shape type="ply"><string name="filename" value="square.ply"/><bsdf type="plastic"/></shape>
<shape type="cylinder"><point name="p0" x="0" y="0" z="0"/><point name="p1" x="0" y="1" z="0"/></shape>
<shape type="disk"><emitter type="area"><rgb name="radiance" value="5, 5, 5"/></emitter></shape>
<emitter type="point"><point name="position" x="0" y="3" z="0"/><rgb name="intensity" value="1, 2, 3"/></emitter>
<emitter type="spot"><float name="cutoff_angle" value="30"/></emitter>
<emitter type="constant"><rgb name="radiance" value="0.1"/></emitter>
</scene>)";
}

/// Returns whether the text loads as a scene. Fails the test if it throws anything but an error of
/// bad input.
bool loads(const std::string &text) {
    try {
        expect_consistent(parse_mitsuba(text).graph());
        return true;
    } catch (const Error &error) {  // any other exception fails the test
        EXPECT_EQ(error.exit_code(), ExitCode::bad_input) << error.what();
        return false;
    }
}

TEST(MitsubaDamage, TruncatedFilesAreErrors) {
    const std::string text = large_scene();
    ASSERT_TRUE(loads(text));
    for (size_t size = 0; size < text.size(); ++size) {
        EXPECT_FALSE(loads(text.substr(0, size))) << size;
    }
}

TEST(MitsubaDamage, DamagedFilesLoadOrAreErrors) {
    const std::string text = large_scene();
    std::minstd_rand random(7);
    constexpr int rounds = 4000;
    int refused = 0;
    for (int i = 0; i < rounds; ++i) {
        std::string damaged = text;
        for (auto edits = 1 + random() % 3; edits > 0; --edits) {
            const size_t at = random() % damaged.size();
            switch (random() % 5) {
                case 0:
                    damaged[at] = static_cast<char>(random() % 256);
                    break;
                case 1:
                    damaged.erase(at, 1 + random() % 40);
                    break;
                case 2:  // digits give valid values more often than arbitrary bytes
                    damaged[at] = "0123456789.-e"[random() % 13];
                    break;
                case 3: {  // replaces a line with another
                    const size_t from = text.find('\n', random() % text.size());
                    const size_t to = text.find('\n', from == std::string::npos ? 0 : from + 1);
                    damaged.insert(at,
                                   from == std::string::npos ? "" : text.substr(from, to - from));
                    break;
                }
                default:
                    damaged.insert(at, text.substr(random() % text.size(), random() % 40));
            }
        }
        refused += loads(damaged) ? 0 : 1;
    }
    EXPECT_GT(refused, rounds / 4);
    EXPECT_LT(refused, rounds) << "some damage must be a valid edit";
}

}  // namespace
}  // namespace rtrays
