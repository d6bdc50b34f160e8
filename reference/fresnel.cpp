// SPDX-License-Identifier: MIT
#include "reference/fresnel.h"

#include <complex>

#include "renderer/base/error.h"

namespace rtrays::reference {

double refracted_cosine(double cos_o, double eta) {
    // The form (1 - c)(1 + c) keeps the digits of a small sine.
    const double cos_squared = 1.0 - (1.0 - cos_o) * (1.0 + cos_o) / square(eta);
    return cos_squared > 0.0 ? std::sqrt(cos_squared) : 0.0;
}

double fresnel_dielectric(double cos_o, double eta) {
    if (eta == 1.0) {
        return 0.0;  // no boundary; the formula below would be 0 / 0 at grazing incidence
    }
    const double cos_i = refracted_cosine(cos_o, eta);
    if (cos_i == 0.0) {
        return 1.0;
    }
    // Both denominators are positive, because cos_i > 0.
    const double parallel = (eta * cos_o - cos_i) / (eta * cos_o + cos_i);
    const double perpendicular = (cos_o - eta * cos_i) / (cos_o + eta * cos_i);
    return 0.5 * (square(parallel) + square(perpendicular));
}

double fresnel_conductor(double cos_o, double eta, double k) {
    if (!(cos_o > 0.0)) {
        return 1.0;  // the limit; the formula below would be 0 / 0 for an index of 1
    }
    const std::complex<double> index(eta, k);
    const std::complex<double> index_squared = index * index;
    // Index times the cosine of the (complex) refracted angle, by Snell's law. Its real part is not
    // negative, so neither denominator vanishes.
    const std::complex<double> s = std::sqrt(index_squared - (1.0 - cos_o) * (1.0 + cos_o));
    const double perpendicular = std::norm(cos_o - s) / std::norm(cos_o + s);
    const double parallel =
        std::norm(index_squared * cos_o - s) / std::norm(index_squared * cos_o + s);
    return 0.5 * (parallel + perpendicular);
}

double fresnel_conductor_approximate(double cos_o, double eta, double k) {
    const double sum = square(eta) + square(k);
    const double cross = 2.0 * eta * cos_o;
    const double cos_squared = square(cos_o);
    const double parallel = (sum * cos_squared - cross + 1.0) / (sum * cos_squared + cross + 1.0);
    const double perpendicular = (sum - cross + cos_squared) / (sum + cross + cos_squared);
    return 0.5 * (parallel + perpendicular);
}

double fresnel_schlick(double cos_o, double reflectance_at_normal) {
    const double c = 1.0 - cos_o;
    return reflectance_at_normal + (1.0 - reflectance_at_normal) * square(square(c)) * c;
}

double thin_plate_reflectance(double cos_o, double eta) {
    const double r = fresnel_dielectric(cos_o, eta);
    return r < 1.0 ? r + square(1.0 - r) * r / (1.0 - square(r)) : 1.0;
}

Spectrum Fresnel::evaluate(double cos_o, bool inverted) const {
    Spectrum f;
    switch (kind_) {
        case BxdfComponent::Fresnel::ideal:
            f = Spectrum::Ones();
            break;
        case BxdfComponent::Fresnel::dielectric:
            f = Spectrum::Constant(fresnel_dielectric(cos_o, inverted ? 1.0 / eta_[0] : eta_[0]));
            break;
        case BxdfComponent::Fresnel::conductor:
            for (int i = 0; i < 3; ++i) {
                f[i] = fresnel_conductor(cos_o, eta_[i], k_[i]);
            }
            break;
        case BxdfComponent::Fresnel::conductor_approximate:
            for (int i = 0; i < 3; ++i) {
                f[i] = fresnel_conductor_approximate(cos_o, eta_[i], k_[i]);
            }
            break;
        case BxdfComponent::Fresnel::schlick:
            for (int i = 0; i < 3; ++i) {
                f[i] = fresnel_schlick(cos_o, eta_[i]);
            }
            break;
        case BxdfComponent::Fresnel::thin_dielectric:
            f = Spectrum::Constant(thin_plate_reflectance(cos_o, eta_[1]));
            break;
        default:
            throw run_error("unknown Fresnel term");
    }
    return complement_ ? Spectrum(1.0 - f) : f;
}

}  // namespace rtrays::reference
