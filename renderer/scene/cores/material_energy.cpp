// SPDX-License-Identifier: MIT
// The check that materials conserve energy. Fresnel equations: thesis (3.26-3.30). The exact
// conductor: Born and Wolf, "Principles of Optics", 7th ed., 14.2, for index 1 in front.
#include "renderer/scene/cores/material_energy.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "renderer/base/angles.h"
#include "renderer/scene/cores/composite.h"

namespace rtrays {

namespace {

using Kind = BxdfComponent::Kind;
using Fresnel = BxdfComponent::Fresnel;

double squared(double x) {
    return x * x;
}

double dielectric(double cosine, double eta) {
    const double sin2 = (1 - cosine * cosine) / (eta * eta);
    if (sin2 >= 1) {
        return 1;  // total internal reflection
    }
    const double inner = std::sqrt(1 - sin2);
    // The denominators are positive: eta and inner are above zero, cosine is at least zero.
    return 0.5 * (squared((eta * cosine - inner) / (eta * cosine + inner)) +
                  squared((cosine - eta * inner) / (cosine + eta * inner)));
}

double conductor(double cosine, double eta, double k) {
    const double cos2 = cosine * cosine;
    const double sin2 = 1 - cos2;
    const double t = eta * eta - k * k - sin2;
    const double a2_plus_b2 = std::sqrt(t * t + 4 * squared(eta * k));
    const double a = std::sqrt(std::max(0.0, 0.5 * (a2_plus_b2 + t)));
    // The denominators are positive: cos2 is positive and a is not negative; if sin2 = 0,
    // eta * eta + k * k > 0.
    const double s = (a2_plus_b2 + cos2 - 2 * a * cosine) / (a2_plus_b2 + cos2 + 2 * a * cosine);
    const double p = (cos2 * a2_plus_b2 + sin2 * sin2 - 2 * a * cosine * sin2) /
                     (cos2 * a2_plus_b2 + sin2 * sin2 + 2 * a * cosine * sin2);
    return 0.5 * s * (1 + p);
}

double conductor_approximate(double cosine, double eta, double k) {
    const double size = eta * eta + k * k;
    const double cos2 = cosine * cosine;
    return 0.5 * ((size * cos2 - 2 * eta * cosine + 1) / (size * cos2 + 2 * eta * cosine + 1) +
                  (size - 2 * eta * cosine + cos2) / (size + 2 * eta * cosine + cos2));
}

/// Returns F or 1 - F of one channel; `inverted` means a view from behind a boundary.
double fresnel(const BxdfComponent &bxdf, int channel, double cosine, bool inverted) {
    double f = 1;  // the value of every term at grazing incidence
    if (bxdf.kind == Kind::coated_lambert) {
        return cosine == 0 ? 0 : 1 - dielectric(cosine, bxdf.eta[0]);
    }
    if (cosine == 0) {
        return bxdf.complement ? 0 : 1;
    }
    switch (bxdf.fresnel) {
        case Fresnel::ideal:
            break;
        case Fresnel::dielectric:
            f = dielectric(cosine, inverted ? 1 / bxdf.eta[0] : bxdf.eta[0]);
            break;
        case Fresnel::thin_dielectric:
            f = dielectric(cosine, bxdf.eta[1]);
            f = 2 * f / (1 + f);
            break;
        case Fresnel::conductor:
            f = conductor(cosine, bxdf.eta[channel], bxdf.k[channel]);
            break;
        case Fresnel::conductor_approximate:
            f = conductor_approximate(cosine, bxdf.eta[channel], bxdf.k[channel]);
            break;
        case Fresnel::schlick:
            f = bxdf.eta[channel] + (1 - bxdf.eta[channel]) * std::pow(1 - cosine, 5);
            break;
    }
    return bxdf.complement ? 1 - f : f;
}

struct Excess {
    double sum = 0;
    double cosine = 0;
    int channel = 0;
    bool behind = false;
    bool inverted = false;  ///< behind a boundary
};

/// Returns the contribution of a component to the sum, for a channel and direction.
double contribution(const MaterialComponent &component, const Excess &at) {
    using Side = BxdfComponent::Side;
    if (component.bxdf.side == (at.behind ? Side::front : Side::back)) {
        return 0;
    }
    const double texel =
        component.texture != nullptr ? component.texture->largest_texel()[at.channel] : 1;
    return component.bxdf.weight[at.channel] * texel *
           fresnel(component.bxdf, at.channel, at.cosine, at.inverted);
}

}  // namespace

void check_energy(const std::vector<MaterialComponent> &components) {
    constexpr int steps = 256;
    constexpr double tolerance = 1e-6;  // weights are floats
    const bool is_boundary =
        std::any_of(components.begin(), components.end(), [](const MaterialComponent &c) {
            return c.bxdf.kind == Kind::ideal_refraction ||
                   c.bxdf.kind == Kind::microfacet_refraction;
        });
    const bool sides_differ =
        is_boundary ||
        std::any_of(components.begin(), components.end(), [](const MaterialComponent &c) {
            return c.bxdf.side != BxdfComponent::Side::both;
        });
    Excess worst;
    for (int i = 0; i < (sides_differ ? 2 : 1) * 3 * (steps + 1); ++i) {
        Excess at;
        at.channel = i % 3;
        at.cosine = static_cast<double>(i / 3 % (steps + 1)) / steps;
        at.behind = i / 3 > steps;
        at.inverted = at.behind && is_boundary;
        for (const MaterialComponent &component : components) {
            at.sum += contribution(component, at);
        }
        worst = at.sum > worst.sum ? at : worst;
    }
    if (worst.sum <= 1 + tolerance) {
        return;
    }
    const auto largest =
        std::max_element(components.begin(), components.end(),
                         [&](const MaterialComponent &a, const MaterialComponent &b) {
                             return contribution(a, worst) < contribution(b, worst);
                         });
    constexpr const char *channels[] = {"red", "green", "blue"};
    throw input_error(fmt::format(
        "the material returns more light than arrives: its weights * textures * Fresnel terms add "
        "up to {:.6g} in {}, seen from {} at an angle of {:.3g} degrees; the largest contribution, "
        "{:.6g}, is from component {} ({}); lower its {}",
        worst.sum, channels[worst.channel], worst.behind ? "behind" : "the front",
        std::acos(worst.cosine) / degree, contribution(*largest, worst),
        largest - components.begin(), bxdf_names()[static_cast<size_t>(largest->bxdf.kind)],
        largest->parameter));
}

}  // namespace rtrays
