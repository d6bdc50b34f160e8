// SPDX-License-Identifier: MIT
#include "renderer/scene/cores/composite.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "renderer/scene/cores/bxdf_parameters.h"
#include "renderer/scene/cores/coat.h"

namespace rtrays {

namespace {

using Kind = BxdfComponent::Kind;
using Fresnel = BxdfComponent::Fresnel;
using rows::Need;

size_t index_in(const std::vector<std::string> &names, const std::string &name, const char *what) {
    const auto found = std::find(names.begin(), names.end(), name);
    if (found == names.end()) {
        throw input_error(
            fmt::format("{} '{}' is not one of: {}", what, name, fmt::join(names, ", ")));
    }
    return static_cast<size_t>(found - names.begin());
}

struct Part {
    Kind kind;
    Fresnel fresnel;
    std::string prefix;

    std::string fresnel_prefix() const { return prefix + "fresnel_"; }
    bool refracts() const {
        return kind == Kind::ideal_refraction || kind == Kind::microfacet_refraction;
    }
    bool is_thin() const { return fresnel == Fresnel::thin_dielectric; }
    bool is_diffuse() const { return kind == Kind::lambert || kind == Kind::oren_nayar; }
    bool is_coated() const { return kind == Kind::coated_lambert; }
    bool is_conductor() const {
        return fresnel == Fresnel::conductor || fresnel == Fresnel::conductor_approximate;
    }
    bool has_alpha() const {
        return kind == Kind::ward || kind == Kind::ward_original || has_distribution();
    }
    bool has_distribution() const {
        return kind == Kind::microfacet_reflection || kind == Kind::microfacet_refraction;
    }
};

void add_bxdf_rows(const Part &part, ParameterTable &table) {
    table.push_back(rows::colour(part.prefix + "weight", "weight of the component"));
    table.push_back({part.prefix + "mix",
                     "share of the component in a mixture; the luminance of a texture scales it",
                     1.0,
                     Need::defaulted,
                     ranges::unit,
                     {},
                     true});
    table.push_back({part.prefix + "mix_inverted", "the rest of the mixture, 1 - mix", false});
    if (part.kind == Kind::oren_nayar) {
        table.push_back(rows::sigma(part.prefix + "sigma"));
    }
    if (part.kind == Kind::blinn) {
        table.push_back(rows::exponent(part.prefix + "exponent"));
    }
    if (part.has_alpha()) {
        table.push_back(rows::alpha(part.prefix + "alpha"));
        table.push_back(rows::roughness_squared(part.prefix + "roughness_squared"));
    }
    if (part.has_distribution() || part.is_coated()) {
        table.push_back(rows::distribution(part.prefix + "distribution"));
    }
    if (part.kind == Kind::disney_diffuse) {
        table.push_back({part.prefix + "roughness",
                         "Burley's roughness",
                         0.5,
                         Need::required,
                         ranges::unit,
                         {},
                         true});
        table.push_back({part.prefix + "flatness", "share of the flat diffuse reflection", 0.0,
                         Need::defaulted, ranges::unit});
    }
    if (part.kind == Kind::disney_clearcoat) {
        table.push_back({part.prefix + "alpha",
                         "roughness of GTR1",
                         0.1,
                         Need::required,
                         {1e-3, 0.5, true, true}});
    }
    if (part.is_coated()) {
        table.push_back(rows::coat_alpha(part.prefix + "alpha"));
        table.push_back(rows::coat_eta(part.prefix + "eta"));
        table.push_back(rows::nonlinear(part.prefix + "nonlinear"));
        table.push_back({part.prefix + "inner_reflectance",
                         "share of diffuse light from below that the coat reflects back; computed "
                         "from the coat if not given",
                         0.0,
                         Need::optional,
                         {0, 1, true, false}});
    }
    if (part.refracts()) {
        table.push_back(rows::dielectric_eta(part.prefix + "eta"));
    } else {
        table.push_back({part.prefix + "side",
                         "side of the surface on which the component reflects", std::string("both"),
                         Need::defaulted, ranges::any, side_names()});
    }
}

void add_fresnel_rows(const Part &part, ParameterTable &table) {
    const std::string prefix = part.fresnel_prefix();
    if (part.fresnel == Fresnel::ideal) {
        return;
    }
    if (part.fresnel == Fresnel::dielectric) {
        // A refracting component has its own eta, which the Fresnel term shares.
        table.push_back(rows::dielectric_eta(prefix + "eta",
                                             part.refracts() ? Need::optional : Need::required));
    } else if (part.is_thin()) {
        Parameter eta = rows::dielectric_eta(prefix + "eta");
        eta.help = "index of refraction of the plate over that around it";
        table.push_back(eta);
    } else if (part.is_conductor()) {
        table.push_back(rows::conductor_eta(prefix + "eta"));
        table.push_back(rows::conductor_k(prefix + "k"));
    } else {
        Parameter reflectance =
            rows::colour(prefix + "reflectance", "reflectance at normal incidence");
        reflectance.textured = false;
        table.push_back(reflectance);
    }
    table.push_back({prefix + "complement", "1 - F instead of F", false});
    if (part.is_diffuse()) {
        table.push_back(
            {prefix + "of_wo", "F at wo only, as in thesis (3.55): not reciprocal", false});
    }
}

void check_coat(const Part &part, const ParameterSet &p) {
    const Coat coat =
        coat_of(p, part.prefix + "eta", part.prefix + "alpha", part.prefix + "distribution");
    const std::string inner = part.prefix + "inner_reflectance";
    if (!p.has(inner)) {
        return;
    }
    constexpr double tolerance = 2e-3;  // Mitsuba's fit for smooth coats is above the integral
    const double largest = coat_diffuse_reflectance(coat);
    if (p.number(inner) > largest + tolerance) {
        throw input_error(fmt::format(
            "{}: {} exceeds {:.4f}, which the coat reflects back, so the base would return more "
            "light than arrives; omit it",
            inner, p.number(inner), largest));
    }
}

void check_part(const Part &part, const ParameterSet &p) {
    if (part.is_coated()) {
        check_coat(part, p);
    }
    if (!part.refracts()) {
        return;
    }
    const double eta = p.number(part.prefix + "eta");
    const std::string fresnel_eta = part.fresnel_prefix() + "eta";
    if (part.fresnel == Fresnel::dielectric && p.has(fresnel_eta) && p.number(fresnel_eta) != eta) {
        throw input_error(fmt::format("{}: {} differs from the component's eta, {}; omit it",
                                      fresnel_eta, p.number(fresnel_eta), eta));
    }
    if (part.is_thin() && eta != 1) {
        throw input_error(
            fmt::format("{}eta: {} bends light, which a thin_dielectric does not; set it to 1",
                        part.prefix, eta));
    }
    if (part.kind == Kind::microfacet_refraction && !rows::may_be_rough(eta)) {
        throw input_error(fmt::format(
            "{}eta: {} does not refract, so it cannot be rough; use ideal_refraction, or an "
            "eta that differs from 1 by at least {}",
            part.prefix, eta, rows::least_rough_bend));
    }
}

MaterialComponent expand_part(const Part &part, const ParameterSet &p) {
    MaterialComponent made;
    BxdfComponent &bxdf = made.bxdf;
    made.parameter = part.prefix + "weight";
    made.texture = p.texture(made.parameter);
    bxdf.kind = part.kind;
    bxdf.weight = p.vector3(made.parameter).cast<float>();
    bxdf.fresnel = part.fresnel;
    made.mix_texture = p.texture(part.prefix + "mix");
    bxdf.mix = p.number(part.prefix + "mix");
    bxdf.mix_inverted = p.get<bool>(part.prefix + "mix_inverted");
    if (made.mix_texture == nullptr) {
        bxdf.weight *= static_cast<float>(bxdf.mix_inverted ? 1 - bxdf.mix : bxdf.mix);
        bxdf.mix = 1;
        bxdf.mix_inverted = false;
    }
    if (part.kind == Kind::oren_nayar) {
        bxdf.sigma = p.number(part.prefix + "sigma");
    }
    if (part.kind == Kind::blinn) {
        bxdf.exponent = p.number(part.prefix + "exponent");
    }
    if (part.has_alpha()) {
        bxdf.alpha = p.get<Eigen::Vector2d>(part.prefix + "alpha");
        made.roughness_texture = p.texture(part.prefix + "alpha");
        bxdf.roughness_squared = p.get<bool>(part.prefix + "roughness_squared");
    }
    if (part.kind == Kind::disney_diffuse) {
        bxdf.disney_roughness = p.number(part.prefix + "roughness");
        bxdf.flatness = p.number(part.prefix + "flatness");
        made.roughness_texture = p.texture(part.prefix + "roughness");
    }
    if (part.kind == Kind::disney_clearcoat) {
        bxdf.alpha.setConstant(p.number(part.prefix + "alpha"));
    }
    if (part.is_coated()) {
        set_coat(
            coat_of(p, part.prefix + "eta", part.prefix + "alpha", part.prefix + "distribution"),
            bxdf);
        bxdf.nonlinear = p.get<bool>(part.prefix + "nonlinear");
        const std::string inner = part.prefix + "inner_reflectance";
        bxdf.inner_reflectance = p.has(inner) ? p.number(inner) : -1.0;
    }
    if (part.has_distribution()) {
        bxdf.distribution = p.choice<BxdfComponent::Distribution>(part.prefix + "distribution");
    }
    const std::string prefix = part.fresnel_prefix();
    if (!part.refracts()) {
        bxdf.side = p.choice<BxdfComponent::Side>(part.prefix + "side");
    }
    if (part.is_thin()) {
        const double eta = p.number(prefix + "eta");
        bxdf.eta = {1, eta, eta};
    } else if (part.refracts()) {
        bxdf.eta.setConstant(p.number(part.prefix + "eta"));
    } else if (part.fresnel == Fresnel::dielectric) {
        bxdf.eta.setConstant(p.number(prefix + "eta"));
    } else if (part.is_conductor()) {
        bxdf.eta = p.vector3(prefix + "eta");
        bxdf.k = p.vector3(prefix + "k");
    } else if (part.fresnel == Fresnel::schlick) {
        bxdf.eta = p.vector3(prefix + "reflectance");
    }
    bxdf.complement = part.fresnel != Fresnel::ideal && p.get<bool>(prefix + "complement");
    bxdf.fresnel_of_wo =
        part.fresnel != Fresnel::ideal && part.is_diffuse() && p.get<bool>(prefix + "of_wo");
    return made;
}

Part make_part(const CompositePart &names, size_t index) {
    const Part part{static_cast<Kind>(index_in(bxdf_names(), names.bxdf, "bxdf")),
                    static_cast<Fresnel>(index_in(fresnel_names(), names.fresnel, "fresnel")),
                    part_prefix(index)};
    if (part.refracts() && part.fresnel != Fresnel::ideal && part.fresnel != Fresnel::dielectric &&
        !part.is_thin()) {
        throw input_error(
            fmt::format("component {}: a refracting component supports the Fresnel terms ideal, "
                        "dielectric and thin_dielectric, not {}",
                        index, names.fresnel));
    }
    if (part.is_coated() && part.fresnel != Fresnel::ideal) {
        throw input_error(fmt::format(
            "component {}: the coat of coated_lambert has its own Fresnel term; omit 'fresnel'",
            index));
    }
    return part;
}

}  // namespace

const std::vector<std::string> &side_names() {
    static const std::vector<std::string> names = {"both", "front", "back"};
    return names;
}

const std::vector<std::string> &bxdf_names() {
    static const std::vector<std::string> names = {"lambert",
                                                   "oren_nayar",
                                                   "ideal_reflection",
                                                   "ideal_refraction",
                                                   "blinn",
                                                   "ward",
                                                   "ward_original",
                                                   "microfacet_reflection",
                                                   "microfacet_refraction",
                                                   "coated_lambert",
                                                   "disney_diffuse",
                                                   "disney_sheen",
                                                   "disney_clearcoat"};
    return names;
}

const std::vector<std::string> &fresnel_names() {
    static const std::vector<std::string> names = {
        "ideal", "dielectric", "conductor", "conductor_approximate", "schlick", "thin_dielectric"};
    return names;
}

std::string part_prefix(size_t index) {
    return fmt::format("component_{}_", index);
}

std::shared_ptr<const MaterialType> composite_type(const std::vector<CompositePart> &parts) {
    if (parts.empty()) {
        throw input_error("a composite needs at least one component");
    }
    auto type = std::make_shared<MaterialType>();
    type->name = "composite";
    std::vector<Part> made;
    for (size_t i = 0; i < parts.size(); ++i) {
        made.push_back(make_part(parts[i], i));
        add_bxdf_rows(made.back(), type->parameters);
        add_fresnel_rows(made.back(), type->parameters);
    }
    const ParameterTable &common = common_material_parameters();
    type->parameters.insert(type->parameters.end(), common.begin(), common.end());
    const auto expand = [made](const ParameterSet &p) {
        std::vector<MaterialComponent> components;
        for (const Part &part : made) {
            components.push_back(expand_part(part, p));
        }
        return components;
    };
    type->expand = expand;
    const bool refracts =
        std::any_of(made.begin(), made.end(), [](const Part &part) { return part.refracts(); });
    const auto coated =
        std::find_if(made.begin(), made.end(), [](const Part &part) { return part.is_coated(); });
    if (refracts && coated != made.end()) {
        throw input_error(
            fmt::format("component {}: coated_lambert is opaque, so no other component may refract",
                        coated - made.begin()));
    }
    type->check = [made, expand](const ParameterSet &p) {
        for (const Part &part : made) {
            check_part(part, p);
        }
        check_common_parameters(p);
        check_components(expand(p));
    };
    return type;
}

}  // namespace rtrays
