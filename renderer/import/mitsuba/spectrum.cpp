// SPDX-License-Identifier: MIT
#include "renderer/import/mitsuba/spectrum.h"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <functional>
#include <iterator>

#include "renderer/base/error.h"
#include "renderer/import/mitsuba/measured.h"

namespace rtrays::mitsuba {

namespace {

using Eigen::Matrix3d;
using Eigen::Vector3d;

constexpr double first_wavelength = 360, last_wavelength = 830;

/// Linear Rec. 709 from CIE XYZ, with the digits that Mitsuba has.
Matrix3d rgb_from_xyz() {
    Matrix3d matrix;
    matrix << 3.240479, -1.537150, -0.498535,  //
        -0.969256, 1.875991, 0.041556,         //
        0.055648, -0.204043, 1.057311;
    return matrix;
}

/// Returns the sensitivities X, Y, Z and the relative power of D65 at a wavelength.
Eigen::Vector4d observed(double wavelength) {
    constexpr size_t last = std::size(observer) - 1;
    const double at = (wavelength - first_wavelength) / (last_wavelength - first_wavelength) * last;
    const size_t below = std::min(static_cast<size_t>(at), last - 1);
    const double t = at - static_cast<double>(below);
    Eigen::Vector4d row;
    for (Eigen::Index i = 0; i < 4; ++i) {
        row[i] = (1 - t) * observer[below][i] + t * observer[below + 1][i];
    }
    return row;
}

/// Returns the value between the two wavelengths around `wavelength`, which is in the range.
double value_at(const Spectrum &spectrum, double wavelength) {
    const auto above = std::upper_bound(spectrum.wavelengths.begin() + 1,
                                        spectrum.wavelengths.end() - 1, wavelength);
    const auto i = static_cast<size_t>(above - spectrum.wavelengths.begin());
    const double a = spectrum.wavelengths[i - 1], b = spectrum.wavelengths[i];
    return ((b - wavelength) * spectrum.values[i - 1] + (wavelength - a) * spectrum.values[i]) /
           (b - a);
}

}  // namespace

Vector3d illuminant_e() {
    return rgb_from_xyz() * Vector3d::Ones();
}

Spectrum blackbody(double temperature) {
    // Exact by the definition of the units (SI, 2019).
    constexpr double planck = 6.62607015e-34, light_speed = 299792458, boltzmann = 1.380649e-23;
    Spectrum spectrum;
    for (double wavelength = first_wavelength; wavelength <= last_wavelength; ++wavelength) {
        const double metres = 1e-9 * wavelength;
        const double exponent = planck * light_speed / (metres * boltzmann * temperature);
        spectrum.wavelengths.push_back(wavelength);
        spectrum.values.push_back(1e-9 * 2 * planck * light_speed * light_speed /
                                  (std::pow(metres, 5) * std::expm1(exponent)));
    }
    return spectrum;
}

Vector3d spectrum_colour(const Spectrum &spectrum, SpectrumUse use) {
    const std::vector<double> &wavelengths = spectrum.wavelengths;
    if (wavelengths.size() < 2 || std::adjacent_find(wavelengths.begin(), wavelengths.end(),
                                                     std::greater_equal<>()) != wavelengths.end()) {
        throw input_error("expected two or more wavelengths in increasing order");
    }
    constexpr int steps = 1000;
    Vector3d xyz = Vector3d::Zero();
    for (int i = 0; i < steps; ++i) {
        const double wavelength =
            first_wavelength + i / (steps - 1.0) * (last_wavelength - first_wavelength);
        if (wavelength < wavelengths.front() || wavelength > wavelengths.back()) {
            continue;
        }
        const Eigen::Vector4d row = observed(wavelength);
        const double light = use == SpectrumUse::emission ? 1 : row[3] / d65_luminance;
        xyz += light * value_at(spectrum, wavelength) * row.head<3>();
    }
    xyz *= (last_wavelength - first_wavelength) / steps / observer_luminance;
    const Vector3d rgb = (rgb_from_xyz() * xyz).cwiseMax(0.0);
    return use == SpectrumUse::reflectance ? Vector3d(rgb.cwiseMin(1.0)) : rgb;
}

}  // namespace rtrays::mitsuba
