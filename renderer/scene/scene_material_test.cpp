// SPDX-License-Identifier: MIT
// Tests the serialization of materials of scene files.
#include "renderer/testing/parsed_scene.h"

namespace rtrays {
namespace {

using Eigen::Vector2d;
using Eigen::Vector3d;
using Eigen::Vector3f;
using Kind = BxdfComponent::Kind;
using Fresnel = BxdfComponent::Fresnel;

/// Returns the components of a material, given as in a scene file.
std::vector<BxdfComponent> components(const std::string &material) {
    return parse(R"({"name": "a", "geometry": {"type": "sphere"}, "material": )" + material + "}")
        .materials()
        .component;
}

BxdfComponent expected(Kind kind, const Rgb &weight) {
    BxdfComponent component;
    component.kind = kind;
    component.weight = weight;
    return component;
}

BxdfComponent with_dielectric(BxdfComponent component, double eta, bool complement) {
    component.fresnel = Fresnel::dielectric;
    component.eta.setConstant(eta);
    component.complement = complement;
    return component;
}

void expect_equal(const std::vector<BxdfComponent> &found,
                  const std::vector<BxdfComponent> &wanted) {
    ASSERT_EQ(found.size(), wanted.size());
    for (size_t i = 0; i < found.size(); ++i) {
        SCOPED_TRACE(i);
        EXPECT_EQ(found[i].kind, wanted[i].kind);
        EXPECT_EQ(found[i].weight, wanted[i].weight);
        EXPECT_EQ(found[i].texture, wanted[i].texture);
        EXPECT_EQ(found[i].fresnel, wanted[i].fresnel);
        EXPECT_EQ(found[i].complement, wanted[i].complement);
        EXPECT_EQ(found[i].fresnel_of_wo, wanted[i].fresnel_of_wo);
        EXPECT_EQ(found[i].eta, wanted[i].eta);
        EXPECT_EQ(found[i].k, wanted[i].k);
        EXPECT_EQ(found[i].sigma, wanted[i].sigma);
        EXPECT_EQ(found[i].exponent, wanted[i].exponent);
        EXPECT_EQ(found[i].alpha, wanted[i].alpha);
        EXPECT_EQ(found[i].distribution, wanted[i].distribution);
        EXPECT_EQ(found[i].side, wanted[i].side);
    }
}

TEST(Materials, DiffuseTypes) {
    expect_equal(components(R"({"type": "lambert", "reflectance": [0.25, 0.5, 1]})"),
                 {expected(Kind::lambert, {0.25f, 0.5f, 1})});
    BxdfComponent rough = expected(Kind::oren_nayar, {0.5f, 0.5f, 0.5f});
    rough.sigma = 0.3;
    expect_equal(
        components(R"({"type": "oren_nayar", "reflectance": [0.5, 0.5, 0.5], "sigma": 0.3})"),
        {rough});
}

TEST(Materials, SpecularTypes) {
    expect_equal(components(R"({"type": "mirror", "reflectance": [1, 0.5, 0.25]})"),
                 {expected(Kind::ideal_reflection, {1, 0.5f, 0.25f})});
    expect_equal(components(R"({"type": "glass", "eta": 1.5, "transmittance": [1, 1, 0.5]})"),
                 {with_dielectric(expected(Kind::ideal_reflection, {1, 1, 1}), 1.5, false),
                  with_dielectric(expected(Kind::ideal_refraction, {1, 1, 0.5f}), 1.5, true)});
    BxdfComponent bare = expected(Kind::ideal_refraction, {1, 1, 1});
    bare.eta.setConstant(1.3);
    expect_equal(components(R"({"type": "refraction", "eta": 1.3, "transmittance": [1, 1, 1]})"),
                 {bare});
}

TEST(Materials, ThinGlassKeepsTheDirectionOfLight) {
    BxdfComponent reflection = expected(Kind::ideal_reflection, {1, 1, 1});
    reflection.fresnel = Fresnel::thin_dielectric;
    reflection.eta = Vector3d(1, 1.5, 1.5);
    BxdfComponent transmission = reflection;
    transmission.kind = Kind::ideal_refraction;
    transmission.complement = true;
    transmission.weight = {1, 0.5f, 0.5f};
    expect_equal(
        components(R"({"type": "thin_glass", "eta": 1.5, "transmittance": [1, 0.5, 0.5]})"),
        {reflection, transmission});
    expect_equal(components(R"({"type": "composite", "components": [
        {"bxdf": "ideal_reflection", "weight": [1, 1, 1],
         "fresnel": {"type": "thin_dielectric", "eta": 1.5}},
        {"bxdf": "ideal_refraction", "weight": [1, 0.5, 0.5], "eta": 1,
         "fresnel": {"type": "thin_dielectric", "eta": 1.5, "complement": true}}]})"),
                 {reflection, transmission});
}

TEST(Materials, SidesMayDiffer) {
    BxdfComponent front = expected(Kind::ideal_reflection, {0.5f, 0.5f, 0.5f});
    BxdfComponent back = expected(Kind::lambert, {0.5f, 0.5f, 0.5f});
    front.side = BxdfComponent::Side::front;
    back.side = BxdfComponent::Side::back;
    const std::string silvered = R"({"type": "composite", "components": [
        {"bxdf": "ideal_reflection", "weight": [0.5, 0.5, 0.5], "side": "front"},
        {"bxdf": "lambert", "weight": [0.5, 0.5, 0.5], "side": "back"}]})";
    expect_equal(components(silvered), {front, back});
    // The side is part of the hash of a scene.
    const auto hash = [](const std::string &material) {
        return parse(R"({"name": "a", "geometry": {"type": "sphere"}, "material": )" + material +
                     "}")
            .hash();
    };
    std::string both = silvered;
    both.replace(both.find("back"), 4, "both");
    EXPECT_NE(hash(silvered), hash(both));
}

TEST(Materials, RoughGlassIsMadeOfMicrofacets) {
    const std::vector<BxdfComponent> found = components(
        R"({"type": "glass", "eta": 1.5, "roughness": [0.25, 0.5], "distribution": "beckmann"})");
    std::vector<BxdfComponent> wanted = {
        with_dielectric(expected(Kind::microfacet_reflection, {1, 1, 1}), 1.5, false),
        with_dielectric(expected(Kind::microfacet_refraction, {1, 1, 1}), 1.5, true)};
    for (BxdfComponent &component : wanted) {
        component.alpha = Vector2d(0.25, 0.5);
        component.distribution = BxdfComponent::Distribution::beckmann;
    }
    expect_equal(found, wanted);
}

TEST(Materials, Metals) {
    BxdfComponent metal = expected(Kind::ideal_reflection, {1, 1, 1});
    metal.fresnel = Fresnel::conductor;
    metal.eta = Vector3d(0.2, 0.9, 1.1);
    metal.k = Vector3d(3.9, 2.4, 2.1);
    expect_equal(components(R"({"type": "metal", "eta": [0.2, 0.9, 1.1], "k": [3.9, 2.4, 2.1]})"),
                 {metal});
    struct Model {
        const char *keys;
        Kind kind;
    };
    for (const Model &model :
         {Model{R"("model": "ggx", "roughness": 0.1)", Kind::microfacet_reflection},
          Model{R"("model": "ward", "roughness": 0.1)", Kind::ward},
          Model{R"("model": "ward_original", "roughness": [0.1, 0.3])", Kind::ward_original},
          Model{R"("model": "blinn", "exponent": 64)", Kind::blinn}}) {
        for (const char *preset : {"silver", "gold", "copper"}) {
            const std::vector<BxdfComponent> found = components(
                std::string(R"({"type": "metal", "fresnel": "approximate", "preset": ")") + preset +
                "\", " + model.keys + "}");
            ASSERT_EQ(found.size(), 1u);
            EXPECT_EQ(found[0].kind, model.kind);
            EXPECT_EQ(found[0].fresnel, Fresnel::conductor_approximate);
            EXPECT_EQ(found[0].exponent, model.kind == Kind::blinn ? 64 : 0);
            EXPECT_EQ(found[0].alpha.x(), model.kind == Kind::blinn ? 0 : 0.1);
        }
    }
}

/// Returns the reflectance at normal incidence, ((eta - 1)^2 + k^2) / ((eta + 1)^2 + k^2).
Vector3d normal_reflectance(const BxdfComponent &metal) {
    const auto k2 = metal.k.array().square();
    return ((metal.eta.array() - 1).square() + k2) / ((metal.eta.array() + 1).square() + k2);
}

TEST(Materials, PresetsHaveTheColoursOfTheMetals) {
    // Well-known reflectances at normal incidence, linear Rec. 709 (for example A. Lagarde,
    // "Feeding a physically based shading model", 2011): silver (0.97, 0.96, 0.92), gold (1.0,
    // 0.77, 0.34), copper (0.96, 0.64, 0.54).
    const auto reflectance = [](const char *preset) {
        return normal_reflectance(
            components(std::string(R"({"type": "metal", "preset": ")") + preset + "\"}")[0]);
    };
    EXPECT_LT((reflectance("silver") - Vector3d(0.97, 0.96, 0.92)).cwiseAbs().maxCoeff(), 0.03);
    EXPECT_LT((reflectance("gold") - Vector3d(0.97, 0.77, 0.34)).cwiseAbs().maxCoeff(), 0.06);
    EXPECT_LT((reflectance("copper") - Vector3d(0.96, 0.64, 0.54)).cwiseAbs().maxCoeff(), 0.03);
}

TEST(Materials, LayeredTypes) {
    expect_equal(
        components(
            R"({"type": "plastic", "reflectance": [0.5, 0, 0], "specular": [0.5, 0.5, 0.5], "eta": 1.5})"),
        {with_dielectric(expected(Kind::ideal_reflection, {0.5f, 0.5f, 0.5f}), 1.5, false),
         with_dielectric(expected(Kind::lambert, {0.5f, 0, 0}), 1.5, true)});
    BxdfComponent blinn = expected(Kind::blinn, {0.25f, 0.25f, 0.25f});
    blinn.exponent = 512;
    expect_equal(
        components(
            R"({"type": "lambert_blinn", "reflectance": [0.5, 0.5, 0.5], "specular": [0.25, 0.25, 0.25],
                               "exponent": 512})"),
        {expected(Kind::lambert, {0.5f, 0.5f, 0.5f}), blinn});
    std::vector<BxdfComponent> paint = {
        with_dielectric(expected(Kind::ideal_reflection, {1, 1, 1}), 1.6, false),
        with_dielectric(expected(Kind::lambert, {0.5f, 0, 0}), 1.6, true)};
    expect_equal(components(R"({"type": "car_paint", "base": [0.5, 0, 0], "eta": 1.6})"), paint);
    paint[1].fresnel_of_wo = true;
    expect_equal(
        components(
            R"({"type": "car_paint", "base": [0.5, 0, 0], "eta": 1.6, "variant": "thesis"})"),
        paint);
}

TEST(Materials, CompositesSayEverything) {
    BxdfComponent diffuse =
        with_dielectric(expected(Kind::oren_nayar, {0.5f, 0.5f, 0.5f}), 1.25, true);
    diffuse.sigma = 0.5;
    diffuse.fresnel_of_wo = true;
    BxdfComponent schlick = expected(Kind::microfacet_reflection, {0.25f, 0.25f, 0.25f});
    schlick.fresnel = Fresnel::schlick;
    schlick.eta = Vector3d(0.5, 0.25, 0);
    schlick.alpha = Vector2d(0.5, 0.5);
    schlick.distribution = BxdfComponent::Distribution::beckmann;
    BxdfComponent refraction =
        with_dielectric(expected(Kind::ideal_refraction, {0.125f, 0.125f, 0.125f}), 1.5, true);
    BxdfComponent metal = expected(Kind::ward, {0.0625f, 0, 0});
    metal.alpha = Vector2d(0.5, 0.25);
    metal.fresnel = Fresnel::conductor;
    metal.eta = Vector3d(1, 2, 3);
    metal.k = Vector3d(3, 2, 1);
    expect_equal(components(R"({"type": "composite", "components": [
        {"bxdf": "oren_nayar", "weight": [0.5, 0.5, 0.5], "sigma": 0.5,
         "fresnel": {"type": "dielectric", "eta": 1.25, "complement": true, "of_wo": true}},
        {"bxdf": "microfacet_reflection", "weight": [0.25, 0.25, 0.25], "alpha": 0.5, "distribution": "beckmann",
         "fresnel": {"type": "schlick", "reflectance": [0.5, 0.25, 0]}},
        {"bxdf": "ideal_refraction", "weight": [0.125, 0.125, 0.125], "eta": 1.5,
         "fresnel": {"type": "dielectric", "complement": true}},
        {"bxdf": "ward", "weight": [0.0625, 0, 0], "alpha": [0.5, 0.25],
         "fresnel": {"type": "conductor", "eta": [1, 2, 3], "k": [3, 2, 1]}}]})"),
                 {diffuse, schlick, refraction, metal});
}

TEST(Materials, PropertiesReachTheRecords) {
    Scene scene = parse(
        R"({"name": "a", "material": "paint", "children": [{"name": "b", "geometry": {"type": "sphere"}}]})",
        R"("materials": {"paint": {"type": "composite", "components": [
                            {"bxdf": "lambert", "weight": [0.5, 0.5, 0.5]},
                            {"bxdf": "ward", "weight": [0.25, 0.25, 0.25], "alpha": 0.5}]}},)");
    scene.set_property("materials.paint.component_1_alpha", "0.25");
    scene.set_property("materials.paint.component_0_weight", "0.125,0.125,0.125");
    scene.set_property("materials.paint.two_sided", "false");
    scene.update(0);
    EXPECT_EQ(scene.materials().component[1].alpha, Vector2d(0.25, 0.25));
    EXPECT_EQ(scene.materials().component[0].weight, Vector3f::Constant(0.125f));
    EXPECT_EQ(scene.materials().two_sided[0], 0);
    EXPECT_EQ(scene.graph().shape_counts().written, 0u)
        << "shapes reference a material and do not copy it";
}

TEST(Materials, HaveAnOpacity) {
    Scene scene = parse(
        R"({"name": "a", "geometry": {"type": "sphere"}, "material": {"type": "mirror", "reflectance": [1, 1, 1]}},
           {"name": "b", "geometry": {"type": "sphere"}, "material": {"type": "composite", "opacity": 0.25,
            "opacity_cutoff": 0.125, "components": [{"bxdf": "lambert", "weight": [0.5, 0.5, 0.5]}]}})");
    const std::vector<MaterialOpacity> &opacities = scene.materials().opacity;
    ASSERT_EQ(opacities.size(), 2u);
    EXPECT_TRUE(opacities[0] == MaterialOpacity());
    EXPECT_EQ(opacities[1].value, 0.25);
    EXPECT_EQ(opacities[1].cutoff, 0.125);
    EXPECT_TRUE(opacities[1].is_opaque()) << "above the cutoff";
    const std::string hash = scene.hash();
    scene.set_property("b.opacity_cutoff", "0.5");
    scene.update(0);
    EXPECT_FALSE(opacities[1].is_opaque());
    EXPECT_NE(scene.hash(), hash);
    scene.set_property("b.opacity", "1");
    scene.update(0);
    EXPECT_EQ(scene.hash(), hash) << "opaque scenes have the hash that they had without opacity";
}

}  // namespace
}  // namespace rtrays
