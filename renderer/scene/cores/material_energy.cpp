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

constexpr int steps = 256;  ///< of the cosine of the direction of view

/// Returns sheen_albedo at cosine i / steps.
double sheen_albedo_at(int i) {
    static const std::vector<double> albedos = [] {
        std::vector<double> made;
        for (int k = 0; k <= steps; ++k) {
            made.push_back(sheen_albedo(static_cast<double>(k) / steps));
        }
        return made;
    }();
    return albedos[static_cast<size_t>(i)];
}

/// Returns F or 1 - F of one channel; `inverted` means a view from behind a boundary.
double fresnel(const BxdfComponent &bxdf, int channel, double cosine, bool inverted) {
    double f = 1;  // the value of every term at grazing incidence
    if (bxdf.kind == Kind::coated_lambert) {
        return cosine == 0 ? 0 : 1 - dielectric(cosine, bxdf.eta[0]);
    }
    if (bxdf.kind == Kind::disney_sheen && bxdf.fresnel == Fresnel::ideal) {
        return sheen_albedo_at(static_cast<int>(std::lround(cosine * steps)));
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
    uint32_t mixes = 0;     ///< bit i: the mixture by texture i is at its brightest texel, else 0
};

/// Textures of mixtures, each of them once.
using MixTextures = std::vector<const Texture *>;

/// Returns whether two textures have the same colour everywhere.
bool are_alike(const Texture &a, const Texture &b) {
    const ParameterSet &p = a.parameters(), &q = b.parameters();
    return a.image() == b.image() && p.text("filter") == q.text("filter") &&
           p.text("wrap") == q.text("wrap") &&
           p.get<Eigen::Vector2d>("uv_scale") == q.get<Eigen::Vector2d>("uv_scale") &&
           p.get<Eigen::Vector2d>("uv_offset") == q.get<Eigen::Vector2d>("uv_offset");
}

MixTextures::const_iterator find_alike(const MixTextures &textures, const Texture &texture) {
    return std::find_if(textures.begin(), textures.end(),
                        [&](const Texture *known) { return are_alike(*known, texture); });
}

MixTextures mix_textures(const std::vector<MaterialComponent> &components) {
    MixTextures textures;
    for (const MaterialComponent &component : components) {
        const Texture *const texture = component.mix_texture.get();
        if (texture != nullptr && find_alike(textures, *texture) == textures.end()) {
            textures.push_back(texture);
        }
    }
    constexpr size_t most = 4;
    if (textures.size() > most) {
        throw input_error(
            fmt::format("the material has {} textures of mixtures; at most {} are supported",
                        textures.size(), most));
    }
    return textures;
}

/// Returns the share of a component in its mixture. The sum of all components is linear in the
/// luminance of each texture, so it is largest where each is 0 or brightest.
double mix_of(const MaterialComponent &component, const MixTextures &textures, uint32_t mixes) {
    if (component.mix_texture == nullptr) {
        return 1;
    }
    const auto i = find_alike(textures, *component.mix_texture) - textures.begin();
    const double share = (mixes >> i & 1) != 0
                             ? component.bxdf.mix * brightest_luminance(*component.mix_texture)
                             : 0;
    return component.bxdf.mix_inverted ? 1 - share : share;
}

/// Returns the contribution of a component to the sum, for a channel and direction.
double contribution(const MaterialComponent &component, const MixTextures &mixes,
                    const Excess &at) {
    using Side = BxdfComponent::Side;
    if (component.bxdf.side == (at.behind ? Side::front : Side::back)) {
        return 0;
    }
    const double texel =
        component.texture != nullptr ? component.texture->largest_texel()[at.channel] : 1;
    return component.bxdf.weight[at.channel] * texel * mix_of(component, mixes, at.mixes) *
           fresnel(component.bxdf, at.channel, at.cosine, at.inverted);
}

}  // namespace

double sheen_albedo(double cosine) {
    // The midpoint rule over directions whose density is cosine / pi. The integrand is smooth, and
    // the result at the horizon, 0.0884, is within 4e-5 of the integral.
    constexpr int nodes = 64;
    const double sine = std::sqrt(std::max(0.0, 1 - cosine * cosine));
    double sum = 0;
    for (int i = 0; i < nodes; ++i) {
        const double cos2 = (i + 0.5) / nodes;
        for (int k = 0; k < nodes; ++k) {
            const double between = std::sqrt(cos2) * cosine +
                                   std::sqrt(1 - cos2) * sine * std::cos(pi * (k + 0.5) / nodes);
            // The cosine of half the angle is that with the half vector. Rounding may take the sum
            // below 0.
            sum += std::pow(1 - std::sqrt(std::max(0.0, 0.5 + 0.5 * between)), 5);
        }
    }
    return pi * sum / (nodes * nodes);
}

void check_energy(const std::vector<MaterialComponent> &components) {
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
    const MixTextures mixes = mix_textures(components);
    const int directions = (sides_differ ? 2 : 1) * 3 * (steps + 1);
    Excess worst;
    for (int trial = 0; trial < directions << mixes.size(); ++trial) {
        const int i = trial % directions;
        Excess at;
        at.mixes = static_cast<uint32_t>(trial / directions);
        at.channel = i % 3;
        at.cosine = static_cast<double>(i / 3 % (steps + 1)) / steps;
        at.behind = i / 3 > steps;
        at.inverted = at.behind && is_boundary;
        for (const MaterialComponent &component : components) {
            at.sum += contribution(component, mixes, at);
        }
        worst = at.sum > worst.sum ? at : worst;
    }
    if (worst.sum <= 1 + tolerance) {
        return;
    }
    const auto largest =
        std::max_element(components.begin(), components.end(),
                         [&](const MaterialComponent &a, const MaterialComponent &b) {
                             return contribution(a, mixes, worst) < contribution(b, mixes, worst);
                         });
    constexpr const char *channels[] = {"red", "green", "blue"};
    throw input_error(fmt::format(
        "the material returns more light than arrives: its weights * textures * Fresnel terms add "
        "up to {:.6g} in {}, seen from {} at an angle of {:.3g} degrees; the largest contribution, "
        "{:.6g}, is from component {} ({}); lower its {}",
        worst.sum, channels[worst.channel], worst.behind ? "behind" : "the front",
        std::acos(worst.cosine) / degree, contribution(*largest, mixes, worst),
        largest - components.begin(), bxdf_names()[static_cast<size_t>(largest->bxdf.kind)],
        largest->parameter));
}

}  // namespace rtrays
