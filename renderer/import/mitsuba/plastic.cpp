// SPDX-License-Identifier: MIT
#include "renderer/import/mitsuba/plastic.h"

#include <fmt/format.h>

#include "renderer/base/error.h"
#include "renderer/scene/cores/bxdf_parameters.h"

namespace rtrays::mitsuba {

namespace {

using Eigen::Vector3d;

/// Fraction of diffuse light from inside that a coat of index `eta` > 1 reflects. This is the fit
/// of Egan and Hilgeman 1973. For eta = 1.5 it is 8e-4 above the exact integral (Walsh 1926).
/// Mitsuba uses the same fit (fresnel.h), so that the images agree.
double internal_reflectance(double eta) {
    return 0.0636 * eta + 0.6681 + (0.7099 - 1.4399 / eta) / eta;
}

std::vector<MaterialComponent> expand(const ParameterSet &p) {
    using Kind = BxdfComponent::Kind;
    const double eta = p.number("eta");
    const Eigen::Vector2d &alpha = p.get<Eigen::Vector2d>("roughness");

    MaterialComponent coat;
    coat.parameter = "specular_reflectance";
    coat.texture = p.texture(coat.parameter);
    coat.bxdf.kind = alpha.maxCoeff() > 0 ? Kind::microfacet_reflection : Kind::ideal_reflection;
    coat.bxdf.weight = p.vector3(coat.parameter).cast<float>();
    coat.bxdf.alpha = alpha;
    coat.bxdf.distribution = p.choice<BxdfComponent::Distribution>("distribution");

    MaterialComponent base;
    base.parameter = "diffuse_reflectance";
    base.texture = p.texture(base.parameter);
    base.bxdf.kind = Kind::lambert;
    base.bxdf.weight =
        plastic_base_weight(p.vector3(base.parameter), eta, p.get<bool>("nonlinear")).cast<float>();
    base.bxdf.complement = true;

    for (MaterialComponent *part : {&coat, &base}) {
        part->bxdf.fresnel = BxdfComponent::Fresnel::dielectric;
        part->bxdf.eta.setConstant(eta);
    }
    return {coat, base};
}

void check(const ParameterSet &p) {
    for (const char *name : {"diffuse_reflectance", "specular_reflectance"}) {
        const std::shared_ptr<Texture> texture = p.texture(name);
        if (texture != nullptr &&
            texture->largest_texel().cast<double>().cwiseProduct(p.vector3(name)).maxCoeff() > 1) {
            throw input_error(
                fmt::format("{}: texture '{}' has texels above 1", name, texture->name()));
        }
    }
    if (p.get<bool>("nonlinear") && p.texture("diffuse_reflectance") != nullptr) {
        throw input_error(
            "nonlinear: unsupported with a texture as diffuse_reflectance, because the base's "
            "reflection is not proportional to its colour; set nonlinear to false, or give "
            "diffuse_reflectance as one colour");
    }
}

}  // namespace

Vector3d plastic_base_weight(const Vector3d &reflectance, double eta, bool nonlinear) {
    const double internal = internal_reflectance(eta);
    return reflectance.unaryExpr(
        [&](double rho) { return rho / (eta * eta * (1 - (nonlinear ? rho : 1.0) * internal)); });
}

const std::shared_ptr<const MaterialType> &plastic_type() {
    static const std::shared_ptr<const MaterialType> type = [] {
        using rows::Need;
        auto made = std::make_shared<MaterialType>();
        made->name = "mitsuba_plastic";
        // The fit exceeds 1 near eta = 4.
        constexpr Range eta{1, 3, false, true};
        made->parameters = {
            rows::colour("diffuse_reflectance", "albedo of the diffuse base"),
            rows::colour("specular_reflectance", "factor of the coat's reflection",
                         Need::defaulted),
            {"eta", "index of refraction of the coat relative to the outside", 1.5, Need::required,
             eta},
            {"roughness", "microfacet roughness, 0 if ideally smooth", Eigen::Vector2d(0, 0),
             Need::defaulted, ranges::unit},
            rows::distribution("distribution"),
            {"nonlinear", "whether reflections between base and coat saturate the base's colour",
             false},
        };
        const ParameterTable &common = common_material_parameters();
        made->parameters.insert(made->parameters.end(), common.begin(), common.end());
        made->expand = expand;
        made->check = check;
        return made;
    }();
    return type;
}

}  // namespace rtrays::mitsuba
