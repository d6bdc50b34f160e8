// SPDX-License-Identifier: MIT
// Tests the errors of the scene model: each invalid material, shape, light or camera has a clear
// message.
#include <filesystem>
#include <fstream>

#include "renderer/import/json/scene_json.h"
#include "renderer/testing/scene_builder.h"

namespace rtrays {
namespace {

/// Returns a scene whose line 2 contains the given nodes.
Scene parse(const std::string &nodes) {
    return parse_scene_json(
        R"({"version": 1, "film": {"width": 8, "height": 4}, "nodes": [{"name": "eye", "camera": {"type": "pinhole", "fov": 60, "fov_axis": "x"}},)"
        "\n" +
            nodes + "]}",
        "in.json", "in", testing::TempDir());
}

struct Refused {
    std::string value;
    std::string message;  ///< fragment of the error message
};

void expect_refused(const std::string &before, const std::string &after,
                    const std::vector<Refused> &cases) {
    for (const Refused &c : cases) {
        SCOPED_TRACE(c.value);
        expect_input_error(c.message, [&] { parse(before + c.value + after); });
    }
}

TEST(SceneErrors, Materials) {
    const std::string white = R"("reflectance": [1, 1, 1])";
    expect_refused(
        R"({"name": "a", "geometry": {"type": "sphere"}, "material": )", "}",
        {
            {R"({"type": "phong"})",
             "in.json:2: /nodes/1/material/type (in 'a'): \"phong\" is not one of: lambert, "},
            {R"({"type": "lambert"})",
             "in.json:2: /nodes/1/material: missing key 'reflectance' of the lambert: albedo"},
            {R"({"type": "lambert", "reflectance": [1, 1, 1], "sigma": 0})",
             "/nodes/1/material/sigma: unknown key 'sigma' of the lambert; allowed: bump_map, "
             "bump_map_texture, emission, emission_texture, map_follows_v, map_mirrored_back, "
             "map_shadowing, normal_map, normal_map_texture, opacity, opacity_cutoff, "
             "opacity_texture, reflectance, reflectance_texture, two_sided"},
            {R"({"type": "lambert", "reflectance": [1, 1, 1], "specular_texture": {"file": "a", "encoding": "srgb"}})",
             "unknown key 'specular_texture' of the lambert"},
            {R"({"type": "lambert", "reflectance": [1, 1, 1.5]})",
             "/nodes/1/material/reflectance/2 (in 'a'): 1.5"},
            {R"({"type": "lambert", "reflectance": [1, 1, 1], "emission": [1, -1, 1]})",
             "/nodes/1/material/emission/1"},
            {R"({"type": "lambert", "reflectance": [1, 1, 1], "emission": [1, 1, 1e39]})",
             "/nodes/1/material/emission: emission: [1, 1, 1e+39] is not within [0, 3.402823e+38]"},
            {R"({"type": "lambert", "reflectance": [1, 1, 1], "two_sided": 1})",
             "1 is not of type boolean"},
            {R"({"type": "oren_nayar", "reflectance": [0, 0, 0], "sigma": 30})",
             "sigma: 30 is not within [0, 1.570796] (standard deviation of the slope angles, "
             "radians)"},
            {R"({"type": "glass", "eta": 0})",
             "eta: 0 is not within [0.01, 100] (index of refraction behind"},
            {R"({"type": "glass", "eta": -1.5})", "eta: -1.5 is not within"},
            {R"({"type": "glass", "eta": [1.5, 1.5, 1.5]})", "eta: [1.5,1.5,1.5] is not number"},
            {R"({"type": "oren_nayar", "reflectance": [1, 1, 1]})",
             "missing key 'sigma' of the oren_nayar"},
            {R"({"type": "glass", "eta": 1.5, "roughness": 1e-5})",
             "roughness: [1e-05, 1e-05] is out of range; use 0 for both axes (ideally smooth) or "
             "values within [0.0001, 1]"},
            {R"({"type": "glass", "eta": 1.5, "roughness": [0, 0.5]})",
             "roughness: [0, 0.5] is out of range; use 0 for both"},
            {R"({"type": "glass", "eta": 1.5, "roughness": [0.1, 0.2, 0.3]})",
             "roughness: [0.1,0.2,0.3] is not two numbers"},
            {R"({"type": "glass", "eta": 1.0005, "roughness": 0.5})",
             "eta: 1.0005 does not refract, so it cannot be rough"},
            {R"({"type": "coated_diffuse", "reflectance": [1, 1, 1], "eta": 1})",
             "eta: 1 is not within (1, 3]"},
            {R"({"type": "coated_diffuse", "reflectance": [1, 1, 1], "eta": 2, "roughness": 5e-5})",
             "roughness: 5e-05 is out of range; use 0 (ideally smooth) or a value within"},
            {R"({"type": "composite", "components": [{"bxdf": "coated_lambert", "eta": 1.5,
                "weight": [1, 1, 1], "fresnel": {"type": "dielectric", "eta": 1.5}}]})",
             "component 0: the coat of coated_lambert has its own Fresnel term"},
            {R"({"type": "composite", "components": [{"bxdf": "coated_lambert", "eta": 1.5,
                "weight": [1, 1, 1], "inner_reflectance": 0.6}]})",
             "component_0_inner_reflectance: 0.6 exceeds 0.5963, which the coat reflects back"},
            {R"({"type": "composite", "components": [
                {"bxdf": "ideal_refraction", "weight": [0, 0, 0], "eta": 1.5},
                {"bxdf": "coated_lambert", "eta": 1.5, "weight": [1, 1, 1]}]})",
             "component 1: coated_lambert is opaque, so no other component may refract"},
            {R"({"type": "glass", "eta": 1.5, "distribution": "phong"})",
             "\"phong\" is not one of: ggx, beckmann"},
            {R"({"type": "metal"})", "a metal needs a 'preset', or 'eta' and 'k'"},
            {R"({"type": "metal", "preset": "lead"})",
             "\"lead\" is not one of: silver, gold, copper"},
            {R"({"type": "metal", "preset": "gold", "eta": 1.5})",
             "a metal takes either 'preset', or both 'eta' and 'k'"},
            {R"({"type": "metal", "k": [1, 1, 1]})",
             "a metal takes either 'preset', or both 'eta' and 'k'"},
            {R"({"type": "metal", "eta": [1, 1, 1], "k": [1, -1, 1]})",
             "k: [1, -1, 1] is not within [0, 100]"},
            {R"({"type": "metal", "preset": "gold", "model": "ggx"})",
             "a metal of model 'ggx' needs 'roughness'"},
            {R"({"type": "metal", "preset": "gold", "roughness": 0.1})",
             "a metal of model 'ideal' does not take 'roughness'"},
            {R"({"type": "metal", "preset": "gold", "model": "blinn", "exponent": 0})",
             "exponent: 0 is not within (0, "},
            {R"({"type": "metal", "preset": "gold", "model": "ward", "roughness": 0})",
             "roughness: [0, 0] is not within [0.0001, 1]"},
            {R"({"type": "car_paint", "base": [1, 1, 1], "eta": 1.5, "variant": "new"})",
             "\"new\" is not one of: symmetric, thesis"},
            {R"({"type": "composite"})", "missing key 'components' of the composite"},
            {R"({"type": "composite", "components": []})", "/nodes/1/material/components"},
            {R"({"type": "composite", "eta": 1, "components": [{"bxdf": "lambert", "weight": [1, 1, 1]}]})",
             "unknown key 'eta' of the composite; allowed: bump_map, bump_map_texture, components, "
             "emission, emission_texture, map_follows_v, map_mirrored_back, map_shadowing, "
             "normal_map, normal_map_texture, opacity, opacity_cutoff, opacity_texture, two_sided"},
            {R"({"type": "composite", "components": [{"weight": [1, 1, 1]}]})",
             "/nodes/1/material/components/0 (in 'a'): missing key 'bxdf'"},
            {R"({"type": "composite", "components": [{"bxdf": "lambert"}]})",
             "missing key 'component_0_weight'"},
            {R"({"type": "composite", "components": [{"bxdf": "lambert", "weight": [1, 1, 1], "alpha": 0.5}]})",
             "/nodes/1/material/components/0/alpha: unknown key 'alpha' of the lambert; allowed: "
             "bxdf, "
             "fresnel, mix, mix_inverted, mix_texture, side, weight, "
             "weight_texture"},
            {R"({"type": "composite", "components": [{"bxdf": "ward", "weight": [1, 1, 1]}]})",
             "missing key 'component_0_alpha'"},
            {R"({"type": "composite", "components": [{"bxdf": "ward", "weight": [1, 1, 1], "alpha": 1.5}]})",
             "/nodes/1/material/components/0/alpha: alpha: [1.5, 1.5] is not within [0.0001, 1]"},
            {R"({"type": "composite", "components": [{"bxdf": "lambert", "weight": [1, 1, 1], "fresnel": {"type": "ideal", "eta": 1.5}}]})",
             "/nodes/1/material/components/0/fresnel/eta: unknown key 'eta' of the ideal Fresnel "
             "term"},
            {R"({"type": "composite", "components": [{"bxdf": "ideal_reflection", "weight": [1, 1, 1], "fresnel": {"type": "dielectric", "eta": 1.5, "of_wo": true}}]})",
             "unknown key 'of_wo' of the dielectric Fresnel term"},
            {R"({"type": "composite", "components": [{"bxdf": "ideal_refraction", "weight": [1, 1, 1], "eta": 1.5, "fresnel": {"type": "schlick", "reflectance": [0, 0, 0]}}]})",
             "component 0: a refracting component supports the Fresnel terms ideal, dielectric and "
             "thin_dielectric, not schlick"},
            {R"({"type": "composite", "components": [{"bxdf": "ideal_refraction", "weight": [1, 1, 1], "eta": 1.5, "fresnel": {"type": "thin_dielectric", "eta": 1.5}}]})",
             "component_0_eta: 1.5 bends light, which a thin_dielectric does not; set it to 1"},
            {R"({"type": "composite", "components": [{"bxdf": "ideal_refraction", "weight": [1, 1, 1], "eta": 1.5, "side": "front"}]})",
             "unknown key 'side' of the ideal_refraction"},
            {R"({"type": "composite", "components": [
                 {"bxdf": "lambert", "weight": [0.75, 0.75, 0.75], "side": "front"},
                 {"bxdf": "lambert", "weight": [0.5, 0.5, 0.5], "side": "back"},
                 {"bxdf": "lambert", "weight": [0.5, 0.5, 0.75]}]})",
             "add up to 1.5 in blue, seen from the front"},
            {R"({"type": "composite", "components": [{"bxdf": "ideal_refraction", "weight": [1, 1, 1], "eta": 1.5, "fresnel": {"type": "dielectric", "eta": 1.6}}]})",
             "component_0_fresnel_eta: 1.6 differs from the component's eta, 1.5; omit it"},
            {R"({"type": "composite", "components": [{"bxdf": "microfacet_refraction", "weight": [1, 1, 1], "eta": 1, "alpha": 0.5}]})",
             "component_0_eta: 1 does not refract, so it cannot be rough"},
        });
}

TEST(SceneErrors, EnergyAboveOne) {
    expect_refused(
        R"({"name": "a", "geometry": {"type": "sphere"}, "material": )", "}",
        {
            {R"({"type": "lambert_blinn", "reflectance": [0.5, 0.75, 0.5], "specular": [0.25, 0.375, 0.25], "exponent": 8})",
             "in.json:2: /nodes/1/material: the material returns more light than arrives: its "
             "weights * textures * Fresnel terms add up to 1.125 in green, seen from the front at "
             "an angle of 90 degrees; the largest contribution, 0.75, is from component 0 "
             "(lambert); lower its reflectance"},
            {R"({"type": "composite", "components": [{"bxdf": "lambert", "weight": [0.25, 0.25, 0.25]},
                 {"bxdf": "ideal_reflection", "weight": [0, 0, 0.875], "fresnel": {"type": "schlick", "reflectance": [0, 0, 0]}}]})",
             "add up to 1.125 in blue, seen from the front at an angle of 90 degrees; the largest "
             "contribution, 0.875, is from component 1 (ideal_reflection); lower its "
             "component_1_weight"},
            // F is 1/4 at normal incidence, so the refracted fraction is 3/4.
            {R"({"type": "composite", "components": [{"bxdf": "ideal_reflection", "weight": [0.5, 0.5, 0.5]},
                 {"bxdf": "ideal_refraction", "weight": [1, 1, 1], "eta": 3, "fresnel": {"type": "dielectric", "complement": true}}]})",
             "the largest contribution, 0.75, is from component 1 (ideal_refraction)"},
            // The sum exceeds 1 only from behind, where total internal reflection occurs.
            {R"({"type": "composite", "components": [{"bxdf": "ideal_refraction", "weight": [0.125, 0, 0], "eta": 1.5},
                 {"bxdf": "lambert", "weight": [0.25, 0.25, 0.25], "fresnel": {"type": "dielectric", "eta": 1.5, "complement": true}},
                 {"bxdf": "ideal_reflection", "weight": [0.9, 0.9, 0.9], "fresnel": {"type": "dielectric", "eta": 1.5}}]})",
             "add up to 1.025 in red"},
        });
    for (
        const char *legal :
        {R"({"type": "glass", "eta": 1.5})", R"({"type": "glass", "eta": 0.5, "roughness": 0.5})",
         R"({"type": "plastic", "reflectance": [1, 1, 1], "eta": 1.5})",
         R"({"type": "metal", "preset": "silver"})", R"({"type": "metal", "eta": 1, "k": 0})",
         R"({"type": "metal", "eta": 0.01, "k": 100, "fresnel": "approximate"})",
         R"({"type": "car_paint", "base": [1, 1, 1], "eta": 1.6, "variant": "thesis"})",
         R"({"type": "lambert_blinn", "reflectance": [0.7, 0.7, 0.7], "specular": [0.3, 0.3, 0.3], "exponent": 8})"}) {
        EXPECT_NO_THROW(
            parse(std::string(R"({"name": "a", "geometry": {"type": "sphere"}, "material": )") +
                  legal + "}"))
            << legal;
    }
}

class TexturedMaterials : public WithImages {};

TEST_F(TexturedMaterials, EnergyIsCheckedWithThemAndOnEdits) {
    std::ofstream(testing::TempDir() + "energy.pfm", std::ios::binary)
        << "PF\n1 1\n-1.0\n"
        << std::string("\0\0\0\0\0\0\0\x3f\0\0\0\x40", 12);  // 0, 0.5, 2
    const auto textured = [](const char *weight) {
        return std::string(
                   R"({"name": "a", "geometry": {"type": "sphere"}, "material": {"type": "lambert", "reflectance": )") +
               weight +
               R"(, "reflectance_texture": {"file": "energy.pfm", "encoding": "linear"}}})";
    };
    expect_input_error("add up to 2 in blue", [&] { parse(textured("[1, 1, 1]")); });
    Scene scene = parse(textured("[1, 1, 0.5]"));
    expect_input_error("'a.reflectance': the material returns more light than arrives",
                       [&] { scene.set_property("a.reflectance", "1,1,0.6"); });
    EXPECT_EQ(scene.materials().component[0].weight, Rgb(1, 1, 0.5f));
}

TEST_F(TexturedMaterials, OpacityIsAtMostOne) {
    std::ofstream(testing::TempDir() + "bright.pfm", std::ios::binary)
        << "PF\n1 1\n-1.0\n"
        << std::string("\0\0\0\x40\0\0\0\x40\0\0\0\x40", 12);  // 2, 2, 2
    const auto textured = [](const char *opacity) {
        return std::string(
                   R"({"name": "a", "geometry": {"type": "sphere"}, "material": {"type": "mirror", "reflectance": [1, 1, 1], "opacity": )") +
               opacity + R"(, "opacity_texture": {"file": "bright.pfm", "encoding": "linear"}}})";
    };
    expect_input_error("exceeds 1", [&] { parse(textured("0.6")); });
    Scene scene = parse(textured("0.5"));
    expect_input_error("opacity: 0.75 times the brightest texel of its texture, 2, exceeds 1",
                       [&] { scene.set_property("a.opacity", "0.75"); });
    expect_input_error("opacity", [&] { parse(textured("1.5")); });
}

TEST_F(TexturedMaterials, RoughnessIsAtMostOne) {
    std::ofstream(testing::TempDir() + "rough.pfm", std::ios::binary)
        << "PF\n1 1\n-1.0\n"
        << std::string("\0\0\0\x40\0\0\0\x40\0\0\0\x40", 12);  // 2, 2, 2
    const auto textured = [](const std::string &keys) {
        return R"({"name": "a", "geometry": {"type": "sphere"}, "material": {"type": "glass", "eta": 1.5, )" +
               keys + R"("roughness_texture": {"file": "rough.pfm", "encoding": "linear"}}})";
    };
    expect_input_error("a smooth surface takes no texture of its roughness",
                       [&] { parse(textured("")); });
    expect_input_error("the roughness 0.6 times that of the brightest texel of its texture, 2",
                       [&] { parse(textured(R"("roughness": 0.6, )")); });
    expect_input_error(
        "the roughness 0.5 times that of the brightest texel of its texture, 4",
        [&] { parse(textured(R"("roughness": 0.5, "roughness_squared": true, )")); });
    Scene scene = parse(textured(R"("roughness": 0.5, )"));
    EXPECT_EQ(scene.materials().component[1].roughness_texture, 0u);
    expect_input_error("exceeds 1", [&] { scene.set_property("a.roughness", "0.75"); });
}

TEST_F(TexturedMaterials, NormalAndBumpMapsNeedTriangles) {
    std::ofstream(testing::TempDir() + "one.ppm", std::ios::binary) << "P6 1 1 255\n"
                                                                    << "abc";
    const auto with = [](const char *geometry, const char *keys) {
        return std::string(R"({"name": "a", "geometry": {"type": ")") + geometry +
               R"("}, "material": {"type": "mirror", "reflectance": [1, 1, 1], )" + keys + "}}";
    };
    const char *normals = R"("normal_map_texture": {"file": "one.ppm", "encoding": "linear"})";
    const char *heights = R"("bump_map_texture": {"file": "one.ppm", "encoding": "linear"})";
    for (const char *map : {normals, heights}) {
        expect_input_error("sphere 'a': material 'a' has a normal or bump map, but only triangles",
                           [&] { parse(with("sphere", map)); });
        parse(with("rectangle", map));
    }
    expect_input_error("has normal_map_texture and bump_map_texture; remove one of them", [&] {
        parse(with("rectangle", (std::string(normals) + ", " + heights).c_str()));
    });
    expect_input_error("a bump map cannot be mirrored beyond its edges", [&] {
        parse(with("rectangle", R"("bump_map_texture": {"file": "one.ppm", "encoding": "linear",
                                                        "wrap": "mirror"})"));
    });
    // Without a texture there is no map.
    parse(with("sphere", R"("normal_map": 2, "bump_map": 3)"));
}

TEST(SceneErrors, Geometry) {
    expect_refused(
        R"({"name": "a", "material": {"type": "lambert", "reflectance": [0, 0, 0]}, "geometry": )",
        "}",
        {
            {R"({"type": "torus"})",
             "/nodes/1/geometry/type (in 'a'): \"torus\" is not one of: mesh, file, rectangle, "
             "box, sphere"},
            {R"({"type": "sphere", "radius": 0})", "/nodes/1/geometry/radius"},
            {R"({"type": "sphere", "radius": 1e39})",
             "radius: 1e+39 is not within (0, 3.402823e+38] (radius, scene units)"},
            {R"({"type": "sphere", "height": 1})",
             "unknown key 'height' of the sphere; allowed: radius"},
            {R"({"type": "rectangle", "radius": 1})",
             "unknown key 'radius' of the rectangle; allowed: "},
            {R"({"type": "ellipsoid", "radii": [1, 0, 1]})", "radii: [1, 0, 1] is not within"},
            {R"({"type": "cylinder", "radius": 1})",
             "/nodes/1/geometry: missing key 'height' of the cylinder"},
            {R"({"type": "hyperboloid", "radius": 1, "height": 1, "flare": 1e9})",
             "flare: 1000000000 is not within"},
            {R"({"type": "julia", "constant": [0, 0, 0]})", "/nodes/1/geometry/constant"},
            {R"({"type": "julia", "constant": [3, 3, 0, 0]})", "constant: its length, 4.24"},
            {R"({"type": "julia", "constant": [0, 0, 0, 0], "iterations": 0})",
             "iterations: 0 is not within [1, 100]"},
            {R"({"type": "julia", "constant": [0, 0, 0, 0], "iterations": 1.5})",
             "1.5 is not of type integer"},
            {R"({"type": "mesh", "vertices": [[0,0,0],[1,0,0],[0,1,0]], "polygons": [[0,1,2]], "normals": [[0,0,1]]})",
             "mesh 'a': 1 normals for 3 vertices; give one per vertex, or none"},
            {R"({"type": "mesh", "vertices": [[0,0,0],[1,0,0],[0,1,0]], "polygons": [[0,1,2]], "uvs": [[0,0],[0,0],[0,0],[0,0]]})",
             "mesh 'a': 4 texture coordinates for 3 vertices"},
            {R"({"type": "mesh", "vertices": [[0,0,0],[1,0,0],[0,1,0]], "polygons": [[0,1,2]], "normals": [[0,0,1],[0,0,0],[0,0,1]]})",
             "mesh 'a': normal 1 has no direction: [0, 0, 0]"},
            {R"({"type": "mesh", "vertices": [[0,0,0],[1,0,0],[0,1,0]], "polygons": [[0,1,2]], "uvs": [[0,0],[0,0],[0,1e7]]})",
             "mesh 'a': texture coordinate 2 is not within +-1e6: [0, 10000000]"},
            {R"({"type": "mesh", "vertices": [[0,0,0],[1,0,0],[0,1,0]], "polygons": [[0,1,2]], "radius": 1})",
             "unknown key 'radius' of the mesh; allowed: colours, normals, polygons, uvs, "
             "vertices"},
        });
    expect_refused(
        R"({"name": "a", "material": {"type": "lambert", "reflectance": [0, 0, 0]}, "geometry": {"type": "sphere"}, )",
        "}",
        {{R"("transform": [{"scale": [1e39, 1, 1]}])", "sphere 'a' is beyond the range of float"},
         {R"("transform": [{"scale": [1, 1, 1e-39]}])", "sphere 'a' is beyond the range of float"},
         {R"("transform": [{"scale": [1, 2, 1]}], "light": {"type": "diffuse_area", "radiance": [1, 1, 1]})",
          "light 'a': an emitting sphere must not be stretched"}});
    expect_input_error("cylinder 'a' has no material", [] {
        parse(R"({"name": "a", "geometry": {"type": "cylinder", "radius": 1, "height": 1}})");
    });
}

TEST(SceneErrors, Lights) {
    expect_refused(
        R"({"name": "a", "light": )", "}",
        {
            {R"({"type": "laser"})",
             "\"laser\" is not one of: diffuse_area, point, spot, directional, dome, environment"},
            {R"({"type": "point", "radiance": [1, 1, 1]})",
             "unknown key 'radiance' of the point; allowed: intensity"},
            {R"({"type": "point"})",
             "/nodes/1/light: missing key 'intensity' of the point: radiant intensity, W / sr"},
            {R"({"type": "dome", "radiance": [0, 0, -1]})", "/nodes/1/light/radiance/2"},
            {R"({"type": "spot", "intensity": [1, 1, 1], "inner_degrees": 30, "outer_degrees": 30})",
             "inner_degrees: 30 must be less than outer_degrees, 30"},
            {R"({"type": "spot", "intensity": [1, 1, 1], "inner_degrees": 30, "outer_degrees": 91})",
             "outer_degrees: 91 is not within [0, 90]"},
            {R"({"type": "environment", "scale": 2})", "missing key 'file' of the environment"},
            {R"({"type": "environment", "file": "none.hdr"})", "in.json:2: /nodes/1/light/file: "},
            {R"({"type": "environment", "file": "none.hdr", "scale": -1})",
             "scale: [-1, -1, -1] is not within"},
        });
    const std::string black = R"("material": {"type": "lambert", "reflectance": [0, 0, 0]}, )";
    expect_refused(
        R"({"name": "a", )" + black, "}",
        {{R"("geometry": {"type": "plane"}, "light": {"type": "diffuse_area", "radiance": [1, 1, 1]})",
          "light 'a': among shapes only spheres and discs can emit; use one of these or a mesh"},
         {R"("geometry": {"type": "sphere", "radius": 1e30}, "transform": [{"translate": [1e39, 0, 0]}])",
          "sphere 'a' is beyond"},
         {R"("light": {"type": "point", "intensity": [1, 1, 1]}, "transform": [{"translate": [1e39, 0, 0]}])",
          "light 'a' is beyond the range of float"}});
    expect_input_error("light 'a': its geometry already emits through material 'a'", [] {
        parse(
            R"({"name": "a", "geometry": {"type": "sphere"}, "light": {"type": "diffuse_area", "radiance": [1, 1, 1]},
                  "material": {"type": "lambert", "reflectance": [0, 0, 0], "emission": [0, 0, 1]}})");
    });
    expect_input_error("light 'a': among shapes only spheres and discs can emit", [] {
        parse(R"({"name": "a", "geometry": {"type": "cone", "radius": 1, "height": 1},
                  "material": {"type": "lambert", "reflectance": [0, 0, 0], "emission": [0, 0, 1]}})");
    });
}

TEST(SceneErrors, Cameras) {
    const auto camera = [](const std::string &keys) {
        return R"({"version": 1, "film": {"width": 1, "height": 1}, "nodes": [{"name": "eye", "camera": {"type": "thin_lens",
                   "fov": 60, "fov_axis": "x")" +
               keys + "}}]}";
    };
    for (const Refused &c :
         {Refused{"", "missing key 'aperture_radius' of the thin_lens"},
          Refused{R"(, "aperture_radius": 1)", "missing key 'focus_distance' of the thin_lens"},
          Refused{R"(, "aperture_radius": -1, "focus_distance": 1)",
                  "/nodes/0/camera/aperture_radius"},
          Refused{R"(, "aperture_radius": 1, "focus_distance": 0)",
                  "/nodes/0/camera/focus_distance"},
          Refused{R"(, "aperture_radius": 1, "focus_distance": 1e39)",
                  "focus_distance: 1e+39 is not"}}) {
        expect_input_error(c.message, [&] { parse_scene_json(camera(c.value), "in.json", "in"); });
    }
    expect_input_error("unknown key 'aperture_radius' of the pinhole", [] {
        parse(
            R"({"name": "b", "camera": {"type": "pinhole", "fov": 60, "fov_axis": "x", "aperture_radius": 1}})");
    });
}

}  // namespace
}  // namespace rtrays
