// SPDX-License-Identifier: MIT
// Rows of parameter tables that several types of materials share.
#pragma once

#include <cmath>

#include "renderer/scene/parameters.h"
#include "renderer/scene/stores.h"

namespace rtrays::rows {

using Need = Parameter::Need;

/// Range of a roughness: not so smooth that rounding matters, and not beyond the validity of the
/// models.
inline constexpr Range roughness{BxdfComponent::least_alpha, 1, true, true};
inline constexpr Range index_of_refraction{0.01, 100, true, true};
/// Least difference from 1 of the index of a rough interface. Nearer to 1, refracted directions do
/// not determine the half vector.
inline constexpr double least_rough_bend = 1e-3;
/// Returns whether an interface of this index may be rough. The difference is rounded: that
/// of 1.001 is below 0.001 by 1e-16.
inline bool may_be_rough(double eta) {
    return std::abs(eta - 1) >= least_rough_bend * (1 - 1e-9);
}

inline Parameter colour(const std::string &name, const std::string &help,
                        Need need = Need::required) {
    return {name, help + ", within [0, 1]", Eigen::Vector3d(1, 1, 1), need, ranges::unit, {}, true};
}

inline Parameter sigma(const std::string &name) {
    return {name,
            "standard deviation of the slope angles, radians",
            0.0,
            Need::required,
            {0, 1.57079632679489662, true, true}};
}

inline Parameter exponent(const std::string &name, Need need = Need::required) {
    return {name, "Blinn's exponent", 1.0, need, {0, 1e8, false, true}};
}

/// Roughness of a surface that cannot be smooth.
inline Parameter alpha(const std::string &name, Need need = Need::required) {
    return {name,
            "roughness along the tangent and across it",
            Eigen::Vector2d(1, 1),
            need,
            roughness,
            {},
            true};
}

inline Parameter roughness_squared(const std::string &name) {
    return {name, "whether the square of the texture scales the roughness", false};
}

inline Parameter distribution(const std::string &name) {
    return {name,
            "distribution of the microfacet normals",
            std::string("ggx"),
            Need::defaulted,
            ranges::any,
            {"ggx", "beckmann"}};
}

inline Parameter dielectric_eta(const std::string &name, Need need = Need::required) {
    return {name, "index of refraction behind the surface over that in front of it", 1.5, need,
            index_of_refraction};
}

/// Roughness of a coat over a diffuse base.
inline Parameter coat_alpha(const std::string &name) {
    return {name, "roughness of the coat; 0 is ideally smooth", 0.0, Need::defaulted, ranges::unit};
}

inline Parameter coat_eta(const std::string &name, Need need = Need::required) {
    return {name,
            "index of refraction of the coat relative to the outside",
            1.5,
            need,
            {1, 3, false, true}};
}

inline Parameter nonlinear(const std::string &name) {
    return {name, "whether reflections between base and coat saturate the base's colour", false};
}

inline Parameter conductor_eta(const std::string &name, Need need = Need::required) {
    return {name, "index of refraction per channel", Eigen::Vector3d(1, 1, 1), need,
            index_of_refraction};
}

inline Parameter conductor_k(const std::string &name, Need need = Need::required) {
    return {name,
            "extinction coefficient per channel",
            Eigen::Vector3d(0, 0, 0),
            need,
            {0, 100, true, true}};
}

}  // namespace rtrays::rows
