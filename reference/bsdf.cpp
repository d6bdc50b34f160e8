// SPDX-License-Identifier: MIT
#include "reference/bsdf.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>

#include "renderer/base/error.h"

namespace rtrays::reference {

Composite::Composite(std::vector<Component> components, bool two_sided)
    : components_(std::move(components)) {
    const auto transmits = [](const Component &c) { return c.transmits(); };
    const auto is_delta = [](const Component &c) { return c.is_delta(); };
    const auto refracting = std::find_if(components_.begin(), components_.end(), transmits);
    eta_ = refracting != components_.end() ? refracting->eta() : 1.0;
    boundary_ = std::any_of(components_.begin(), components_.end(), transmits);
    visible_from_behind_ = boundary_ || two_sided;
    delta_ = std::all_of(components_.begin(), components_.end(), is_delta);
}

Viewpoint Composite::viewpoint(const Vec3 &wo, const TexturePoint &at) const {
    const bool behind = wo.z() < 0.0;
    return {{wo.x(), wo.y(), std::abs(wo.z())}, behind, boundary_ && behind, at};
}

namespace {

/// Returns wi in the frame in which wo is on the upper side, mirrored in z if necessary.
Vec3 mirrored(const Vec3 &wi, const Vec3 &wo) {
    return {wi.x(), wi.y(), std::copysign(1.0, wo.z()) * wi.z()};
}

}  // namespace

Spectrum Composite::sum(const Vec3 &wi, const Viewpoint &view) const {
    Spectrum total = Spectrum::Zero();
    for (const Component &component : components_) {
        if (component.transmits() == (wi.z() < 0.0)) {
            total += component.evaluate(wi, view);
        }
    }
    return total;
}

double Composite::expansion(const Vec3 &wi, const Viewpoint &view) const {
    if (wi.z() > 0.0) {
        return 1.0;
    }
    return view.inverted ? 1.0 / square(eta_) : square(eta_);
}

double Composite::density(const Vec3 &wi, const Viewpoint &view) const {
    double weighted = 0.0, total = 0.0;
    for (const Component &component : components_) {
        const double importance = component.importance(view);
        total += importance;
        if (importance > 0.0 && component.transmits() == (wi.z() < 0.0)) {
            weighted += importance * component.pdf_w(wi, view);
        }
    }
    return total > 0.0 ? weighted / total : 0.0;
}

Spectrum Composite::evaluate(const Vec3 &wi, const Vec3 &wo, const TexturePoint &at) const {
    // A direction in the surface plane is on neither side.
    return is_black(wo) || wi.z() * wo.z() == 0.0 ? Spectrum(Spectrum::Zero())
                                                  : sum(mirrored(wi, wo), viewpoint(wo, at));
}

double Composite::pdf_w(const Vec3 &wi, const Vec3 &wo, const TexturePoint &at) const {
    return is_black(wo) || wi.z() * wo.z() == 0.0 ? 0.0
                                                  : density(mirrored(wi, wo), viewpoint(wo, at));
}

std::optional<BsdfSample> Composite::sample(const Vec3 &wo, const TexturePoint &at,
                                            Rng &rng) const {
    if (is_black(wo) || wo.z() == 0.0) {
        return std::nullopt;
    }
    const Viewpoint view = viewpoint(wo, at);
    std::array<double, most_components> importance;
    double total = 0.0;
    for (size_t i = 0; i < components_.size(); ++i) {
        importance[i] = components_[i].importance(view);
        total += importance[i];
    }
    if (!(total > 0.0)) {
        return std::nullopt;
    }
    double left = rng.uniform() * total;
    size_t chosen = 0;
    while (chosen + 1 < components_.size() && left >= importance[chosen]) {
        left -= importance[chosen++];
    }
    const Component &component = components_[chosen];
    if (!(importance[chosen] > 0.0)) {
        return std::nullopt;  // rounding selected the last component, whose importance is 0
    }
    if (component.is_delta()) {
        const auto event = component.scatter(view);
        if (!event) {
            return std::nullopt;
        }
        return BsdfSample{mirrored(event->wi, wo),
                          event->coefficient * (total / importance[chosen]), 0.0, true,
                          expansion(event->wi, view)};
    }
    const auto wi = component.sample(view, rng);
    if (!wi || wi->z() == 0.0) {
        return std::nullopt;
    }
    const double pdf = density(*wi, view);
    if (!(pdf > 0.0)) {
        return std::nullopt;  // the density of this improbable direction underflows
    }
    return BsdfSample{mirrored(*wi, wo), sum(*wi, view) * (std::abs(wi->z()) / pdf), pdf, false,
                      expansion(*wi, view)};
}

std::vector<BsdfSample> Composite::delta_events(const Vec3 &wo, const TexturePoint &at) const {
    std::vector<BsdfSample> events;
    if (is_black(wo) || wo.z() == 0.0) {
        return events;
    }
    const Viewpoint view = viewpoint(wo, at);
    for (const Component &component : components_) {
        const auto event = component.is_delta() ? component.scatter(view) : std::nullopt;
        if (event && (event->coefficient > 0.0).any()) {
            events.push_back({mirrored(event->wi, wo), event->coefficient, 0.0, true,
                              expansion(event->wi, view)});
        }
    }
    return events;
}

std::vector<Bsdf> make_bsdfs(const MaterialArrays &materials, const TextureArrays &textures) {
    std::vector<Bsdf> bsdfs;
    for (size_t i = 0; i < materials.name.size(); ++i) {
        const uint32_t count = materials.component_count[i];
        if (count > Composite::most_components) {
            throw input_error(fmt::format(
                "material {} '{}': the reference supports at most {} components, got {}", i,
                materials.name[i], Composite::most_components, count));
        }
        std::vector<Component> components;
        for (uint32_t k = 0; k < count; ++k) {
            const std::string what =
                fmt::format("material {} '{}', component {}", i, materials.name[i], k);
            components.emplace_back(materials.component[materials.first_component[i] + k], textures,
                                    what);
        }
        const bool two_sided = materials.two_sided[i] != 0;
        const BxdfComponent *first =
            count == 1 ? &materials.component[materials.first_component[i]] : nullptr;
        const bool plain = first != nullptr && two_sided &&
                           first->kind == BxdfComponent::Kind::lambert &&
                           first->texture == no_index && first->mix_texture == no_index &&
                           first->side == BxdfComponent::Side::both &&
                           first->fresnel == BxdfComponent::Fresnel::ideal && !first->complement;
        bsdfs.emplace_back(plain ? Bsdf(Lambert(first->weight.cast<double>()))
                                 : Bsdf(Composite(std::move(components), two_sided)));
    }
    return bsdfs;
}

}  // namespace rtrays::reference
