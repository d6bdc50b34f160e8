// SPDX-License-Identifier: MIT
// Tests the import of Mitsuba's BSDFs of several layers. Expected values are from Mitsuba 3.9.
#include <cmath>
#include <fstream>

#include "renderer/testing/mitsuba_scenes.h"

namespace rtrays {
namespace {

using Eigen::Vector2d;
using Eigen::Vector3d;
using Eigen::Vector3f;
using Kind = BxdfComponent::Kind;
using Fresnel = BxdfComponent::Fresnel;

/// Returns the components of a BSDF that a rectangle has.
std::vector<BxdfComponent> components_of(const std::string &bsdf) {
    return parse_elements(R"(<shape type="rectangle">)" + bsdf + "</shape>").materials().component;
}

TEST(MitsubaBsdfs, RoughPlasticsHaveARoughCoat) {
    const auto plastic = [](const std::string &properties) {
        return components_of(R"(<bsdf type="roughplastic"><float name="int_ior" value="1.5"/>
            <float name="ext_ior" value="1"/>)" +
                             properties + "</bsdf>");
    };
    const auto beckmann = plastic(R"(<float name="alpha" value="0.3"/>)");
    EXPECT_EQ(beckmann[0].kind, Kind::microfacet_reflection);
    EXPECT_EQ(beckmann[1].kind, Kind::coated_lambert);
    for (const BxdfComponent &part : beckmann) {
        EXPECT_EQ(part.alpha, Vector2d(0.3, 0.3));
        EXPECT_EQ(part.distribution, BxdfComponent::Distribution::beckmann);
        EXPECT_EQ(part.eta[0], 1.5);
    }
    EXPECT_EQ(beckmann[1].weight, Vector3f(0.5f, 0.5f, 0.5f));
    // Mitsuba's internal reflectances, from the ratio of its nonlinear and linear values.
    EXPECT_NEAR(beckmann[1].inner_reflectance, 0.52997, 6e-4);
    EXPECT_NEAR(plastic(R"(<float name="alpha" value="0.05"/>)")[1].inner_reflectance, 0.58594,
                2e-4);
    const std::string ggx = R"(<string name="distribution" value="ggx"/>)";
    EXPECT_NEAR(plastic(R"(<float name="alpha" value="0.3"/>)" + ggx)[1].inner_reflectance, 0.41486,
                2e-4);
    EXPECT_NEAR(plastic(R"(<float name="alpha" value="0.5"/>)" + ggx)[1].inner_reflectance, 0.28999,
                3e-4);
    // One colour needs no nonlinear base: rho / (1 - rho r) is that of a linear one.
    const auto deep = plastic(R"(<boolean name="nonlinear" value="true"/>
        <rgb name="diffuse_reflectance" value="0.25, 0.5, 1"/>)");
    const double r = deep[1].inner_reflectance;
    EXPECT_FALSE(deep[1].nonlinear);
    EXPECT_NEAR(deep[1].weight[0] / (1 - r), 0.25 / (1 - 0.25 * r), 1e-6);
    EXPECT_NEAR(deep[1].weight[2], 1, 1e-6);
}

TEST(MitsubaBsdfs, PrincipledIsASumOfItsLobes) {
    const auto parts = components_of(R"(<bsdf type="principled"/>)");
    ASSERT_EQ(parts.size(), 2u);
    EXPECT_EQ(parts[0].kind, Kind::microfacet_reflection);
    EXPECT_EQ(parts[0].fresnel, Fresnel::dielectric);
    EXPECT_EQ(parts[0].alpha, Vector2d(0.25, 0.25));
    EXPECT_NEAR(parts[0].eta[0], 1.5, 1e-12);  // of specular 0.5
    EXPECT_EQ(parts[1].kind, Kind::disney_diffuse);
    EXPECT_EQ(parts[1].disney_roughness, 0.5);
    EXPECT_EQ(parts[1].weight, Vector3f(0.5f, 0.5f, 0.5f));

    const auto all =
        components_of(R"(<bsdf type="principled"><rgb name="base_color" value="0.25, 0.5, 1"/>
        <float name="metallic" value="0.5"/><float name="spec_tint" value="0.25"/><float name="roughness" value="0.5"/>
        <float name="anisotropic" value="0.75"/><float name="clearcoat" value="0.5"/><float name="clearcoat_gloss" value="1"/>
        <float name="sheen" value="0.5"/><float name="flatness" value="0.25"/><float name="eta" value="2"/></bsdf>)");
    ASSERT_EQ(all.size(), 6u);
    const double aspect = std::sqrt(1 - 0.9 * 0.75);
    EXPECT_LT((all[0].alpha - Vector2d(0.25 / aspect, 0.25 * aspect)).norm(), 1e-12);
    EXPECT_EQ(all[0].weight[0], 0.375f);
    EXPECT_EQ(all[1].fresnel, Fresnel::schlick);
    EXPECT_EQ(all[1].weight[0], 0.125f);
    const double y = 0.25 * 0.2126 + 0.5 * 0.7152 + 0.0722;
    EXPECT_LT((all[1].eta - Vector3d(0.25, 0.5, 1) / y / 9).norm(), 1e-4);
    EXPECT_EQ(all[2].eta, Vector3d(0.25, 0.5, 1));  // the metal
    EXPECT_EQ(all[2].weight[0], 0.5f);
    EXPECT_EQ(all[3].kind, Kind::disney_clearcoat);
    EXPECT_NEAR(all[3].alpha[0], 0.001, 1e-12);
    EXPECT_NEAR(all[3].eta[0], 0.04, 1e-12);
    EXPECT_EQ(all[4].flatness, 0.25);
    EXPECT_EQ(all[4].weight, Vector3f(0.125f, 0.25f, 0.5f));
    EXPECT_EQ(all[5].kind, Kind::disney_sheen);
    EXPECT_EQ(all[5].weight[0], 0.25f);

    // Without a dielectric reflection Mitsuba has no metallic one either.
    EXPECT_EQ(components_of(R"(<bsdf type="principled"><float name="specular" value="0"/>
        <float name="metallic" value="0.5"/></bsdf>)")
                  .size(),
              1u);
    const auto glass = components_of(R"(<bsdf type="principled"><float name="spec_trans" value="1"/>
        <rgb name="base_color" value="0.25"/></bsdf>)");
    ASSERT_EQ(glass.size(), 2u);
    EXPECT_EQ(glass[1].kind, Kind::microfacet_refraction);
    EXPECT_NEAR(glass[1].weight[0], 0.5f, 1e-6);
    // An index of 1 counts as 1.001, as in Mitsuba.
    const auto air = components_of(
        R"(<bsdf type="principled"><float name="spec_trans" value="1"/><float name="specular" value="0"/></bsdf>)");
    ASSERT_EQ(air.size(), 2u);
    EXPECT_EQ(air[1].eta[0], 1.001);
}

class MitsubaRoughness : public WithImages {};

TEST_F(MitsubaRoughness, MayBeATexture) {
    std::ofstream(testing::TempDir() + "half.ppm", std::ios::binary) << "P6 1 1 255\n\x80\x80\x80";
    const auto texture = [](const std::string &name) {
        return R"(<texture type="bitmap" name=")" + name +
               R"("><string name="filename" value="half.ppm"/><boolean name="raw" value="true"/></texture>)";
    };
    const auto components = [](const std::string &bsdf) {
        return parse_mitsuba_xml(mitsuba_scene(R"(<shape type="rectangle">)" + bsdf + "</shape>"),
                                 "in.xml", "in", testing::TempDir())
            .materials()
            .component;
    };
    const auto metal = components(R"(<bsdf type="roughconductor">)" + texture("alpha") + "</bsdf>");
    EXPECT_EQ(metal[0].alpha, Vector2d(1, 1));
    EXPECT_EQ(metal[0].roughness_texture, 0u);
    EXPECT_FALSE(metal[0].roughness_squared);

    // The principled BSDF squares its roughness, but not that of its diffuse lobe.
    const auto principled =
        components(R"(<bsdf type="principled">)" + texture("roughness") + "</bsdf>");
    EXPECT_EQ(principled[0].alpha, Vector2d(1, 1));
    EXPECT_EQ(principled[0].roughness_texture, 0u);
    EXPECT_TRUE(principled[0].roughness_squared);
    EXPECT_EQ(principled[1].kind, Kind::disney_diffuse);
    EXPECT_EQ(principled[1].disney_roughness, 1);
    EXPECT_EQ(principled[1].roughness_texture, 0u);
    const auto glass =
        components(R"(<bsdf type="principled"><float name="spec_trans" value="1"/>)" +
                   texture("roughness") + "</bsdf>");
    EXPECT_EQ(glass[1].kind, Kind::microfacet_refraction);
    EXPECT_EQ(glass[1].roughness_texture, 0u);
    EXPECT_TRUE(glass[1].roughness_squared);

    expect_input_error("alpha: a texture is an error in Mitsuba", [&] {
        components(R"(<bsdf type="roughplastic">)" + texture("alpha") + "</bsdf>");
    });
}

/// A checkerboard as the value of a property.
std::string checkers(const std::string &property, const std::string &keys = "") {
    return R"(<texture type="checkerboard" name=")" + property + "\">" + keys + "</texture>";
}

TEST(MitsubaBsdfs, TexturesMixTheBsdfsOfABlend) {
    const std::string red =
        R"(<bsdf type="diffuse"><rgb name="reflectance" value="1, 0, 0"/></bsdf>)";
    const std::string coat = R"(<bsdf type="plastic"><boolean name="nonlinear" value="true"/>)" +
                             checkers("diffuse_reflectance") + "</bsdf>";
    const auto parts =
        components_of(R"(<bsdf type="blendbsdf">)" + checkers("weight") + red + coat + "</bsdf>");
    ASSERT_EQ(parts.size(), 3u);
    // The second BSDF has the weight, the first one the rest.
    for (size_t i = 0; i < 3; ++i) {
        EXPECT_EQ(parts[i].mix_texture, parts[0].mix_texture);
        EXPECT_EQ(parts[i].mix_inverted, i == 0);
        EXPECT_EQ(parts[i].mix, 1);
    }
    EXPECT_NE(parts[0].mix_texture, no_index);
    EXPECT_EQ(parts[0].weight, Vector3f(1, 0, 0));
    EXPECT_TRUE(parts[2].nonlinear);
    // A number inside of a texture, and a texture inside of a number.
    const std::string numbers =
        R"(<bsdf type="blendbsdf"><float name="weight" value="0.25"/>)" + red + red + "</bsdf>";
    const auto inside = components_of(R"(<bsdf type="blendbsdf">)" + checkers("weight") + numbers +
                                      red + "</bsdf>");
    ASSERT_EQ(inside.size(), 3u);
    EXPECT_EQ(inside[0].weight[0], 0.75f);
    EXPECT_TRUE(inside[1].mix_inverted);
    EXPECT_FALSE(inside[2].mix_inverted);
    const std::string texture =
        R"(<bsdf type="blendbsdf">)" + checkers("weight") + red + red + "</bsdf>";
    const auto outside =
        components_of(R"(<bsdf type="blendbsdf"><float name="weight" value="0.25"/>)" + texture +
                      red + "</bsdf>");
    ASSERT_EQ(outside.size(), 3u);
    EXPECT_EQ(outside[0].weight[0], 0.75f);
    EXPECT_EQ(outside[2].mix_texture, no_index);
    EXPECT_NE(outside[1].mix_texture, no_index);
    expect_input_error("its own weights are a texture", [&] {
        components_of(R"(<bsdf type="blendbsdf">)" + checkers("weight") + texture + red +
                      "</bsdf>");
    });
    expect_input_error("its brightest texel, 2, exceeds 1", [&] {
        components_of(R"(<bsdf type="blendbsdf">)" +
                      checkers("weight", R"(<rgb name="color0" value="2"/>)") + red + red +
                      "</bsdf>");
    });
    expect_input_error("expected a number from 0 to 1, or one texture, as weight", [&] {
        components_of(R"(<bsdf type="blendbsdf">)" + red + red + "</bsdf>");
    });
}

TEST(MitsubaBsdfs, CheckerboardsExchangeTheirColoursWhereTheyAreNumbers) {
    const auto first_texel = [](const std::string &bsdf) {
        const Scene scene = parse_elements(R"(<shape type="rectangle">)" + bsdf + "</shape>");
        return scene.arrays().textures.image.at(0)->floats.at(0);
    };
    EXPECT_EQ(first_texel(R"(<bsdf type="diffuse">)" + checkers("reflectance") + "</bsdf>"), 0.4f);
    EXPECT_EQ(first_texel(R"(<bsdf type="mask">)" + checkers("opacity") +
                          R"(<bsdf type="diffuse"/></bsdf>)"),
              0.2f);
    EXPECT_EQ(first_texel(R"(<bsdf type="roughconductor">)" + checkers("alpha") + "</bsdf>"), 0.2f);
    EXPECT_EQ(first_texel(R"(<bsdf type="blendbsdf">)" + checkers("weight") +
                          R"(<bsdf type="diffuse"/><bsdf type="diffuse"/></bsdf>)"),
              0.2f);
}

TEST(MitsubaBsdfs, TexturesMixTheLobesOfPrincipled) {
    const auto principled = [](const std::string &properties) {
        return components_of(R"(<bsdf type="principled">)" + properties + "</bsdf>");
    };
    const auto metal = principled(checkers("metallic") + R"(<float name="sheen" value="0.5"/>)" +
                                  checkers("clearcoat"));
    ASSERT_EQ(metal.size(), 5u);
    const Kind kinds[] = {Kind::microfacet_reflection, Kind::microfacet_reflection,
                          Kind::disney_clearcoat, Kind::disney_diffuse, Kind::disney_sheen};
    const bool inverted[] = {true, false, false, true, true};
    for (size_t i = 0; i < 5; ++i) {
        EXPECT_EQ(metal[i].kind, kinds[i]) << i;
        EXPECT_EQ(metal[i].mix_inverted, inverted[i]) << i;
        EXPECT_NE(metal[i].mix_texture, no_index) << i;
        EXPECT_EQ(metal[i].mix_texture == metal[0].mix_texture, i != 2) << i;
    }
    EXPECT_EQ(metal[0].fresnel, Fresnel::dielectric);
    EXPECT_EQ(metal[1].fresnel, Fresnel::schlick);
    EXPECT_EQ(metal[1].weight, Vector3f(1, 1, 1));
    EXPECT_EQ(metal[3].weight, Vector3f(0.5f, 0.5f, 0.5f));
    const auto sheen = principled(checkers("sheen"));
    ASSERT_EQ(sheen.size(), 3u);
    EXPECT_NE(sheen[2].mix_texture, no_index);
    EXPECT_EQ(sheen[0].mix_texture, no_index);
    // What is no weight is replaced by its mean, which a notice says.
    const Notices notices;
    const Scene scene =
        parse_mitsuba_xml(mitsuba_scene(R"(<shape type="rectangle"><bsdf type="principled">)" +
                                        checkers("spec_tint") + "</bsdf></shape>"),
                          "in.xml", "in", testing::TempDir());
    EXPECT_TRUE(std::any_of(notices.texts().begin(), notices.texts().end(), [](const auto &text) {
        return text.find("spec_tint: replaced by its mean, 0.3") != std::string::npos;
    }));
    expect_input_error("spec_trans: a surface that is only partly", [&] {
        principled(checkers("metallic") + R"(<float name="spec_trans" value="1"/>)");
    });
}

}  // namespace
}  // namespace rtrays
