// SPDX-License-Identifier: MIT
#include "reference/tests/test_materials.h"

namespace rtrays::reference {

using Kind = BxdfComponent::Kind;
using Distribution = BxdfComponent::Distribution;

namespace {

BxdfComponent of_kind(Kind kind, double weight = 1.0) {
    BxdfComponent component;
    component.kind = kind;
    component.weight = Rgb::Constant(static_cast<float>(weight));
    return component;
}

}  // namespace

BxdfComponent lambert(double weight) {
    return of_kind(Kind::lambert, weight);
}

BxdfComponent oren_nayar(double sigma) {
    BxdfComponent component = of_kind(Kind::oren_nayar);
    component.sigma = sigma;
    return component;
}

BxdfComponent disney_diffuse(double roughness, double flatness) {
    BxdfComponent component = of_kind(Kind::disney_diffuse);
    component.disney_roughness = roughness;
    component.flatness = flatness;
    return component;
}

BxdfComponent disney_sheen() {
    return of_kind(Kind::disney_sheen);
}

BxdfComponent disney_clearcoat(double alpha) {
    BxdfComponent component = of_kind(Kind::disney_clearcoat);
    component.alpha = {alpha, alpha};
    component.fresnel = BxdfComponent::Fresnel::schlick;
    component.eta.setConstant(0.04);
    return component;
}

BxdfComponent coated_lambert(Distribution distribution, double alpha, double weight,
                             bool nonlinear) {
    BxdfComponent component = of_kind(Kind::coated_lambert, weight);
    component.distribution = distribution;
    component.alpha = {alpha, alpha};
    component.eta.setConstant(1.5);
    component.nonlinear = nonlinear;
    return component;
}

BxdfComponent ideal_reflection() {
    return of_kind(Kind::ideal_reflection);
}

BxdfComponent ideal_refraction(double eta) {
    BxdfComponent component = of_kind(Kind::ideal_refraction);
    component.eta.setConstant(eta);
    return component;
}

BxdfComponent blinn(double exponent) {
    BxdfComponent component = of_kind(Kind::blinn);
    component.exponent = exponent;
    return component;
}

BxdfComponent ward(double alpha_x, double alpha_y, bool bounded) {
    BxdfComponent component = of_kind(bounded ? Kind::ward : Kind::ward_original);
    component.alpha = {alpha_x, alpha_y};
    return component;
}

BxdfComponent microfacet(Distribution distribution, double alpha_x, double alpha_y) {
    BxdfComponent component = of_kind(Kind::microfacet_reflection);
    component.distribution = distribution;
    component.alpha = {alpha_x, alpha_y};
    return component;
}

BxdfComponent rough_refraction(Distribution distribution, double alpha, double eta) {
    BxdfComponent component = microfacet(distribution, alpha, alpha);
    component.kind = Kind::microfacet_refraction;
    component.eta.setConstant(eta);
    return component;
}

BxdfComponent with_dielectric(BxdfComponent component, double eta, bool complement) {
    component.fresnel = BxdfComponent::Fresnel::dielectric;
    component.eta.setConstant(eta);
    component.complement = complement;
    return component;
}

std::vector<BxdfComponent> smooth_glass(double eta) {
    return {with_dielectric(ideal_reflection(), eta),
            with_dielectric(ideal_refraction(eta), eta, true)};
}

std::vector<BxdfComponent> rough_glass(Distribution distribution, double alpha, double eta) {
    return {with_dielectric(microfacet(distribution, alpha, alpha), eta),
            with_dielectric(rough_refraction(distribution, alpha, eta), eta, true)};
}

std::vector<TestMaterial> rough_materials() {
    const auto ggx = Distribution::ggx, beckmann = Distribution::beckmann;
    BxdfComponent gold = ward(0.2, 0.3);
    gold.fresnel = BxdfComponent::Fresnel::conductor;
    gold.eta = {0.143, 0.374, 1.442};
    gold.k = {3.983, 2.387, 1.603};
    BxdfComponent schlick = microfacet(ggx, 0.3, 0.3);
    schlick.fresnel = BxdfComponent::Fresnel::schlick;
    schlick.eta = {0.04, 0.2, 0.9};
    BxdfComponent printed = with_dielectric(lambert(0.9), 1.5, true);
    printed.fresnel_of_wo = true;
    return {
        {"lambert", {lambert(0.7)}},
        {"oren_nayar 0.1", {oren_nayar(0.1)}, true, false},
        {"oren_nayar pi/4", {oren_nayar(0.25 * pi)}},
        {"oren_nayar pi/2", {oren_nayar(0.5 * pi)}},
        {"blinn 1", {blinn(1)}},
        {"blinn 64", {blinn(64)}},
        {"ward 0.1", {ward(0.1, 0.1)}},
        {"ward 0.3 0.1", {ward(0.3, 0.1)}},
        {"ward 1", {ward(1, 1)}},
        {"ward_original 0.3", {ward(0.3, 0.3, false)}, true, false},
        {"ward gold", {gold}},
        {"ggx 0.2", {microfacet(ggx, 0.2, 0.2)}},
        {"ggx 0.1 0.5", {microfacet(ggx, 0.1, 0.5)}},
        {"ggx 1", {microfacet(ggx, 1, 1)}},
        {"beckmann 0.2", {microfacet(beckmann, 0.2, 0.2)}},
        {"beckmann 0.5 0.1", {microfacet(beckmann, 0.5, 0.1)}},
        {"beckmann 1", {microfacet(beckmann, 1, 1)}},
        {"schlick ggx", {schlick}},
        {"rough ggx glass", rough_glass(ggx, 0.3, 1.5)},
        {"rough beckmann glass", rough_glass(beckmann, 0.2, 1.5)},
        {"rough inverted glass", rough_glass(beckmann, 0.3, 1.0 / 1.5)},
        {"rough ggx refraction", {rough_refraction(ggx, 0.4, 1.9)}},
        {"plastic", {with_dielectric(blinn(64), 1.5), with_dielectric(lambert(0.8), 1.5, true)}},
        {"diffuse and gloss",
         {lambert(0.5), microfacet(ggx, 0.3, 0.2), oren_nayar(0.5)},
         true,
         false},
        {"disney_diffuse 0", {disney_diffuse(0.0, 0.0)}},
        {"disney_diffuse 1", {disney_diffuse(1.0, 0.25)}, true, false},
        {"disney_sheen", {disney_sheen()}},
        {"disney_clearcoat", {disney_clearcoat(0.1)}},
        {"smooth coat",
         {with_dielectric(ideal_reflection(), 1.5), coated_lambert(ggx, 0.0, 1.0, false)}},
        {"rough ggx coat",
         {with_dielectric(microfacet(ggx, 0.3, 0.3), 1.5), coated_lambert(ggx, 0.3, 1.0, true)}},
        {"rough beckmann coat",
         {with_dielectric(microfacet(beckmann, 1, 1), 1.5),
          coated_lambert(beckmann, 1.0, 0.9, false)}},
        {"car paint",
         {with_dielectric(ideal_reflection(), 1.5), with_dielectric(lambert(0.9), 1.5, true)}},
        {"car paint as printed", {with_dielectric(ideal_reflection(), 1.5), printed}, false, false},
    };
}

Bsdf make_bsdf(const std::vector<BxdfComponent> &components, bool two_sided,
               const TextureArrays &textures) {
    MaterialArrays materials;
    materials.name = {"test"};
    materials.first_component = {0};
    materials.component_count = {static_cast<uint32_t>(components.size())};
    materials.two_sided = {static_cast<uint8_t>(two_sided ? 1 : 0)};
    materials.component = components;
    return make_bsdfs(materials, textures).front();
}

}  // namespace rtrays::reference
