// SPDX-License-Identifier: MIT
// The table of material types and their expansion to atomic BxDFs: thesis 3.3.6, with equations as
// cited.
#include <fmt/format.h>

#include <cmath>
#include <utility>

#include "renderer/scene/cores/bxdf_parameters.h"
#include "renderer/scene/cores/coat.h"
#include "renderer/scene/cores/material.h"
#include "renderer/scene/cores/metals.h"

namespace rtrays {

namespace {

using Kind = BxdfComponent::Kind;
using Fresnel = BxdfComponent::Fresnel;
using Distribution = BxdfComponent::Distribution;
using Components = std::vector<MaterialComponent>;
using Eigen::Vector2d;
using Eigen::Vector3d;
using rows::Need;

/// Makes an ideal component whose weight is the colour `parameter`.
MaterialComponent component(Kind kind, const ParameterSet &p, const std::string &parameter) {
    MaterialComponent made;
    made.bxdf.kind = kind;
    made.bxdf.weight = p.vector3(parameter).cast<float>();
    made.parameter = parameter;
    made.texture = p.texture(parameter);
    return made;
}

MaterialComponent with_dielectric(MaterialComponent made, double eta, bool complement) {
    made.bxdf.fresnel = Fresnel::dielectric;
    made.bxdf.complement = complement;
    made.bxdf.eta.setConstant(eta);
    return made;
}

/// Makes an ideal or a microfacet reflection or refraction, depending on the roughness.
MaterialComponent surface(bool refracts, const ParameterSet &p, const std::string &parameter) {
    const Vector2d &alpha = p.get<Vector2d>("roughness");
    const bool rough = alpha.maxCoeff() > 0;
    MaterialComponent made =
        component(refracts ? (rough ? Kind::microfacet_refraction : Kind::ideal_refraction)
                           : (rough ? Kind::microfacet_reflection : Kind::ideal_reflection),
                  p, parameter);
    made.bxdf.alpha = alpha;
    made.bxdf.distribution = p.choice<Distribution>("distribution");
    made.bxdf.roughness_squared = p.get<bool>("roughness_squared");
    made.roughness_texture = p.texture("roughness");
    return made;
}

void check_roughness(const ParameterSet &p) {
    const Vector2d &alpha = p.get<Vector2d>("roughness");
    if (alpha.maxCoeff() > 0 && alpha.minCoeff() < rows::roughness.min) {
        throw input_error(
            fmt::format("roughness: [{}, {}] is out of range; use 0 for both axes (ideally smooth) "
                        "or values within {}",
                        alpha[0], alpha[1], rows::roughness.text()));
    }
}

/// Rejects rough interfaces with eta near 1.
void check_rough_refraction(const ParameterSet &p) {
    check_roughness(p);
    const double eta = p.number("eta");
    if (p.get<Vector2d>("roughness").maxCoeff() > 0 && !rows::may_be_rough(eta)) {
        throw input_error(
            fmt::format("eta: {} does not refract, so it cannot be rough; set roughness to 0 or "
                        "choose an eta that differs from 1 by at least {}",
                        eta, rows::least_rough_bend));
    }
}

Parameter smooth_or_rough() {
    return {"roughness",
            "roughness along the tangent and across it; 0 is ideally smooth",
            Vector2d(0, 0),
            Need::defaulted,
            ranges::unit,
            {},
            true};
}

Components expand_glass(const ParameterSet &p) {  // thesis (3.53)
    const double eta = p.number("eta");
    return {with_dielectric(surface(false, p, "reflectance"), eta, false),
            with_dielectric(surface(true, p, "transmittance"), eta, true)};
}

Components expand_thin_glass(const ParameterSet &p) {
    const double eta = p.number("eta");
    Components made = {component(Kind::ideal_reflection, p, "reflectance"),
                       component(Kind::ideal_refraction, p, "transmittance")};
    for (MaterialComponent &part : made) {
        part.bxdf.fresnel = Fresnel::thin_dielectric;
        part.bxdf.complement = part.bxdf.kind == Kind::ideal_refraction;
        part.bxdf.eta = {1, eta, eta};
    }
    return made;
}

Components expand_refraction(const ParameterSet &p) {
    MaterialComponent made = component(Kind::ideal_refraction, p, "transmittance");
    made.bxdf.eta.setConstant(p.number("eta"));
    return {made};
}

/// Surface models of metals. "ideal" has no microfacets. `parameter` is the name of the parameter
/// that the model requires, or nullptr.
struct MetalModel {
    const char *name;
    Kind kind;
    Distribution distribution;
    const char *parameter;
};
constexpr MetalModel metal_models[] = {
    {"ideal", Kind::ideal_reflection, Distribution::ggx, nullptr},
    {"ggx", Kind::microfacet_reflection, Distribution::ggx, "roughness"},
    {"beckmann", Kind::microfacet_reflection, Distribution::beckmann, "roughness"},
    {"blinn", Kind::blinn, Distribution::ggx, "exponent"},
    {"ward", Kind::ward, Distribution::ggx, "roughness"},
    {"ward_original", Kind::ward_original, Distribution::ggx, "roughness"},
};

template <typename Table>
std::vector<std::string> names(const Table &table) {
    std::vector<std::string> all;
    for (const auto &row : table) {
        all.emplace_back(row.name);
    }
    return all;
}

ParameterTable metal_parameters() {
    return {
        {"preset", "a metal by name", std::string(), Need::optional, ranges::any, names(metals())},
        rows::conductor_eta("eta", Need::optional),
        rows::conductor_k("k", Need::optional),
        rows::colour("reflectance", "factor of the reflected light", Need::defaulted),
        {"model", "microfacet model of the surface", std::string("ideal"), Need::defaulted,
         ranges::any, names(metal_models)},
        rows::alpha("roughness", Need::optional),
        rows::roughness_squared("roughness_squared"),
        rows::exponent("exponent", Need::optional),
        {"fresnel",
         "Fresnel term: exact, approximate by thesis (3.28), or ideal, which is 1",
         std::string("exact"),
         Need::defaulted,
         ranges::any,
         {"exact", "approximate", "ideal"}},
    };
}

void check_metal(const ParameterSet &p) {
    const bool ideal = p.text("fresnel") == "ideal";
    const bool given = p.has("eta") || p.has("k");
    if (given && (p.has("preset") || !p.has("eta") || !p.has("k"))) {
        throw input_error("a metal takes either 'preset', or both 'eta' and 'k'");
    }
    if (!ideal && !given && !p.has("preset")) {
        throw input_error("a metal needs a 'preset', or 'eta' and 'k', or \"fresnel\": \"ideal\"");
    }
    const MetalModel &model = metal_models[p.choice<size_t>("model")];
    for (const char *name : {"roughness", "exponent"}) {
        const bool needed = model.parameter != nullptr && std::string(model.parameter) == name;
        if (needed != p.has(name)) {
            throw input_error(fmt::format("a metal of model '{}' {} '{}'", model.name,
                                          needed ? "needs" : "does not take", name));
        }
    }
}

Components expand_metal(const ParameterSet &p) {
    constexpr Fresnel terms[] = {Fresnel::conductor, Fresnel::conductor_approximate,
                                 Fresnel::ideal};
    const MetalModel &model = metal_models[p.choice<size_t>("model")];
    MaterialComponent made = component(model.kind, p, "reflectance");
    made.bxdf.distribution = model.distribution;
    made.bxdf.fresnel = terms[p.choice<size_t>("fresnel")];
    if (p.has("preset")) {
        const Metal &metal = metals()[p.choice<size_t>("preset")];
        made.bxdf.eta = metal.eta;
        made.bxdf.k = metal.k;
    } else if (p.has("eta")) {
        made.bxdf.eta = p.vector3("eta");
        made.bxdf.k = p.vector3("k");
    }
    if (p.has("roughness")) {
        made.bxdf.alpha = p.get<Vector2d>("roughness");
        made.bxdf.roughness_squared = p.get<bool>("roughness_squared");
        made.roughness_texture = p.texture("roughness");
    }
    if (p.has("exponent")) {
        made.bxdf.exponent = p.number("exponent");
    }
    return {made};
}

Components expand_plastic(const ParameterSet &p) {
    const double eta = p.number("eta");
    return {with_dielectric(surface(false, p, "specular"), eta, false),
            with_dielectric(component(Kind::lambert, p, "reflectance"), eta, true)};
}

Components expand_coated_diffuse(const ParameterSet &p) {
    const Coat coat = coat_of(p, "eta", "roughness", "distribution");
    MaterialComponent surface = component(
        coat.alpha > 0 ? Kind::microfacet_reflection : Kind::ideal_reflection, p, "specular");
    set_coat(coat, surface.bxdf);
    MaterialComponent base = component(Kind::coated_lambert, p, "reflectance");
    set_coat(coat, base.bxdf);
    base.bxdf.nonlinear = p.get<bool>("nonlinear");
    return {with_dielectric(surface, coat.eta, false), base};
}

Components expand_lambert_blinn(const ParameterSet &p) {  // thesis (3.54)
    MaterialComponent blinn = component(Kind::blinn, p, "specular");
    blinn.bxdf.exponent = p.number("exponent");
    return {component(Kind::lambert, p, "reflectance"), blinn};
}

Components expand_car_paint(const ParameterSet &p) {  // thesis (3.55)
    const double eta = p.number("eta");
    MaterialComponent coat;
    coat.bxdf.kind = Kind::ideal_reflection;
    coat.parameter = "eta";
    MaterialComponent base = with_dielectric(component(Kind::lambert, p, "base"), eta, true);
    base.bxdf.fresnel_of_wo = p.text("variant") == "thesis";
    return {with_dielectric(coat, eta, false), base};
}

Components expand_oren_nayar(const ParameterSet &p) {
    MaterialComponent made = component(Kind::oren_nayar, p, "reflectance");
    made.bxdf.sigma = p.number("sigma");
    return {made};
}

MaterialType material(const char *name, ParameterTable parameters,
                      Components (*expand)(const ParameterSet &),
                      void (*check)(const ParameterSet &) = nullptr) {
    const ParameterTable &common = common_material_parameters();
    parameters.insert(parameters.end(), common.begin(), common.end());
    MaterialType type;
    type.name = name;
    type.parameters = std::move(parameters);
    type.expand = expand;
    type.check = [expand, check](const ParameterSet &p) {
        if (check != nullptr) {
            check(p);
        }
        check_common_parameters(p);
        check_components(expand(p));
    };
    return type;
}

}  // namespace

const std::vector<MaterialType> &material_types() {
    using namespace rows;
    static const std::vector<MaterialType> types = {
        material("lambert", {colour("reflectance", "albedo")},
                 [](const ParameterSet &p) -> Components {
                     return {component(Kind::lambert, p, "reflectance")};
                 }),
        material("oren_nayar", {colour("reflectance", "albedo"), sigma("sigma")},
                 expand_oren_nayar),
        material("mirror", {colour("reflectance", "factor of the reflected light")},
                 [](const ParameterSet &p) -> Components {
                     return {component(Kind::ideal_reflection, p, "reflectance")};
                 }),
        material("glass",
                 {dielectric_eta("eta", Need::defaulted),
                  colour("reflectance", "factor of the reflected light", Need::defaulted),
                  colour("transmittance", "factor of the refracted light", Need::defaulted),
                  smooth_or_rough(), roughness_squared("roughness_squared"),
                  distribution("distribution")},
                 expand_glass, check_rough_refraction),
        material("thin_glass",
                 {dielectric_eta("eta", Need::defaulted),
                  colour("reflectance", "factor of the reflected light", Need::defaulted),
                  colour("transmittance", "factor of the transmitted light", Need::defaulted)},
                 expand_thin_glass),
        material("refraction",
                 {dielectric_eta("eta", Need::defaulted),
                  colour("transmittance", "factor of the refracted light")},
                 expand_refraction),
        material("metal", metal_parameters(), expand_metal, check_metal),
        material("plastic",
                 {colour("reflectance", "albedo of the base"),
                  colour("specular", "factor of the light reflected by the coat", Need::defaulted),
                  dielectric_eta("eta", Need::defaulted), smooth_or_rough(),
                  roughness_squared("roughness_squared"), distribution("distribution")},
                 expand_plastic, check_roughness),
        material("coated_diffuse",
                 {colour("reflectance", "albedo of the base"),
                  colour("specular", "factor of the light reflected by the coat", Need::defaulted),
                  coat_eta("eta", Need::defaulted), coat_alpha("roughness"),
                  distribution("distribution"), nonlinear("nonlinear")},
                 expand_coated_diffuse),
        material("lambert_blinn",
                 {colour("reflectance", "albedo"), colour("specular", "weight of the highlight"),
                  exponent("exponent")},
                 expand_lambert_blinn),
        material("car_paint",
                 {colour("base", "albedo under the coat"),
                  dielectric_eta("eta", Need::defaulted),
                  {"variant",
                   "symmetric: reciprocal; thesis: as in thesis (3.55)",
                   std::string("symmetric"),
                   Need::defaulted,
                   ranges::any,
                   {"symmetric", "thesis"}}},
                 expand_car_paint),
    };
    return types;
}

}  // namespace rtrays
