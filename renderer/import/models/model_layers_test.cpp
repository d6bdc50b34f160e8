// SPDX-License-Identifier: MIT
// Tests materials of glTF that a map mixes or that have several layers: metalness, transmission,
// clear coats and sheen.
#include <gtest/gtest.h>

#include <cmath>
#include <nlohmann/json.hpp>

#include "renderer/base/json.h"
#include "renderer/scene/cores/material_energy.h"
#include "renderer/testing/loaded_model.h"
#include "renderer/testing/temporary_folder.h"

namespace rtrays {
namespace {

using Eigen::Vector2d;
using Eigen::Vector3f;
using Kind = BxdfComponent::Kind;
using Fresnel = BxdfComponent::Fresnel;

/// Half of the texels are (255, 128, 0), half are (0, 64, 255).
constexpr const char *checker =
    "data:image/png;base64,"
    "iVBORw0KGgoAAAANSUhEUgAAAAQAAAAECAIAAAAmkwkpAAAAGElEQVR42mNgcPj/v4EBSiJYDv8ZcMoAADqyFfGE/"
    "XEFAAAAAElFTkSuQmCC";

/// Returns triangles.gltf with the image `checker`, a dielectric base (0.8, 0.6, 0.4) of roughness
/// 1/2, and these extensions of its material `brass`.
Json model_with(const Json &extensions) {
    Json model = parse_json(bytes_of(std::filesystem::path(RTRAYS_CORPUS) / "triangles.gltf"),
                            "triangles.gltf");
    model["images"] = {{{"uri", checker}}};
    model["textures"] = {{{"source", 0}}};
    Json &material = model["materials"][0];
    material["pbrMetallicRoughness"] = {
        {"baseColorFactor", {0.8, 0.6, 0.4, 1}}, {"metallicFactor", 0}, {"roughnessFactor", 0.5}};
    material["extensions"] = extensions;
    for (const auto &[name, value] : extensions.items()) {
        model["extensionsUsed"].push_back(name);
    }
    return model;
}

LoadedModel loaded(const Json &model) {
    const TemporaryFolder folder;
    return LoadedModel(folder.write("m.gltf", model.dump()));
}

Json transmission(double factor) {
    return {{"KHR_materials_transmission", {{"transmissionFactor", factor}}}};
}

TEST(GltfLayers, MetalnessOfOneValueNeedsNoMixture) {
    Json model = model_with(Json::object());
    Json &physical = model["materials"][0]["pbrMetallicRoughness"];
    physical["metallicFactor"] = 0.5;
    physical["metallicRoughnessTexture"] = {{"index", 0}};
    const auto mixed = loaded(model).material("brass");
    ASSERT_EQ(mixed.size(), 3u);
    EXPECT_EQ(mixed[0].mix, 0.5);
    EXPECT_NE(mixed[0].mix_texture, no_index);
    // A white image: the factor is the metalness.
    model["images"][0]["uri"] =
        "data:image/png;base64,iVBORw0KGgoAAAANSUhEUgAAAAEAAAABCAIAAACQd1PeAAAADElEQVR4nGP4"
        "//8/AAX+Av4N70a4AAAAAElFTkSuQmCC";
    const auto constant = loaded(model).material("brass");
    ASSERT_EQ(constant.size(), 3u);
    for (const BxdfComponent &part : constant) {
        EXPECT_EQ(part.mix_texture, no_index);
    }
    EXPECT_EQ(constant[0].weight, Vector3f::Constant(0.5f));
}

TEST(GltfLayers, MapsWithOtherCoordinatesAreReplacedByTheirMean) {
    Json model = model_with(transmission(1));
    Json &material = model["materials"][0];
    material["pbrMetallicRoughness"]["baseColorTexture"] = {{"index", 0}};
    material["pbrMetallicRoughness"]["metallicFactor"] = 1;
    material["pbrMetallicRoughness"]["metallicRoughnessTexture"] = {{"index", 0}, {"texCoord", 1}};
    material["extensions"]["KHR_materials_transmission"]["transmissionTexture"] = {{"index", 0},
                                                                                   {"texCoord", 1}};
    const LoadedModel model_read = loaded(model);
    EXPECT_TRUE(model_read.says("metalness and roughness maps are replaced by their mean if"))
        << model_read.told;
    EXPECT_TRUE(model_read.says("transmission maps are replaced by their mean beside"))
        << model_read.told;
    EXPECT_LT((model_read.material("brass")[0].weight - Vector3f::Constant(0.5f)).norm(), 1e-6f);
}

TEST(GltfLayers, TransmissionMapsMixBaseAndRefraction) {
    Json model = model_with(transmission(0.5));
    Json &extensions = model["materials"][0]["extensions"];
    extensions["KHR_materials_transmission"]["transmissionTexture"] = {{"index", 0}};
    extensions["KHR_materials_volume"] = {{"thicknessFactor", 1}};
    model["extensionsUsed"].push_back("KHR_materials_volume");
    const LoadedModel read = loaded(model);
    const auto part = read.material("brass");
    ASSERT_EQ(part.size(), 3u);
    EXPECT_EQ(part[0].mix_texture, no_index);
    EXPECT_EQ(part[1].kind, Kind::lambert);
    EXPECT_TRUE(part[1].mix_inverted);
    EXPECT_EQ(part[2].kind, Kind::microfacet_refraction);
    EXPECT_FALSE(part[2].mix_inverted);
    for (const size_t i : {1, 2}) {
        EXPECT_EQ(part[i].mix, 0.5);
        ASSERT_NE(part[i].mix_texture, no_index);
        // The red channel.
        const auto &bytes = read.scene.arrays().textures.image[part[i].mix_texture]->bytes;
        EXPECT_EQ(std::count(bytes.begin(), bytes.end(), 255), 3 * 8);
        EXPECT_EQ(std::count(bytes.begin(), bytes.end(), 0), 3 * 8);
    }
    EXPECT_FALSE(read.says("mean")) << read.told;
}

TEST(GltfLayers, TransmissionWithoutThicknessIsThatOfThinWalls) {
    Json model = model_with(transmission(1));
    Json &physical = model["materials"][0]["pbrMetallicRoughness"];
    // A rough wall reflects by microfacets, and the rest passes straight through.
    const LoadedModel rough = loaded(model);
    const auto wall = rough.material("brass");
    ASSERT_EQ(wall.size(), 2u);
    EXPECT_EQ(wall[0].kind, Kind::microfacet_reflection);
    EXPECT_EQ(wall[0].fresnel, Fresnel::thin_dielectric);
    EXPECT_EQ(wall[0].alpha, Vector2d(0.25, 0.25));
    EXPECT_EQ(wall[1].kind, Kind::ideal_refraction);
    EXPECT_EQ(wall[1].fresnel, Fresnel::thin_dielectric);
    EXPECT_TRUE(wall[1].complement);
    EXPECT_EQ(wall[1].eta, Eigen::Vector3d(1, 1.5, 1.5));
    EXPECT_LT((wall[1].weight - Vector3f(0.8f, 0.6f, 0.4f)).norm(), 1e-6f);
    EXPECT_TRUE(rough.says("thin walls, which are passed without scattering; set thicknessFactor"))
        << rough.told;

    physical["roughnessFactor"] = 0;
    const LoadedModel smooth = loaded(model);
    const auto pane = smooth.material("brass");
    ASSERT_EQ(pane.size(), 2u);
    EXPECT_EQ(pane[0].kind, Kind::ideal_reflection);
    EXPECT_EQ(pane[0].fresnel, Fresnel::thin_dielectric);
    EXPECT_EQ(pane[1].eta[0], 1);
    EXPECT_TRUE(smooth.says("that of thin walls; set thicknessFactor for a solid (1: brass)"));
    // A thickness of 0 is none.
    model["materials"][0]["extensions"]["KHR_materials_volume"] = {{"thicknessFactor", 0}};
    EXPECT_EQ(loaded(model).material("brass")[1].fresnel, Fresnel::thin_dielectric);

    model["materials"][0]["extensions"] = transmission(0.25);
    const auto partly = loaded(model).material("brass");
    ASSERT_EQ(partly.size(), 3u);
    EXPECT_EQ(partly[1].kind, Kind::lambert);
    EXPECT_EQ(partly[1].fresnel, Fresnel::thin_dielectric);
    EXPECT_LT((partly[1].weight - Vector3f(0.6f, 0.45f, 0.3f)).norm(), 1e-6f);
    EXPECT_LT((partly[2].weight - Vector3f(0.2f, 0.15f, 0.1f)).norm(), 1e-6f);
}

TEST(GltfLayers, ClearCoatsCoverAShareOfTheSurface) {
    Json model = model_with({{"KHR_materials_clearcoat",
                              {{"clearcoatFactor", 0.75}, {"clearcoatRoughnessFactor", 0.5}}}});
    Json &material = model["materials"][0];
    material["pbrMetallicRoughness"]["metallicFactor"] = 0.5;
    const LoadedModel read = loaded(model);
    const auto part = read.material("brass");
    ASSERT_EQ(part.size(), 6u);
    // A quarter is the surface without a coat.
    EXPECT_EQ(part[0].fresnel, Fresnel::schlick);
    EXPECT_EQ(part[0].weight, Vector3f::Constant(0.125f));
    EXPECT_EQ(part[1].fresnel, Fresnel::dielectric);
    EXPECT_EQ(part[2].kind, Kind::lambert);
    EXPECT_LT((part[2].weight - 0.125f * Vector3f(0.8f, 0.6f, 0.4f)).norm(), 1e-6f);
    // The coat, and metal and Lambert below it.
    EXPECT_EQ(part[3].kind, Kind::microfacet_reflection);
    EXPECT_LT((part[3].alpha - Vector2d(0.25, 0.25)).norm(), 1e-12);
    EXPECT_EQ(part[3].weight, Vector3f::Constant(0.75f));
    for (size_t i = 3; i < 6; ++i) {
        EXPECT_EQ(part[i].fresnel, Fresnel::dielectric);
        EXPECT_EQ(part[i].eta[0], 1.5);
        EXPECT_EQ(part[i].complement, i > 3);
    }
    EXPECT_LT((part[4].weight - 0.375f * Vector3f(0.8f, 0.6f, 0.4f)).norm(), 1e-6f);
    EXPECT_EQ(part[4].alpha, Vector2d(0.25, 0.25));
    EXPECT_EQ(part[5].kind, Kind::lambert);
    EXPECT_TRUE(read.says("clear coats are")) << read.told;

    // Maps are replaced by their mean: half is covered, with the roughness 0.5 * 96 / 255.
    Json &coat = material["extensions"]["KHR_materials_clearcoat"];
    coat["clearcoatTexture"] = {{"index", 0}};
    coat["clearcoatRoughnessTexture"] = {{"index", 0}};
    const LoadedModel mapped = loaded(model);
    const auto less = mapped.material("brass");
    ASSERT_EQ(less.size(), 6u);
    EXPECT_EQ(less[3].weight, Vector3f::Constant(0.375f));
    EXPECT_NEAR(less[3].alpha[0], std::pow(0.5 * 96 / 255, 2), 1e-9);
    EXPECT_TRUE(mapped.says("maps of clear coats are replaced by their mean")) << mapped.told;
    EXPECT_FALSE(mapped.says("textures of KHR_materials_clearcoat are ignored")) << mapped.told;
}

TEST(GltfLayers, CoatedGlassStaysGlass) {
    Json extensions = transmission(1);
    extensions["KHR_materials_volume"] = {{"thicknessFactor", 1}};
    extensions["KHR_materials_clearcoat"] = {{"clearcoatFactor", 1}};
    extensions["KHR_materials_ior"] = {{"ior", 1.33}};
    const auto part = loaded(model_with(extensions)).material("brass");
    ASSERT_EQ(part.size(), 2u);
    EXPECT_EQ(part[0].kind, Kind::ideal_reflection);
    EXPECT_EQ(part[0].eta[0], 1.33);
    EXPECT_EQ(part[1].kind, Kind::microfacet_refraction);
}

TEST(GltfLayers, SheenDarkensTheBaseByItsAlbedo) {
    Json model = model_with({{"KHR_materials_sheen",
                              {{"sheenColorFactor", {1, 0.5, 0}}, {"sheenRoughnessFactor", 0.3}}}});
    const LoadedModel read = loaded(model);
    const auto part = read.material("brass");
    ASSERT_EQ(part.size(), 3u);
    EXPECT_EQ(part[2].kind, Kind::disney_sheen);
    EXPECT_EQ(part[2].weight, Vector3f(1, 0.5f, 0));
    const auto rest = static_cast<float>(1 - sheen_albedo(0));
    EXPECT_NEAR(part[0].weight[0], rest, 2e-4f);
    EXPECT_NEAR(part[1].weight[0], 0.8f * rest, 2e-4f);
    EXPECT_TRUE(read.says("KHR_materials_sheen is Burley's sheen")) << read.told;
    Json &sheen = model["materials"][0]["extensions"]["KHR_materials_sheen"];
    sheen["sheenColorTexture"] = {{"index", 0}};
    EXPECT_NE(loaded(model).material("brass")[2].texture, no_index);
    // Without the extension nothing is darkened.
    EXPECT_EQ(loaded(model_with(Json::object())).material("brass")[0].weight, Vector3f::Ones());
}

TEST(GltfLayers, AllOfThemConserveEnergy) {
    // Making a material checks that no direction returns more light than arrives.
    for (const double metal : {0.0, 0.5, 1.0}) {
        for (const double coat : {0.0, 0.5, 1.0}) {
            for (const double through : {0.0, 0.5, 1.0}) {
                for (const double thickness : {0.0, 1.0}) {
                    Json extensions = transmission(through);
                    extensions["KHR_materials_volume"] = {{"thicknessFactor", thickness}};
                    extensions["KHR_materials_clearcoat"] = {{"clearcoatFactor", coat}};
                    extensions["KHR_materials_sheen"] = {{"sheenColorFactor", {1, 1, 1}}};
                    extensions["KHR_materials_ior"] = {{"ior", 1.2 + metal}};
                    Json model = model_with(extensions);
                    Json &physical = model["materials"][0]["pbrMetallicRoughness"];
                    physical["baseColorFactor"] = {1, 1, 1, 1};
                    physical["metallicFactor"] = metal;
                    EXPECT_FALSE(loaded(model).material("brass").empty());
                    physical["metallicRoughnessTexture"] = {{"index", 0}};
                    EXPECT_FALSE(loaded(model).material("brass").empty());
                }
            }
        }
    }
}

}  // namespace
}  // namespace rtrays
