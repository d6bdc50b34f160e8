// SPDX-License-Identifier: MIT
#include "reference/component.h"

#include <fmt/format.h>

#include "renderer/base/error.h"

namespace rtrays::reference {

namespace {

using Kind = BxdfComponent::Kind;

/// Share of the importance that ignores F, see `Component::importance`.
constexpr double fresnel_free_share = 0.05;

template <class Lobe>
constexpr bool is_delta_lobe =
    std::is_same_v<Lobe, IdealReflectionLobe> || std::is_same_v<Lobe, IdealRefractionLobe>;

void require(bool condition, const std::string &what, const char *complaint) {
    if (!condition) {
        throw input_error(fmt::format("{}: {}", what, complaint));
    }
}

void check(const BxdfComponent &c, const TextureArrays &textures, const std::string &what) {
    const auto positive = [](double x) { return x > 0.0 && std::isfinite(x); };
    require((c.weight.array() >= 0.0f).all() && (c.weight.array() <= 1.0f).all(), what,
            "the weight (reflectance) must be in [0, 1]");
    require(c.texture == no_index || c.texture < textures.image.size(), what,
            "the texture does not exist");
    const bool refracts = c.kind == Kind::ideal_refraction || c.kind == Kind::microfacet_refraction;
    switch (c.fresnel) {
        case BxdfComponent::Fresnel::ideal:
            break;
        case BxdfComponent::Fresnel::dielectric:
            require(positive(c.eta[0]), what, "eta must be positive");
            break;
        case BxdfComponent::Fresnel::conductor:
        case BxdfComponent::Fresnel::conductor_approximate:
            require((c.eta.array() > 0.0).all() && c.eta.allFinite(), what, "eta must be positive");
            require((c.k.array() >= 0.0).all() && c.k.allFinite(), what, "k must not be negative");
            break;
        case BxdfComponent::Fresnel::schlick:
            require((c.eta.array() >= 0.0).all() && (c.eta.array() <= 1.0).all(), what,
                    "the reflectance at normal incidence must be in [0, 1]");
            break;
        case BxdfComponent::Fresnel::thin_dielectric:
            require(positive(c.eta[1]), what, "the index of the plate must be positive");
            require(!refracts || c.eta[0] == 1.0, what, "a thin plate must not bend light");
            break;
    }
    require(!refracts || positive(c.eta[0]), what, "eta must be positive");
    require(!refracts || c.side == BxdfComponent::Side::both, what,
            "a refracting component must act on both sides");
    const bool has_alpha = c.kind == Kind::ward || c.kind == Kind::ward_original ||
                           c.kind == Kind::microfacet_reflection ||
                           c.kind == Kind::microfacet_refraction;
    require(!has_alpha || (c.alpha.minCoeff() > 0.0 && c.alpha.maxCoeff() <= 1.0), what,
            "alpha must be in (0, 1]");
    require(c.kind != Kind::coated_lambert ||
                (c.eta[0] > 1.0 && c.alpha[0] >= 0.0 && c.alpha[0] <= 1.0 &&
                 c.alpha[0] == c.alpha[1] && c.inner_reflectance < 1.0),
            what, "a coat must have an eta above 1, one alpha in [0, 1] and must not reflect all");
    require(c.kind != Kind::blinn || positive(c.exponent), what, "the exponent must be positive");
    require(c.kind != Kind::oren_nayar || (c.sigma >= 0.0 && c.sigma <= 0.5 * pi + 1e-9), what,
            "sigma must be in [0, pi / 2]");
}

}  // namespace

Component::Lobe Component::make_lobe(const BxdfComponent &component) {
    const MicrofacetDistribution distribution(component.distribution, component.alpha);
    switch (component.kind) {
        case Kind::lambert:
        case Kind::coated_lambert:
            return OrenNayarLobe(0.0);
        case Kind::oren_nayar:
            return OrenNayarLobe(component.sigma);
        case Kind::disney_diffuse:
            return DisneyDiffuseLobe(component.disney_roughness, component.flatness);
        case Kind::disney_sheen:
            return DisneySheenLobe{};
        case Kind::disney_clearcoat:
            return DisneyClearcoatLobe(component.alpha[0]);
        case Kind::ideal_reflection:
            return IdealReflectionLobe{};
        case Kind::ideal_refraction:
            return IdealRefractionLobe{};
        case Kind::blinn:
            return BlinnLobe(component.exponent);
        case Kind::ward:
            return WardLobe(component.alpha, true);
        case Kind::ward_original:
            return WardLobe(component.alpha, false);
        case Kind::microfacet_reflection:
            return MicrofacetReflectionLobe(distribution);
        case Kind::microfacet_refraction:
            // Without a change of index no facet refracts, so the lobe is exactly the ideal one.
            return component.eta[0] == 1.0 ? Lobe(IdealRefractionLobe{})
                                           : Lobe(MicrofacetRefractionLobe(distribution));
    }
    throw run_error("unknown BxDF");
}

Component::Component(const BxdfComponent &component, const TextureArrays &textures,
                     const std::string &what)
    : weight_(component.weight.cast<double>()),
      mix_factor_(component.mix),
      mix_inverted_(component.mix_inverted),
      fresnel_(component),
      eta_(component.eta[0]),
      fresnel_of_wo_(component.fresnel_of_wo),
      side_(component.side),
      lobe_((check(component, textures, what), make_lobe(component))) {
    if (component.texture != no_index) {
        texture_.emplace(textures, component.texture);
    }
    if (component.roughness_texture != no_index) {
        require(component.roughness_texture < textures.image.size(), what,
                "the texture of the roughness does not exist");
        roughness_texture_.emplace(textures, component.roughness_texture);
        textured_ = component;
    }
    if (component.mix_texture != no_index) {
        require(component.mix_texture < textures.image.size(), what,
                "the texture of the mixture does not exist");
        mix_texture_.emplace(textures, component.mix_texture);
    }
    if (component.kind == Kind::coated_lambert) {
        coat_.emplace(component);
    }
    std::visit(
        [this](const auto &lobe) {
            using Model = std::decay_t<decltype(lobe)>;
            delta_ = is_delta_lobe<Model>;
            transmits_ = Model::transmits;
            rough_ = !delta_ && !std::is_same_v<Model, OrenNayarLobe>;
        },
        lobe_);
}

Component::Lobe Component::textured_lobe(const TexturePoint &at) const {
    const double factor = luminance(roughness_texture_->evaluate(at));
    BxdfComponent scaled = textured_;
    scaled.alpha *= scaled.roughness_squared ? factor * factor : factor;
    scaled.alpha = scaled.alpha.cwiseMax(BxdfComponent::least_alpha);
    scaled.disney_roughness *= factor;
    return make_lobe(scaled);
}

double Component::half_cosine(const Vec3 &wi, const Viewpoint &view) const {
    return transmits_ ? std::abs(view.wo.dot(refraction_half_vector(wi, view.wo, eta(view))))
                      : view.wo.dot(half_vector(wi, view.wo));
}

Spectrum Component::fresnel_factor(const Vec3 &wi, const Viewpoint &view) const {
    if (coat_) {
        return Spectrum::Constant(coat_->transmittance(view.wo.z()) * coat_->transmittance(wi.z()));
    }
    if (fresnel_.is_ideal()) {
        return Spectrum::Ones();
    }
    if (rough_) {
        // Rounding of the unit vectors may make the cosine exceed 1 by an ulp.
        return fresnel_.evaluate(std::min(half_cosine(wi, view), 1.0), view.inverted);
    }
    const Spectrum at_wo = fresnel_.evaluate(view.wo.z(), view.inverted);
    return fresnel_of_wo_ ? at_wo : Spectrum(at_wo * fresnel_.evaluate(wi.z(), view.inverted));
}

Spectrum Component::evaluate(const Vec3 &wi, const Viewpoint &view) const {
    const double f = with_lobe(view, [&](const auto &lobe) {
        if constexpr (is_delta_lobe<std::decay_t<decltype(lobe)>>) {
            return 0.0;
        } else {
            return lobe.evaluate(wi, view.wo, eta(view));
        }
    });
    return f > 0.0 ? Spectrum(colour(view) * fresnel_factor(wi, view) * f) : Spectrum::Zero();
}

double Component::pdf_w(const Vec3 &wi, const Viewpoint &view) const {
    return with_lobe(view, [&](const auto &lobe) {
        if constexpr (is_delta_lobe<std::decay_t<decltype(lobe)>>) {
            return 0.0;
        } else {
            return lobe.pdf_w(wi, view.wo, eta(view));
        }
    });
}

std::optional<Vec3> Component::sample(const Viewpoint &view, Rng &rng) const {
    return with_lobe(view, [&](const auto &lobe) -> std::optional<Vec3> {
        if constexpr (is_delta_lobe<std::decay_t<decltype(lobe)>>) {
            return std::nullopt;
        } else {
            return lobe.sample(view.wo, eta(view), rng);
        }
    });
}

std::optional<DeltaEvent> Component::scatter(const Viewpoint &view) const {
    const Spectrum coefficient = colour(view) * fresnel_.evaluate(view.wo.z(), view.inverted);
    if (!transmits_) {
        return DeltaEvent{{-view.wo.x(), -view.wo.y(), view.wo.z()}, coefficient};
    }
    const double index = eta(view);
    const auto wi = refract(view.wo, Vec3::UnitZ(), index);
    if (!wi) {
        return std::nullopt;
    }
    return DeltaEvent{*wi, coefficient / square(index)};  // thesis (3.40)
}

double Component::importance(const Viewpoint &view) const {
    double by_channels = 0.0;
    if (coat_) {
        by_channels = colour(view).mean() * coat_->transmittance(view.wo.z());
    } else if (fresnel_.is_ideal()) {
        by_channels = colour(view).mean();
    } else {
        const Spectrum f = fresnel_.evaluate(view.wo.z(), view.inverted);
        const double free = rough_ ? fresnel_free_share : 0.0;
        by_channels = (colour(view) * (free + (1.0 - free) * f)).mean();
    }
    return by_channels;
}

}  // namespace rtrays::reference
