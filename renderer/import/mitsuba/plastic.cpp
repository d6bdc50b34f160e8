// SPDX-License-Identifier: MIT
#include "renderer/import/mitsuba/plastic.h"

#include <fmt/format.h>

#include "renderer/base/error.h"
#include "renderer/scene/cores/bxdf_parameters.h"

namespace rtrays::mitsuba {

namespace {

using Eigen::Vector3d;
using Kind = BxdfComponent::Kind;

/// Fraction of diffuse light from inside that a coat of index `eta` > 1 reflects. This is the fit
/// of Egan and Hilgeman 1973. For eta = 1.5 it is 8e-4 above the exact integral (Walsh 1926).
/// Mitsuba uses the same fit (fresnel.h), so that the images agree.
double internal_reflectance(double eta) {
    return 0.0636 * eta + 0.6681 + (0.7099 - 1.4399 / eta) / eta;
}

/// Returns the same fraction for a rough coat as Mitsuba computes it (roughplastic.cpp): twice the
/// mean over 64 cosines from 0 to 1, of which the last should count half. It is about 1.4 % below
/// the exact integral.
double internal_reflectance(const Coat &coat) {
    constexpr int cosines = 64;
    double sum = 0;
    for (int i = 1; i < cosines; ++i) {
        const double cosine = static_cast<double>(i) / (cosines - 1);
        sum += cosine * coat_inner_reflectance(coat, cosine);
    }
    return 2 * sum / cosines;
}

/// Makes the base below the coat. If the base's colour is a factor of what it reflects and the coat
/// is smooth, it is a Lambert component, which needs less code.
BxdfComponent base_below(const Coat &coat, const Vector3d &reflectance, bool nonlinear,
                         bool textured) {
    BxdfComponent base;
    set_coat(coat, base);
    if (coat.alpha == 0 && !(nonlinear && textured)) {
        base.kind = Kind::lambert;
        base.weight = plastic_base_weight(reflectance, coat.eta, nonlinear).cast<float>();
        base.fresnel = BxdfComponent::Fresnel::dielectric;
        base.complement = true;
        return base;
    }
    base.kind = Kind::coated_lambert;
    base.inner_reflectance = plastic_inner_reflectance(coat);
    base.nonlinear = nonlinear && textured;
    base.weight = reflectance.cast<float>();
    if (nonlinear && !textured) {
        // One colour has an equivalent of which the reflection is a multiple.
        base.weight =
            reflectance
                .unaryExpr([&](double rho) {
                    return rho * (1 - base.inner_reflectance) / (1 - rho * base.inner_reflectance);
                })
                .cast<float>();
    }
    return base;
}

std::vector<MaterialComponent> expand(const ParameterSet &p) {
    const Coat coat = coat_of(p, "eta", "roughness", "distribution");
    MaterialComponent surface;
    surface.parameter = "specular_reflectance";
    surface.texture = p.texture(surface.parameter);
    surface.bxdf.kind = coat.alpha > 0 ? Kind::microfacet_reflection : Kind::ideal_reflection;
    surface.bxdf.weight = p.vector3(surface.parameter).cast<float>();
    surface.bxdf.fresnel = BxdfComponent::Fresnel::dielectric;
    set_coat(coat, surface.bxdf);

    MaterialComponent base;
    base.parameter = "diffuse_reflectance";
    base.texture = p.texture(base.parameter);
    base.bxdf = base_below(coat, p.vector3(base.parameter), p.get<bool>("nonlinear"),
                           base.texture != nullptr);
    return {surface, base};
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
}

}  // namespace

Vector3d plastic_base_weight(const Vector3d &reflectance, double eta, bool nonlinear) {
    const double internal = internal_reflectance(eta);
    return reflectance.unaryExpr(
        [&](double rho) { return rho / (eta * eta * (1 - (nonlinear ? rho : 1.0) * internal)); });
}

double plastic_inner_reflectance(const Coat &coat) {
    return coat.alpha > 0 ? internal_reflectance(coat) : internal_reflectance(coat.eta);
}

const std::shared_ptr<const MaterialType> &plastic_type() {
    static const std::shared_ptr<const MaterialType> type = [] {
        using rows::Need;
        auto made = std::make_shared<MaterialType>();
        made->name = "mitsuba_plastic";
        made->parameters = {
            rows::colour("diffuse_reflectance", "albedo of the diffuse base"),
            rows::colour("specular_reflectance", "factor of the coat's reflection",
                         Need::defaulted),
            rows::coat_eta("eta"),
            rows::coat_alpha("roughness"),
            rows::distribution("distribution"),
            rows::nonlinear("nonlinear"),
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
