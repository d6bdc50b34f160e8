// SPDX-License-Identifier: MIT
// Reduction of spectra to linear Rec. 709, as in the RGB variants of Mitsuba 3.9.
#pragma once

#include <Eigen/Core>
#include <vector>

namespace rtrays::mitsuba {

/// The quantity that a spectrum describes. It decides the weight of the wavelengths.
enum class SpectrumUse {
    reflectance,  ///< below illuminant D65, clipped to [0, 1]
    index,        ///< eta or k of a conductor: below illuminant D65, negative channels are 0
    emission,     ///< radiance or power: without illuminant, negative channels are 0
};

/// Values at increasing wavelengths, in nanometres. Linear in between, zero outside.
struct Spectrum {
    std::vector<double> wavelengths, values;
};

/// Illuminant E (equal energy at all wavelengths, CIE XYZ = (1, 1, 1)) in linear Rec. 709
/// (IEC 61966-2-1). It is the emission of a spectrum of constant value 1. As a reflectance that
/// spectrum is (1, 1, 1), because reflectances are relative to white.
Eigen::Vector3d illuminant_e();

/// Returns the radiance of a black body at a temperature in kelvin by Planck's law, in
/// W / (m^2 sr nm), from 360 to 830 nm.
Spectrum blackbody(double temperature);

/// Returns the colour of a spectrum by the CIE 1931 observer. Sums 1000 wavelengths from 360 to
/// 830 nm like Mitsuba (src/core/spectrum.cpp, spectrum_list_to_srgb). Throws `Error` (bad input)
/// unless there are two wavelengths or more, in increasing order.
Eigen::Vector3d spectrum_colour(const Spectrum &spectrum, SpectrumUse use);

}  // namespace rtrays::mitsuba
