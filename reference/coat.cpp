// SPDX-License-Identifier: MIT
#include "reference/coat.h"

#include <map>
#include <mutex>
#include <optional>
#include <tuple>

#include "reference/fresnel.h"
#include "reference/lobes.h"
#include "reference/microfacet.h"

namespace rtrays::reference {

namespace {

constexpr int table_cells = 256;

/// Returns the share of light from `wo` that the microfacets of a boundary reflect or transmit to
/// directions that leave the surface. `eta` is the index beyond the boundary over that on the side
/// of `wo`. Facets are on rings of equal tan(theta) = alpha tan(t), so that narrow distributions
/// are resolved.
double scattered(const MicrofacetDistribution &facets, double alpha, double eta, double cosine,
                 bool transmitted) {
    constexpr int rings = 128, steps = 48;
    const double c = std::max(cosine, 1e-9);  // the limit at the horizon
    const Vec3 wo(std::sqrt((1.0 - c) * (1.0 + c)), 0.0, c);
    double sum = 0.0;
    for (int i = 0; i < rings; ++i) {
        const double t = (i + 0.5) / rings * 0.5 * pi;
        const double tangent = alpha * std::tan(t);
        const double z = 1.0 / std::hypot(1.0, tangent);
        // d(theta) / dt = alpha cos^2(theta) / cos^2(t)
        const double area =
            tangent * z * alpha * square(z / std::cos(t)) * (0.5 * pi / rings) * (2.0 * pi / steps);
        for (int k = 0; k < steps; ++k) {
            const double phi = (k + 0.5) / steps * pi;  // the other half is its mirror image
            const Vec3 h(tangent * z * std::cos(phi), tangent * z * std::sin(phi), z);
            const double at = wo.dot(h);
            if (!(at > 0.0)) {
                continue;
            }
            const double fresnel = fresnel_dielectric(std::min(at, 1.0), eta);
            const std::optional<Vec3> wi =
                transmitted ? refract(wo, h, eta) : reflect_upwards(wo, h);
            if (!wi || (transmitted && wi->z() >= 0.0)) {
                continue;
            }
            sum += facets.pdf_visible(wo, h) * facets.masking(*wi, h) * area *
                   (transmitted ? 1.0 - fresnel : fresnel);
        }
    }
    return sum;
}

/// Returns the share of diffuse light from below a boundary that it reflects back.
double diffuse_reflectance(const BxdfComponent &component) {
    const MicrofacetDistribution facets(component.distribution, component.alpha);
    const double inside = 1.0 / component.eta[0];
    const auto reflected = [&](double c) {
        return component.alpha[0] > 0.0 ? scattered(facets, component.alpha[0], inside, c, false)
                                        : fresnel_dielectric(c, inside);
    };
    // The reflectance has the slope of a root at the critical angle, from where c = critical + (1 -
    // critical) x^2 makes it smooth.
    const double critical = std::sqrt(1.0 - square(inside));
    constexpr int steps = 200;
    double sum = 0.0;
    for (int i = 0; i < steps; ++i) {
        const double x = (i + 0.5) / steps;
        const double below = critical * x, above = critical + (1.0 - critical) * square(x);
        sum += 2.0 * below * reflected(below) * critical / steps;
        sum += 2.0 * above * reflected(above) * 2.0 * x * (1.0 - critical) / steps;
    }
    return sum;
}

}  // namespace

std::shared_ptr<const Coat::Table> Coat::table_of(const BxdfComponent &component) {
    static std::mutex mutex;
    static std::map<std::tuple<double, double, BxdfComponent::Distribution>,
                    std::shared_ptr<const Table>>
        tables;
    const std::lock_guard<std::mutex> lock(mutex);
    std::shared_ptr<const Table> &table =
        tables[{component.eta[0], component.alpha[0], component.distribution}];
    if (table == nullptr) {
        const MicrofacetDistribution facets(component.distribution, component.alpha);
        Table made;
        for (int i = 0; i <= table_cells; ++i) {
            // Transmittances bend near the horizon.
            const double c = square(static_cast<double>(i) / table_cells);
            made.transmittance.push_back(
                scattered(facets, component.alpha[0], component.eta[0], c, true));
        }
        made.inner_reflectance = diffuse_reflectance(component);
        table = std::make_shared<const Table>(std::move(made));
    }
    return table;
}

Coat::Coat(const BxdfComponent &component)
    : eta_(component.eta[0]),
      nonlinear_(component.nonlinear),
      inner_(component.inner_reflectance),
      table_(component.alpha[0] > 0.0 ? table_of(component) : nullptr) {
    if (inner_ < 0.0) {
        inner_ = table_ ? table_->inner_reflectance : diffuse_reflectance(component);
    }
}

double Coat::transmittance(double c) const {
    if (!table_) {
        return 1.0 - fresnel_dielectric(c, eta_);
    }
    const double at = std::sqrt(std::min(c, 1.0)) * table_cells;
    const int cell = std::min(static_cast<int>(at), table_cells - 1);
    const auto k = static_cast<size_t>(cell);
    const double share = at - cell;
    return (1.0 - share) * table_->transmittance[k] + share * table_->transmittance[k + 1];
}

Spectrum Coat::base(const Spectrum &albedo) const {
    // Sum of the geometric series of reflections between base and coat.
    const Spectrum returned = nonlinear_ ? Spectrum(albedo * inner_) : Spectrum::Constant(inner_);
    return albedo / (1.0 - returned) / square(eta_);
}

}  // namespace rtrays::reference
