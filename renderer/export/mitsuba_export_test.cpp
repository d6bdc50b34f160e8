// SPDX-License-Identifier: MIT
// Tests that scenes exported for Mitsuba and imported again are unchanged.
#include <algorithm>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <map>
#include <set>

#include "renderer/base/files.h"
#include "renderer/export/mitsuba_xml.h"
#include "renderer/import/json/scene_json.h"
#include "renderer/import/load_scene.h"
#include "renderer/scene/cores/coat.h"
#include "renderer/scene/cores/texture.h"
#include "renderer/scene/stores/tessellation.h"
#include "renderer/testing/mitsuba_scenes.h"

namespace rtrays {
namespace {

const std::string scenes = RTRAYS_SCENES;

/// Relative tolerance for doubles that went through matrix products and back.
constexpr double rounding = 1e-12;

class MitsubaExport : public WithImages {
  protected:
    void SetUp() override {
        WithImages::SetUp();
        std::filesystem::remove_all(folder_);
        std::filesystem::create_directories(folder_);
    }

    Scene through_mitsuba(const Scene &scene) {
        export_mitsuba_xml(scene, folder_ / "out.xml");
        const Notices silent;
        return load_scene((folder_ / "out.xml").string());
    }

    std::filesystem::path folder_ = std::filesystem::path(testing::TempDir()) / "mitsuba_export";
};

template <typename Matrix>
void expect_close(const Matrix &a, const Matrix &b, double tolerance) {
    EXPECT_LE((a - b).cwiseAbs().maxCoeff(), tolerance * std::max(1.0, a.cwiseAbs().maxCoeff()))
        << a << "\n"
        << b;
}

void expect_same_image(const TextureImage &a, const TextureImage &b) {
    EXPECT_EQ(a.width, b.width);
    EXPECT_EQ(a.height, b.height);
    EXPECT_EQ(a.srgb, b.srgb);
    EXPECT_EQ(a.bytes, b.bytes);
    EXPECT_EQ(a.floats, b.floats);
}

void expect_same_texture(const TextureArrays &a, uint32_t i, const TextureArrays &b, uint32_t j) {
    expect_same_image(*a.image[i], *b.image[j]);
    EXPECT_EQ(a.filter[i], b.filter[j]);
    EXPECT_EQ(a.wrap[i], b.wrap[j]);
    expect_close(a.uv_scale[i], b.uv_scale[j], rounding);
    expect_close(a.uv_offset[i], b.uv_offset[j], rounding);
}

void expect_same_material(const SceneArrays &a, uint32_t i, const SceneArrays &b, uint32_t j) {
    ASSERT_EQ(a.materials.component_count[i], b.materials.component_count[j]);
    const MaterialOpacity &before = a.materials.opacity[i], &after = b.materials.opacity[j];
    EXPECT_EQ(before.value, after.value);
    EXPECT_EQ(before.cutoff, after.cutoff);
    ASSERT_EQ(before.texture == no_index, after.texture == no_index);
    if (before.texture != no_index) {
        expect_same_texture(a.textures, before.texture, b.textures, after.texture);
    }
    const NormalMap &map = a.materials.normal_map[i], &map_after = b.materials.normal_map[j];
    ASSERT_EQ(map.kind, map_after.kind);
    if (map.kind != NormalMap::Kind::none) {
        EXPECT_EQ(map.shadowing, map_after.shadowing);
        EXPECT_TRUE(a.materials.two_sided[i] == 0 || map.mirrored_back == map_after.mirrored_back);
        if (map.scale == map_after.scale) {
            expect_same_texture(a.textures, map.texture, b.textures, map_after.texture);
        } else {
            EXPECT_EQ(map.kind, NormalMap::Kind::normals) << "the texels have the factor";
        }
    }
    const uint32_t emission = a.materials.emission_texture[i];
    ASSERT_EQ(emission == no_index, b.materials.emission_texture[j] == no_index);
    bool refracts = false;
    for (uint32_t c = 0; c < a.materials.component_count[i]; ++c) {
        const BxdfComponent &p = a.materials.component[a.materials.first_component[i] + c];
        const BxdfComponent &q = b.materials.component[b.materials.first_component[j] + c];
        EXPECT_EQ(p.kind, q.kind);
        EXPECT_EQ(p.weight, q.weight);
        EXPECT_EQ(p.fresnel, q.fresnel);
        EXPECT_EQ(p.complement, q.complement);
        EXPECT_EQ(p.eta, q.eta);
        EXPECT_EQ(p.k, q.k);
        EXPECT_EQ(p.alpha, q.alpha);
        EXPECT_EQ(p.distribution, q.distribution);
        EXPECT_EQ(p.side, q.side);
        ASSERT_EQ(p.texture == no_index, q.texture == no_index);
        if (p.texture != no_index) {
            expect_same_texture(a.textures, p.texture, b.textures, q.texture);
        }
        refracts = refracts || p.kind == BxdfComponent::Kind::ideal_refraction ||
                   p.kind == BxdfComponent::Kind::microfacet_refraction;
    }
    // Both sides of a refracting material are visible in any case.
    EXPECT_TRUE(refracts || a.materials.two_sided[i] == b.materials.two_sided[j]);
}

void expect_same_light(const LightArrays &a, uint32_t i, const LightArrays &b, uint32_t j) {
    ASSERT_EQ(a.kind[i], b.kind[j]);
    EXPECT_EQ(a.radiance[i], b.radiance[j]);
    EXPECT_NEAR(a.inner_angle[i], b.inner_angle[j], rounding);
    EXPECT_NEAR(a.outer_angle[i], b.outer_angle[j], rounding);
    // For a light with an axis, only the axis and the position of its pose matter.
    expect_close(Eigen::Matrix<double, 4, 2>(a.world_from_light[i].rightCols<2>()),
                 Eigen::Matrix<double, 4, 2>(b.world_from_light[j].rightCols<2>()), rounding);
    ASSERT_EQ(a.image[i] == nullptr, b.image[j] == nullptr);
    if (a.image[i] != nullptr) {
        expect_same_image(*a.image[i], *b.image[j]);
        expect_close(a.world_from_light[i], b.world_from_light[j], rounding);
    }
}

/// Expects that two scenes give the same image, apart from rounding of doubles and the order of
/// materials and lights.
void expect_same_scene(const Scene &first, const Scene &second) {
    const SceneArrays &a = first.arrays();
    const SceneArrays &b = second.arrays();
    const auto camera = static_cast<size_t>(first.active_camera());
    EXPECT_EQ(first.film_width(), second.film_width());
    EXPECT_EQ(first.film_height(), second.film_height());
    expect_close(a.cameras.world_from_camera[camera], b.cameras.world_from_camera[0], rounding);
    EXPECT_NEAR(a.cameras.fov[camera], b.cameras.fov[0], rounding);
    ASSERT_EQ(a.cameras.is_orthographic(camera), b.cameras.is_orthographic(0));
    if (a.cameras.is_orthographic(camera)) {  // on a square film, so the axis has no effect
        EXPECT_EQ(first.film_width(), first.film_height());
        EXPECT_NEAR(a.cameras.view_size[camera], b.cameras.view_size[0], rounding);
    } else {
        EXPECT_EQ(a.cameras.fov_axis[camera], b.cameras.fov_axis[0]);
    }
    EXPECT_EQ(a.cameras.aperture_radius[camera], b.cameras.aperture_radius[0]);

    ASSERT_EQ(a.meshes.name, b.meshes.name);
    EXPECT_EQ(a.meshes.position, b.meshes.position);
    EXPECT_EQ(a.meshes.triangle, b.meshes.triangle);
    EXPECT_EQ(a.meshes.uv, b.meshes.uv);
    ASSERT_EQ(a.meshes.normal.size(), b.meshes.normal.size());
    for (size_t i = 0; i < a.meshes.normal.size(); ++i) {  // normalised again
        EXPECT_LE((a.meshes.normal[i] - b.meshes.normal[i]).cwiseAbs().maxCoeff(), 1.2e-7f);
    }
    ASSERT_EQ(a.shapes.name, b.shapes.name);
    EXPECT_EQ(a.shapes.kind, b.shapes.kind);
    for (uint32_t i = 0; i < a.shapes.name.size(); ++i) {
        expect_close(a.shapes.world_from_object[i], b.shapes.world_from_object[i], rounding);
        expect_same_material(a, a.shapes.material[i], b, b.shapes.material[i]);
    }
    for (uint32_t i = 0; i < a.meshes.name.size(); ++i) {
        expect_same_material(a, a.meshes.material[i], b, b.meshes.material[i]);
    }
    std::map<std::string, uint32_t> named;
    ASSERT_EQ(a.lights.name.size(), b.lights.name.size());
    for (uint32_t i = 0; i < b.lights.name.size(); ++i) {
        named[b.lights.name[i]] = i;
    }
    for (uint32_t i = 0; i < a.lights.name.size(); ++i) {
        ASSERT_EQ(named.count(a.lights.name[i]), 1u) << a.lights.name[i];
        expect_same_light(a.lights, i, b.lights, named[a.lights.name[i]]);
    }
}

TEST_F(MitsubaExport, TheCornellBoxComesBack) {
    const Scene box = load_scene(scenes + "/cornell_box/scene.json");
    const Scene back = through_mitsuba(box);
    expect_same_scene(box, back);
    const std::string xml = read_file(folder_ / "out.xml");
    EXPECT_NE(xml.find("<default name=\"max_depth\" value=\"-1\" />"), std::string::npos) << xml;
    // A second round trip must not change a bit.
    EXPECT_EQ(through_mitsuba(back).hash(), back.hash());
}

/// Feature scenes with a shape that is exported as a mesh.
const std::set<std::string> tessellated_shapes = {"cone", "ellipsoid", "hyperboloid", "paraboloid"};

/// What Mitsuba has not got of them.
const std::map<std::string, const char *> &beyond_mitsuba() {
    static const std::map<std::string, const char *> reasons = {
        {"blinn_64", "no BSDF for blinn * conductor;"},
        {"car_paint_thesis",
         "no BSDF for ideal_reflection * dielectric + lambert * (1 - dielectric of wo);"},
        {"coated_diffuse", "of the light below it back"},
        {"conductor_approximate", "no BSDF for ideal_reflection * conductor_approximate;"},
        {"julia", "no julia"},
        {"lambert_blinn", "no BSDF for lambert + blinn;"},
        {"mixture", "the export to Mitsuba writes no mixture by a texture"},
        {"normal_map", "Mitsuba's normal maps does not follow mirrored texture coordinates"},
        {"opacity", "material 'cut_out': Mitsuba has no cutoff of an opacity texture"},
        {"oren_nayar_010", "no BSDF for oren_nayar;"},
        {"plane", "'ground': Mitsuba has no plane, and it cannot be tessellated"},
        {"principled",
         "no BSDF for disney_clearcoat * schlick + microfacet_reflection * dielectric + "
         "disney_diffuse;"},
        {"refraction_13", "no BSDF for ideal_refraction;"},
        {"rough_plastic",
         "no BSDF for microfacet_reflection * dielectric + lambert * (1 - dielectric);"},
        {"schlick", "no BSDF for ideal_reflection * schlick;"},
        {"vertex_colours", "Mitsuba's plastics need the mean of their textures"},
        {"ward_010",
         "'object': material 'object': Mitsuba has no BSDF for ward; supported are: lambert; "},
        {"ward_anisotropic", "no BSDF for ward * conductor;"},
        {"ward_original", "no BSDF for ward_original;"},
    };
    return reasons;
}

TEST_F(MitsubaExport, ScenesOfSingleFeaturesComeBackOrAreErrors) {
    int back = 0;
    for (const auto &entry : std::filesystem::directory_iterator(scenes + "/features")) {
        if (entry.path().extension() != ".json") {
            continue;
        }
        const std::string name = entry.path().stem().string();
        SCOPED_TRACE(name);
        const Scene scene = load_scene(entry.path().string());
        const auto reason = beyond_mitsuba().find(name);
        if (reason != beyond_mitsuba().end()) {
            expect_input_error(reason->second, [&] { through_mitsuba(scene); });
            continue;
        }
        if (tessellated_shapes.count(name) > 0 || name == "textured_light") {
            continue;  // tested below
        }
        try {
            expect_same_scene(scene, through_mitsuba(scene));
            ++back;
        } catch (const Error &error) {  // other scenes with the same unsupported features
            EXPECT_NE(std::string(error.what()).find("Mitsuba has no"), std::string::npos)
                << error.what();
        }
    }
    EXPECT_GE(back, 33);
}

// A texture of Mitsuba has no factor, so the texels are multiplied by the emission.
TEST_F(MitsubaExport, TexturesOfEmissionComeBackWithTheirFactor) {
    const Scene scene = load_scene(scenes + "/features/textured_light.json");
    const Scene back = through_mitsuba(scene);
    const auto image_of = [](const Scene &of, const std::string &light) {
        const SceneArrays &arrays = of.arrays();
        const auto i = static_cast<size_t>(
            std::find(arrays.lights.name.begin(), arrays.lights.name.end(), light) -
            arrays.lights.name.begin());
        const uint32_t mesh = arrays.lights.mesh.at(i);
        const uint32_t material = mesh != no_index ? arrays.meshes.material[mesh]
                                                   : arrays.shapes.material[arrays.lights.shape[i]];
        const uint32_t texture = arrays.materials.emission_texture.at(material);
        return std::pair(arrays.textures.image.at(texture), arrays.lights.radiance[i]);
    };
    for (const char *light : {"screen", "lantern"}) {
        const auto [bytes, radiance] = image_of(scene, light);
        const auto [floats, one] = image_of(back, light);
        EXPECT_EQ(one, Rgb(1, 1, 1));
        ASSERT_EQ(floats->floats.size(), bytes->bytes.size());
        for (size_t k = 0; k < bytes->bytes.size(); ++k) {
            const double texel = srgb_decoded(bytes->bytes[k] / 255.0);
            const auto factor = static_cast<double>(radiance[static_cast<Eigen::Index>(k % 3)]);
            ASSERT_NEAR(floats->floats[k], factor * texel, 1e-6 * factor);
        }
    }
}

TEST_F(MitsubaExport, ShapesThatMitsubaLacksComeBackAsMeshes) {
    for (const std::string &name : tessellated_shapes) {
        SCOPED_TRACE(name);
        const Scene scene = load_scene(scenes + "/features/" + name + ".json");
        const Scene back = through_mitsuba(scene);
        const ShapeArrays &shapes = scene.arrays().shapes;
        const MeshArrays &meshes = back.meshes();
        const auto shape = static_cast<size_t>(
            std::find(shapes.name.begin(), shapes.name.end(), "object") - shapes.name.begin());
        const auto mesh = static_cast<size_t>(
            std::find(meshes.name.begin(), meshes.name.end(), "object") - meshes.name.begin());
        ASSERT_LT(shape, shapes.name.size());
        ASSERT_LT(mesh, meshes.name.size());
        const MeshArrays wanted = tessellated(shapes, static_cast<uint32_t>(shape));
        ASSERT_EQ(meshes.vertex_count[mesh], wanted.vertex_count[0]);
        ASSERT_EQ(meshes.triangle_count[mesh], wanted.triangle_count[0]);
        for (uint32_t i = 0; i < wanted.vertex_count[0]; ++i) {
            ASSERT_EQ(meshes.position[meshes.first_vertex[mesh] + i], wanted.position[i]);
            ASSERT_LE((meshes.normal[meshes.first_vertex[mesh] + i] - wanted.normal[i])
                          .cwiseAbs()
                          .maxCoeff(),
                      1.2e-7f);
            ASSERT_EQ(meshes.uv[meshes.first_vertex[mesh] + i], wanted.uv[i]);
        }
        expect_same_material(scene.arrays(), shapes.material[shape], back.arrays(),
                             meshes.material[mesh]);
    }
}

TEST_F(MitsubaExport, CropsComeBack) {
    Scene scene = load_scene(scenes + "/cornell_box/scene.json");
    scene.set_crop({10, 20, 30, 40});
    const Scene back = through_mitsuba(scene);
    EXPECT_EQ(back.film_width(), scene.film_width());
    ASSERT_TRUE(back.crop());
    EXPECT_EQ(back.crop()->x, 10);
    EXPECT_EQ(back.crop()->y, 20);
    EXPECT_EQ(back.crop()->width, 30);
    EXPECT_EQ(back.crop()->height, 40);
}

TEST_F(MitsubaExport, ColoursOfVerticesComeBack) {
    // The normals of the first triangle oppose it, so that its vertices are written twice.
    const auto scene = [](const std::string &reflectance) {
        return parse_scene_json(
            R"({"version": 1, "film": {"width": 8, "height": 4}, "nodes": [
            {"name": "eye", "camera": {"type": "pinhole", "fov": 60, "fov_axis": "x"}},
            {"name": "tile", "geometry": {"type": "mesh", "polygons": [[0, 1, 2], [2, 1, 3]],
             "vertices": [[0, 0, 0], [1, 0, 0], [0, 1, 0], [1, 1, 0]],
             "normals": [[0, 0, -1], [0, 0, -1], [0, 0, -1], [0, 0, 9]],
             "colours": [[1, 0.5, 0], [0.25, 1, 0], [0, 0, 1], [1, 1, 1]]},
             "material": {"type": "lambert", "reflectance": )" +
                reflectance +
                R"(, "reflectance_texture": {"vertex_colours": true, "filter": "nearest"}}}]})",
            "in.json", "in", scenes);
    };
    const Notices silent;
    const Scene painted = scene("[1, 1, 1]");
    const Scene back = through_mitsuba(painted);
    expect_same_material(painted.arrays(), 0, back.arrays(), 0);
    EXPECT_TRUE(back.arrays().textures.has_vertex_colours(0));
    for (size_t i = 0; i < 6; ++i) {
        const MeshArrays &a = painted.meshes(), &b = back.meshes();
        EXPECT_EQ(a.colour[a.triangle[i / 3][i % 3]], b.colour[b.triangle[i / 3][i % 3]]) << i;
    }
    const Scene grey = through_mitsuba(scene("[0.5, 0.5, 0.5]"));
    EXPECT_EQ(grey.arrays().textures.image[0]->floats, std::vector<float>(3, 0.5f));
    expect_input_error("Mitsuba multiplies vertex colours by one number only",
                       [&] { through_mitsuba(scene("[0.5, 0.5, 0.6]")); });
}

TEST_F(MitsubaExport, TextureWeightsGoIntoTheTexels) {
    const Scene scene =
        parse_scene_json(R"({"version": 1, "film": {"width": 8, "height": 4}, "nodes": [
        {"name": "eye", "camera": {"type": "pinhole", "fov": 60, "fov_axis": "x"}},
        {"name": "tile", "geometry": {"type": "rectangle"}, "material": {"type": "plastic", "eta": 1.5,
         "reflectance": [0.5, 1, 1], "reflectance_texture": {"file": "assets/checker.png", "encoding": "srgb"}}}]})",
                         "in.json", "in", scenes + "/features");
    const Scene back = through_mitsuba(scene);
    const BxdfComponent &before = scene.materials().component[1];
    const BxdfComponent &after = back.materials().component[1];
    const TextureImage &bytes = *scene.arrays().textures.image[before.texture];
    const TextureImage &floats = *back.arrays().textures.image[after.texture];
    ASSERT_EQ(floats.floats.size(), bytes.bytes.size());
    for (size_t i = 0; i < floats.floats.size(); ++i) {
        const auto channel = static_cast<Eigen::Index>(i % 3);
        EXPECT_NEAR(after.weight[channel] * floats.floats[i],
                    before.weight[channel] * srgb_decoded(bytes.bytes[i] / 255.0), 1e-6);
    }
}

TEST_F(MitsubaExport, RoughnessGoesIntoTheTexels) {
    const auto scene = [](const char *squared) {
        return parse_scene_json(
            R"({"version": 1, "film": {"width": 8, "height": 4}, "nodes": [
        {"name": "eye", "camera": {"type": "pinhole", "fov": 60, "fov_axis": "x"}},
        {"name": "tile", "geometry": {"type": "rectangle"}, "material": {"type": "metal", "preset": "gold", "model": "ggx",
         "roughness": 0.5, "roughness_squared": )" +
                std::string(squared) +
                R"(, "roughness_texture": {"file": "assets/checker.png", "encoding": "linear"}}}]})",
            "in.json", "in", scenes + "/features");
    };
    const Scene there = scene("false"), back = through_mitsuba(there);
    const BxdfComponent &after = back.materials().component[0];
    EXPECT_EQ(after.alpha, Eigen::Vector2d(1, 1));
    ASSERT_NE(after.roughness_texture, no_index);
    const TextureImage &bytes = *there.arrays().textures.image[0];
    const TextureImage &floats = *back.arrays().textures.image[after.roughness_texture];
    ASSERT_EQ(floats.floats.size(), bytes.bytes.size());
    for (size_t i = 0; i < floats.floats.size(); ++i) {
        EXPECT_NEAR(floats.floats[i], 0.5 * bytes.bytes[i] / 255, 1e-6);
    }
    expect_input_error("no texture whose square scales the roughness",
                       [&] { through_mitsuba(scene("true")); });
}

TEST_F(MitsubaExport, CoatedBasesComeBackAsPlastics) {
    const Scene scene =
        parse_scene_json(R"({"version": 1, "film": {"width": 8, "height": 4}, "nodes": [
        {"name": "eye", "camera": {"type": "pinhole", "fov": 60, "fov_axis": "x"}},
        {"name": "rough", "geometry": {"type": "rectangle"}, "material": {"type": "coated_diffuse", "eta": 1.5,
         "roughness": 0.25, "reflectance": [0.25, 0.5, 0.75]}},
        {"name": "printed", "geometry": {"type": "rectangle"}, "material": {"type": "composite", "components": [
         {"bxdf": "ideal_reflection", "weight": [1, 1, 1], "fresnel": {"type": "dielectric", "eta": 1.25}},
         {"bxdf": "coated_lambert", "weight": [1, 1, 1], "eta": 1.25, "nonlinear": true, "inner_reflectance": 0.393984,
          "weight_texture": {"file": "assets/checker.png", "encoding": "srgb"}}]}}]})",
                         "in.json", "in", scenes + "/features");
    const std::vector<BxdfComponent> before = scene.materials().component;
    const std::vector<BxdfComponent> after = through_mitsuba(scene).materials().component;
    ASSERT_EQ(after.size(), 4u);
    EXPECT_EQ(after[1].kind, BxdfComponent::Kind::coated_lambert);
    EXPECT_EQ(after[1].alpha, before[1].alpha);
    // Mitsuba's coat reflects less light back, so its base is brighter.
    const double own = coat_diffuse_reflectance({1.5, 0.25});
    EXPECT_GT(own - after[1].inner_reflectance, 5e-3);
    for (int i = 0; i < 3; ++i) {
        EXPECT_NEAR(after[1].weight[i] / (1 - after[1].inner_reflectance),
                    before[1].weight[i] / (1 - own), 1e-6);
    }
    EXPECT_EQ(after[3].kind, BxdfComponent::Kind::coated_lambert);
    EXPECT_TRUE(after[3].nonlinear);
    EXPECT_EQ(after[3].alpha, Eigen::Vector2d(0, 0));
}

TEST_F(MitsubaExport, PrincipledBsdfsComeBack) {
    std::ofstream(testing::TempDir() + "two.ppm", std::ios::binary)
        << "P6 2 1 255\n\x80\x40\x20\x10\x20\x30";
    const std::string texture =
        R"(<string name="filename" value="two.ppm"/><boolean name="raw" value="true"/></texture>)";
    const std::string base = R"(<rgb name="base_color" value="0.75, 0.5, 0.25"/>)";
    const auto number = [](const char *name, const char *value) {
        return "<float name=\"" + std::string(name) + "\" value=\"" + value + "\"/>";
    };
    const std::string all = base + number("metallic", "0.25") + number("spec_tint", "0.5") +
                            number("roughness", "0.5") + number("anisotropic", "0.25") +
                            number("clearcoat", "0.5") + number("clearcoat_gloss", "0.75") +
                            number("sheen", "0.5") + number("sheen_tint", "0.25") +
                            number("flatness", "0.25") + number("eta", "1.25");
    const std::string textured =
        R"(<texture type="bitmap" name="base_color">)" + texture + number("metallic", "0.25");
    const std::string rough = R"(<texture type="bitmap" name="roughness">)" + texture;
    for (const std::string &properties :
         {std::string(), all, textured, rough, textured + rough, base + number("metallic", "1"),
          base + number("spec_tint", "1"), base + number("specular", "0"),
          base + number("roughness", "0"), number("metallic", "1") + number("roughness", "0"),
          base + number("sheen", "1") + number("metallic", "0.5")}) {
        SCOPED_TRACE(properties);
        for (const char *sides : {"%s", "<bsdf type=\"twosided\">%s</bsdf>"}) {
            const Notices silent;
            std::string bsdf = sides;
            bsdf.replace(bsdf.find("%s"), 2, "<bsdf type=\"principled\">" + properties + "</bsdf>");
            const Scene scene =
                parse_mitsuba_xml(mitsuba_scene("<shape type=\"rectangle\">" + bsdf + "</shape>"),
                                  "in.xml", "in", testing::TempDir());
            const Scene back = through_mitsuba(scene);
            const auto &before = scene.materials().component;
            const auto &after = back.materials().component;
            ASSERT_EQ(before.size(), after.size());
            EXPECT_EQ(scene.materials().two_sided, back.materials().two_sided);
            for (size_t i = 0; i < before.size(); ++i) {
                EXPECT_EQ(before[i].kind, after[i].kind);
                EXPECT_EQ(before[i].fresnel, after[i].fresnel);
                EXPECT_EQ(before[i].complement, after[i].complement);
                EXPECT_LT((before[i].weight - after[i].weight).norm(), 1e-6f);
                expect_close(before[i].eta, after[i].eta, 1e-6);
                expect_close(before[i].alpha, after[i].alpha, 1e-6);
                EXPECT_NEAR(before[i].disney_roughness, after[i].disney_roughness, 1e-12);
                EXPECT_NEAR(before[i].flatness, after[i].flatness, 1e-12);
                for (const auto index :
                     {&BxdfComponent::texture, &BxdfComponent::roughness_texture}) {
                    ASSERT_EQ(before[i].*index == no_index, after[i].*index == no_index);
                    if (before[i].*index != no_index) {
                        expect_same_texture(scene.arrays().textures, before[i].*index,
                                            back.arrays().textures, after[i].*index);
                    }
                }
            }
        }
    }
}

TEST_F(MitsubaExport, SumsThatArePrincipledOnlyByKindAreErrors) {
    // The weights of the reflection and of the metal must add up to 1.
    const Scene scene =
        parse_scene_json(R"({"version": 1, "film": {"width": 8, "height": 4}, "nodes": [
        {"name": "eye", "camera": {"type": "pinhole", "fov": 60, "fov_axis": "x"}},
        {"name": "o", "geometry": {"type": "rectangle"}, "material": {"type": "composite", "components": [
         {"bxdf": "microfacet_reflection", "weight": [0.5, 0.5, 0.5], "alpha": 0.25, "fresnel": {"type": "dielectric", "eta": 1.5}},
         {"bxdf": "disney_diffuse", "weight": [0.25, 0.25, 0.25], "roughness": 0.5}]}}]})",
                         "in.json", "in");
    expect_input_error("the lobes of Mitsuba's principled BSDF", [&] { through_mitsuba(scene); });
}

TEST_F(MitsubaExport, OpacitiesComeBackAsMasks) {
    const Scene scene =
        parse_scene_json(R"({"version": 1, "film": {"width": 8, "height": 4}, "nodes": [
        {"name": "eye", "camera": {"type": "pinhole", "fov": 60, "fov_axis": "x"}},
        {"name": "veil", "geometry": {"type": "rectangle"}, "material":
         {"type": "lambert", "reflectance": [1, 1, 1], "opacity": 0.25}},
        {"name": "leaf", "geometry": {"type": "rectangle"}, "material":
         {"type": "lambert", "reflectance": [1, 1, 1], "opacity_texture": {"file": "assets/leaf.png", "encoding": "alpha"}}}]})",
                         "in.json", "in", scenes + "/features");
    expect_same_scene(scene, through_mitsuba(scene));
    // Shadow rays of Mitsuba's integrator "path" do not pass masks.
    EXPECT_NE(read_file(folder_ / "out.xml").find("\"volpath\""), std::string::npos);
}

TEST_F(MitsubaExport, TheFactorOfNormalsGoesIntoTheTexels) {
    const Scene scene =
        parse_scene_json(R"({"version": 1, "film": {"width": 8, "height": 4}, "nodes": [
        {"name": "eye", "camera": {"type": "pinhole", "fov": 60, "fov_axis": "x"}},
        {"name": "tile", "geometry": {"type": "rectangle"}, "material":
         {"type": "lambert", "reflectance": [1, 1, 1], "normal_map": 3, "map_mirrored_back": true,
          "normal_map_texture": {"file": "assets/normals.png", "encoding": "linear"}}},
        {"name": "thin", "geometry": {"type": "rectangle"}, "material":
         {"type": "lambert", "reflectance": [1, 1, 1], "map_shadowing": false, "opacity": 0.5,
          "normal_map_texture": {"file": "assets/normals.png", "encoding": "linear"}}}]})",
                         "in.json", "in", scenes + "/features");
    const Scene back = through_mitsuba(scene);
    expect_same_scene(scene, back);
    const auto texels = [](const Scene &of) -> const TextureImage & {
        return *of.arrays().textures.image[of.materials().normal_map[0].texture];
    };
    const std::vector<uint8_t> &bytes = texels(scene).bytes;
    const std::vector<float> &floats = texels(back).floats;
    ASSERT_EQ(bytes.size(), floats.size());
    for (size_t i = 0; i < floats.size(); ++i) {
        const double n = 2 * (bytes[i] / 255.0) - 1;
        EXPECT_NEAR(2 * static_cast<double>(floats[i]) - 1, i % 3 == 2 ? n / 3 : n, 1e-6);
    }
}

TEST_F(MitsubaExport, FarScenesStayWhereTheyAre) {
    const Scene scene =
        parse_scene_json(R"({"version": 1, "film": {"width": 8, "height": 4}, "nodes": [
        {"name": "far", "transform": [{"translate": [1e6, 0, 0]}], "children": [
         {"name": "eye", "transform": [{"translate": [0.1, 0, 3]}], "camera": {"type": "pinhole", "fov": 60, "fov_axis": "x"}},
         {"name": "lamp", "light": {"type": "point", "intensity": [1, 1, 1]}},
         {"name": "tile", "geometry": {"type": "rectangle"}, "material": {"type": "lambert", "reflectance": [1, 1, 1]}},
         {"name": "ball", "geometry": {"type": "sphere"}, "material": {"type": "mirror", "reflectance": [1, 1, 1]}}]}]})",
                         "in.json", "in");
    ASSERT_GT(scene.origin().norm(), 9e5);
    const Scene back = through_mitsuba(scene);
    EXPECT_LT((back.origin() - scene.origin()).norm(), 1e-6);
    expect_same_scene(scene, back);
}

TEST_F(MitsubaExport, WritesNothingOfWhatItCannotExpress) {
    const Scene scene = load_scene(scenes + "/features/julia.json");
    expect_input_error("Mitsuba has no julia",
                       [&] { export_mitsuba_xml(scene, folder_ / "out.xml"); });
    EXPECT_FALSE(std::filesystem::exists(folder_ / "out.xml"));
    expect_input_error("", [&] { export_mitsuba_xml(scene, folder_ / "none" / "out.xml"); });
}

TEST_F(MitsubaExport, TakesOneLightAllAround) {
    const Scene scene =
        parse_scene_json(R"({"version": 1, "film": {"width": 8, "height": 4}, "nodes": [
        {"name": "eye", "camera": {"type": "pinhole", "fov": 60, "fov_axis": "x"}},
        {"name": "a", "light": {"type": "dome", "radiance": [1, 1, 1]}},
        {"name": "b", "light": {"type": "dome", "radiance": [1, 1, 1]}}]})",
                         "in.json", "in");
    expect_input_error(
        "'b': Mitsuba supports at most one dome or environment light, and there is already 'a'",
        [&] { through_mitsuba(scene); });
}

}  // namespace
}  // namespace rtrays
