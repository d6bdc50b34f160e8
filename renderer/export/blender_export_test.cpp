// SPDX-License-Identifier: MIT
// Tests the export for Blender: the description matches the scene arrays, or an error names the
// feature that Cycles lacks.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <map>
#include <nlohmann/json.hpp>

#include "renderer/base/files.h"
#include "renderer/base/json.h"
#include "renderer/export/export_scene.h"
#include "renderer/import/images/texture_file.h"
#include "renderer/import/json/scene_json.h"
#include "renderer/import/load_scene.h"
#include "renderer/scene/cores/texture.h"
#include "renderer/testing/errors.h"
#include "renderer/testing/scene_builder.h"

namespace rtrays {
namespace {

const std::string scenes = RTRAYS_SCENES;

class BlenderExport : public WithImages {
  protected:
    Json exported(const Scene &scene, const ExportSettings &settings = {}) {
        export_scene(scene, file_, settings);
        return load_json(file_);
    }

    std::filesystem::path folder_ = testing::TempDir();
    std::filesystem::path file_ = folder_ / "out.blender.json";
};

/// Returns the feature scenes that Cycles cannot express, with a fragment of the error message.
const std::map<std::string, const char *> &beyond_cycles() {
    static const std::map<std::string, const char *> reasons = {
        {"beckmann",
         "(microfacet_reflection with Fresnel term conductor): not supported by Cycles: its Glossy "
         "BSDF has"},
        {"blinn_64",
         "'object': material 'object', component 0 (blinn with Fresnel term conductor): not "
         "supported by Cycles: it has no such model"},
        {"car_paint",
         "component 1 (lambert with Fresnel term dielectric): not supported by Cycles: the Fresnel "
         "term of its diffuse components"},
        {"coated_diffuse", "no diffuse reflection under a coat"},
        {"ggx", "no Fresnel term"},
        {"julia",
         "'object': Cycles supports only triangles, which cannot represent this Julia set"},
        {"bump_map", "the export to Cycles does not support normal and bump maps"},
        {"mixture", "the export writes no mixture by a texture"},
        {"normal_map", "the export to Cycles does not support normal and bump maps"},
        {"orthographic", "the export to Cycles does not support orthographic cameras"},
        {"oren_nayar_079", "its Oren-Nayar model differs"},
        {"plane",
         "'ground': Cycles supports only triangles, which cannot represent this unbounded plane"},
        {"principled", "it has no such model"},
        {"rough_glass_ggx", "at the normal instead of the half vector"},
        {"rough_plastic", "no Fresnel term"},
        {"texture_mirror", "the export to Cycles does not support the wrap mode mirror"},
        {"thin_glass", "not supported by Cycles: the export has no thin plates"},
        {"two_sides", "not supported by Cycles: the export has no materials that differ by side"},
        {"ward_010", "it has no such model"},
        {"ward_original", "it has no such model"},
    };
    return reasons;
}

TEST_F(BlenderExport, ScenesOfSingleFeaturesAreWrittenOrAreErrors) {
    int written = 0;
    for (const auto &entry : std::filesystem::directory_iterator(scenes + "/features")) {
        if (entry.path().extension() != ".json") {
            continue;
        }
        SCOPED_TRACE(entry.path().stem().string());
        const Scene scene = load_scene(entry.path().string());
        const auto reason = beyond_cycles().find(entry.path().stem().string());
        std::filesystem::remove(file_);
        if (reason != beyond_cycles().end()) {
            expect_input_error(reason->second, [&] { exported(scene); });
            EXPECT_FALSE(std::filesystem::exists(file_));
            continue;
        }
        try {
            const Json description = exported(scene);
            EXPECT_EQ(description.at("meshes").size(),
                      scene.meshes().name.size() + scene.arrays().shapes.name.size());
            EXPECT_EQ(description.at("materials").size(), scene.materials().name.size());
            ++written;
        } catch (const Error &error) {  // other scenes with the same unsupported features
            EXPECT_NE(std::string(error.what()).find("not supported by Cycles"), std::string::npos)
                << error.what();
        }
    }
    EXPECT_GE(written, 37);
}

TEST_F(BlenderExport, RefusesColoursOfVertices) {
    const Scene scene = parse_scene_json(
        R"({"version": 1, "film": {"width": 8, "height": 4}, "nodes": [
        {"name": "eye", "camera": {"type": "pinhole", "fov": 60, "fov_axis": "x"}},
        {"name": "tile", "geometry": {"type": "rectangle"},
         "material": {"type": "lambert", "reflectance": [1, 1, 1],
                      "reflectance_texture": {"vertex_colours": true}}}]})",
        "in.json", "in", scenes);
    expect_input_error("the export to Cycles does not support vertex colours",
                       [&] { exported(scene); });
}

TEST_F(BlenderExport, SaysWhatTheArraysSay) {
    const Scene box = load_scene(scenes + "/cornell_box/scene.json");
    const Json description = exported(box, {500, 7});
    EXPECT_EQ(description.at("samples_per_pixel"), 500);
    EXPECT_EQ(description.at("max_depth"), 7);
    const Json &camera = description.at("camera");
    EXPECT_EQ(camera.at("fov").get<double>(), box.cameras().fov[0]);
    for (int row = 0; row < 4; ++row) {
        for (int column = 0; column < 4; ++column) {
            EXPECT_EQ(camera.at("world_from_camera")[row][column].get<double>(),
                      box.cameras().world_from_camera[0](row, column));
        }
    }
    const MeshArrays &meshes = box.meshes();
    int bright = 0;
    for (size_t i = 0; i < meshes.name.size(); ++i) {
        const Json &mesh = description.at("meshes")[i];
        EXPECT_EQ(mesh.at("name"), meshes.name[i]);
        EXPECT_EQ(mesh.at("triangles"), meshes.triangle_count[i]);
        EXPECT_TRUE(std::filesystem::exists(folder_ / mesh.at("file").get<std::string>()));
        const Json &material = description.at("materials")[mesh.at("material").get<size_t>()];
        const BxdfComponent &part =
            box.materials().component[box.materials().first_component[meshes.material[i]]];
        EXPECT_EQ(material.at("components")[0].at("weight")[1].get<float>(), part.weight[1]);
        ASSERT_EQ(mesh.contains("radiance"), meshes.light[i] != no_index);
        if (mesh.contains("radiance")) {
            EXPECT_EQ(mesh.at("radiance")[0].get<float>(),
                      box.lights().radiance[meshes.light[i]][0]);
            ++bright;
        }
    }
    EXPECT_EQ(bright, 1);
    EXPECT_TRUE(description.at("lights").empty());  // area lights are part of their surfaces
}

TEST_F(BlenderExport, DecodesTexels) {
    const Scene scene = load_scene(scenes + "/features/texture_bilinear.json");
    const Json description = exported(scene);
    ASSERT_EQ(description.at("textures").size(), 1u);
    const auto written =
        load_texture_file(folder_ / description.at("textures")[0].at("file").get<std::string>(),
                          TextureEncoding::linear);
    const TextureImage &image = *scene.arrays().textures.image[0];
    ASSERT_TRUE(image.srgb);
    ASSERT_EQ(written->floats.size(), image.bytes.size());
    for (size_t i = 0; i < image.bytes.size(); ++i) {
        EXPECT_EQ(written->floats[i], static_cast<float>(srgb_decoded(image.bytes[i] / 255.0)));
    }
}

TEST_F(BlenderExport, WritesOpacitiesAndTexturesOfEmissionAndRoughness) {
    const auto scene = [](const std::string &material) {
        return parse_scene_json(R"({"version": 1, "film": {"width": 8, "height": 4}, "nodes": [
            {"name": "eye", "camera": {"type": "pinhole", "fov": 60, "fov_axis": "x"}},
            {"name": "o", "geometry": {"type": "rectangle"}, "material": )" +
                                    material + "}]}",
                                "in.json", "in", scenes + "/features");
    };
    const auto material = [&](const std::string &text) {
        return exported(scene(text)).at("materials")[0];
    };
    const std::string checks = R"({"file": "assets/checker.png", "encoding": "linear"})";
    const std::string matte = R"({"type": "lambert", "reflectance": [1, 1, 1])";
    EXPECT_FALSE(material(matte + "}").contains("opacity"));
    EXPECT_EQ(material(matte + R"(, "opacity": 0.25})").at("opacity"),
              (Json{{"value", 0.25}, {"cutoff", 0.0}}));
    EXPECT_EQ(material(matte + R"(, "opacity": 0.5, "opacity_cutoff": 0.375, "opacity_texture": )" +
                       checks + "}")
                  .at("opacity"),
              (Json{{"value", 0.5}, {"cutoff", 0.375}, {"texture", 0}}));
    EXPECT_EQ(material(matte + R"(, "emission": [1, 2, 3], "emission_texture": )" + checks + "}")
                  .at("emission_texture"),
              0);
    const auto rough = [&](const char *alpha) {
        return R"({"type": "composite", "components": [{"bxdf": "microfacet_reflection",
            "weight": [1, 1, 1], "roughness_squared": true, "alpha": )" +
               std::string(alpha) + R"(, "alpha_texture": )" + checks + "}]}";
    };
    const Json component = material(rough("0.5")).at("components")[0];
    EXPECT_EQ(component.at("alpha"), 0.5);
    EXPECT_EQ(component.at("roughness_texture"), 0);
    EXPECT_EQ(component.at("roughness_squared"), true);
    // The darkest texels make a mirror of it.
    expect_input_error("a surface of such low roughness as a mirror",
                       [&] { exported(scene(rough("0.001"))); });
}

TEST_F(BlenderExport, ResolvesTheAxisOfTheField) {
    const auto axis = [&](const char *name, int width, int height) {
        Scene scene = parse_scene_json(
            std::string(R"({"version": 1, "film": {"width": 8, "height": 4}, "nodes": [
            {"name": "eye", "camera": {"type": "pinhole", "fov": 60, "fov_axis": ")") +
                name + R"("}}]})",
            "in.json", "in");
        scene.set_film_size(width, height);
        return exported(scene).at("camera").at("fov_axis").get<std::string>();
    };
    EXPECT_EQ(axis("x", 4, 8), "x");
    EXPECT_EQ(axis("y", 8, 4), "y");
    EXPECT_EQ(axis("smaller", 8, 4), "y");
    EXPECT_EQ(axis("smaller", 4, 8), "x");
    EXPECT_EQ(axis("larger", 8, 4), "x");
    EXPECT_EQ(axis("larger", 4, 8), "y");
}

TEST_F(BlenderExport, CropsAreErrors) {
    Scene box = load_scene(scenes + "/cornell_box/scene.json");
    box.set_crop({10, 20, 30, 40});
    expect_input_error("film: the export to Cycles does not support a crop",
                       [&] { exported(box); });
}

TEST_F(BlenderExport, ListsTheEndings) {
    const Scene box = load_scene(scenes + "/cornell_box/scene.json");
    for (const char *name : {"out.json", "out.blend", ".xml", "xml"}) {
        expect_input_error("end in .xml (Mitsuba 3) or .blender.json (Blender's Cycles)",
                           [&] { export_scene(box, folder_ / name); });
    }
}

}  // namespace
}  // namespace rtrays
