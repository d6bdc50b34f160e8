// SPDX-License-Identifier: MIT
#include "renderer/export/mitsuba_principled.h"

#include <algorithm>
#include <cmath>

#include "renderer/base/error.h"
#include "renderer/scene/cores/texture.h"

namespace rtrays::mitsuba {

namespace {

using Eigen::Vector3d;
using Kind = BxdfComponent::Kind;
using Fresnel = BxdfComponent::Fresnel;
using Parts = std::vector<BxdfComponent>;

constexpr double rounding = 1e-6;  // of weights in float

/// The lobes of a principled BSDF, null where it has none.
struct Lobes {
    const BxdfComponent *dielectric = nullptr, *diffuse = nullptr, *sheen = nullptr,
                        *coat = nullptr;
    std::vector<const BxdfComponent *> schlick;

    /// Returns a part of the main lobe, or null.
    const BxdfComponent *main() const {
        return dielectric != nullptr ? dielectric : schlick.empty() ? nullptr : schlick[0];
    }
};

/// Sorts components by lobe. Returns nothing if one is of another kind.
std::optional<Lobes> lobes_of(const Parts &parts) {
    Lobes lobes;
    for (const BxdfComponent &part : parts) {
        if (part.kind == Kind::disney_diffuse) {
            lobes.diffuse = &part;
        } else if (part.kind == Kind::disney_sheen) {
            lobes.sheen = &part;
        } else if (part.kind == Kind::disney_clearcoat) {
            lobes.coat = &part;
        } else if (part.kind == Kind::microfacet_reflection &&
                   part.fresnel == Fresnel::dielectric) {
            lobes.dielectric = &part;
        } else if (part.kind == Kind::microfacet_reflection && part.fresnel == Fresnel::schlick) {
            lobes.schlick.push_back(&part);
        } else {
            return std::nullopt;
        }
    }
    return lobes;
}

/// Returns the index n of a dielectric that reflects `reflectance` at normal incidence.
double index_of(double reflectance) {
    const double root = std::sqrt(std::clamp(reflectance, 0.0, 0.96));  // n is at most 100
    return (1 + root) / (1 - root);
}

/// Sets roughness and anisotropy. All roughnesses below the least one have the same components.
void set_roughness(const Lobes &lobes, Principled &p) {
    const BxdfComponent *main = lobes.main();
    if (main != nullptr) {
        // The components are at least 1e-4.
        p.roughness = std::pow(main->alpha.prod(), 0.25);
        p.anisotropic = (1 - main->alpha[1] / main->alpha[0]) / 0.9;
    }
    if (lobes.diffuse != nullptr) {
        p.roughness = lobes.diffuse->disney_roughness;
    }
}

/// Sets sheen and its tint, which has the luminance 1.
void set_sheen(const BxdfComponent &sheen, Principled &p) {
    const Vector3d weight = sheen.weight.cast<double>() / (1 - p.metallic);
    p.sheen = luminance(weight);
    const double y = luminance(p.base_color);
    const Vector3d tint = y > 0 ? Vector3d(p.base_color / y - Vector3d::Ones()) : Vector3d::Zero();
    Eigen::Index channel = 0;
    if (tint.cwiseAbs().maxCoeff(&channel) > rounding && p.sheen > 0) {
        p.sheen_tint = (weight[channel] / p.sheen - 1) / tint[channel];
    }
}

/// Returns a BSDF of this metalness, of which `metal` components reflect like a metal.
Principled with_metal(const Lobes &lobes, double metallic, const Vector3d &metal_colour,
                      bool is_tinted) {
    Principled p;
    p.metallic = metallic;
    p.base_color = metal_colour;
    const double rest = 1 - metallic;
    if (lobes.diffuse != nullptr && rest > 0) {
        p.base_color = lobes.diffuse->weight.cast<double>() / rest;
        p.flatness = lobes.diffuse->flatness;
    }
    p.eta = lobes.main() == nullptr ? 1 : 1.5;
    if (is_tinted && rest > 0) {
        p.spec_tint = static_cast<double>(lobes.schlick[0]->weight[0]) / rest;
        p.eta = index_of(luminance(lobes.schlick[0]->eta));
    }
    if (lobes.dielectric != nullptr) {
        p.eta = lobes.dielectric->eta[0];
    }
    set_roughness(lobes, p);
    if (lobes.sheen != nullptr && rest > 0) {
        set_sheen(*lobes.sheen, p);
    }
    if (lobes.coat != nullptr) {
        p.clearcoat = static_cast<double>(lobes.coat->weight[0]);
        p.clearcoat_gloss = (0.1 - lobes.coat->alpha[0]) / (0.1 - 0.001);
    }
    return p;
}

/// Returns the BSDFs that may have these lobes, one of them without metal.
std::vector<Principled> candidates(const Lobes &lobes) {
    const size_t count = lobes.schlick.size();
    std::vector<Principled> all = {with_metal(lobes, 0, Vector3d::Zero(), count == 1)};
    if (count > 0) {
        const BxdfComponent &last = *lobes.schlick[count - 1];
        const double metallic = static_cast<double>(last.weight[0]);
        all.push_back(with_metal(lobes, metallic, last.eta, count == 2));
        if (count > 1 && lobes.schlick[count - 2]->complement && metallic > 0) {
            // The two parts of a metal whose colour is a texture.
            const Vector3d colour = lobes.schlick[count - 2]->weight.cast<double>() / metallic;
            all.push_back(with_metal(lobes, metallic, colour, false));
        }
    }
    return all;
}

bool is_near(double a, double b) {
    return std::abs(a - b) <= rounding;
}

bool is_near(const Vector3d &a, const Vector3d &b) {
    return (a - b).cwiseAbs().maxCoeff() <= rounding;
}

bool is_same(const BxdfComponent &a, const MaterialComponent &made) {
    const BxdfComponent &b = made.bxdf;
    const bool is_main = a.kind == Kind::microfacet_reflection;
    return a.kind == b.kind && a.fresnel == b.fresnel && a.complement == b.complement &&
           is_near(a.weight.cast<double>(), b.weight.cast<double>()) &&
           (a.fresnel == Fresnel::ideal || is_near(a.eta, b.eta)) &&
           (!is_main ||
            (a.distribution == b.distribution && a.roughness_squared == b.roughness_squared)) &&
           (a.kind == Kind::disney_diffuse || a.kind == Kind::disney_sheen ||
            (is_near(a.alpha[0], b.alpha[0]) && is_near(a.alpha[1], b.alpha[1]))) &&
           is_near(a.disney_roughness, b.disney_roughness) && is_near(a.flatness, b.flatness) &&
           (a.texture == no_index) == (made.texture == nullptr) &&
           (a.roughness_texture == no_index) == (made.roughness_texture == nullptr);
}

/// Returns whether the importer makes these components of the BSDF.
bool makes(const Principled &p, const Parts &parts) {
    for (const double share : {p.metallic, p.roughness, p.anisotropic, p.spec_tint, p.sheen,
                               p.sheen_tint, p.flatness, p.clearcoat, p.clearcoat_gloss}) {
        if (!(share >= -rounding && share <= 1 + rounding)) {
            return false;
        }
    }
    try {
        const std::vector<MaterialComponent> made = principled_components(p);
        return made.size() == parts.size() &&
               std::equal(parts.begin(), parts.end(), made.begin(), is_same);
    } catch (const Error &) {
        return false;
    }
}

/// Sets `common` to the one texture that parts have. Returns false if they have several.
bool find_common(const Parts &parts, uint32_t BxdfComponent::*texture, uint32_t &common) {
    return std::all_of(parts.begin(), parts.end(), [&](const BxdfComponent &part) {
        if (part.*texture == no_index) {
            return true;
        }
        common = common == no_index ? part.*texture : common;
        return common == part.*texture;
    });
}

}  // namespace

std::optional<PrincipledBsdf> principled_of(const Parts &parts, const TextureArrays &textures) {
    PrincipledBsdf bsdf;
    const std::optional<Lobes> lobes = lobes_of(parts);
    if (!lobes || !find_common(parts, &BxdfComponent::texture, bsdf.base_texture) ||
        !find_common(parts, &BxdfComponent::roughness_texture, bsdf.roughness_texture)) {
        return std::nullopt;
    }
    const auto texture = [&](uint32_t index) {
        return index == no_index
                   ? nullptr
                   : std::make_shared<Texture>(textures.name[index], textures.image[index]);
    };
    for (const Principled &candidate : candidates(*lobes)) {
        bsdf.parameters = candidate;
        bsdf.parameters.base_texture = texture(bsdf.base_texture);
        bsdf.parameters.roughness_texture = texture(bsdf.roughness_texture);
        if (makes(bsdf.parameters, parts)) {
            return bsdf;
        }
    }
    return std::nullopt;
}

}  // namespace rtrays::mitsuba
