// SPDX-License-Identifier: MIT
#include "renderer/scene/cores/light.h"

#include <fmt/format.h>

#include <utility>

namespace rtrays {

namespace {

using Kind = LightArrays::Kind;

Parameter colour(const char *name, const char *help) {
    return {name, help, Eigen::Vector3d(0, 0, 0), Parameter::Need::required, ranges::not_negative};
}

void check_cones(const ParameterSet &spot) {
    const double inner = spot.number("inner_degrees");
    const double outer = spot.number("outer_degrees");
    if (!(inner < outer)) {
        throw input_error(
            fmt::format("inner_degrees: {} must be less than outer_degrees, {}; the light falls to "
                        "zero between them",
                        inner, outer));
    }
}

}  // namespace

const std::vector<LightType> &light_types() {
    constexpr Range half{0, 90, true, true};
    constexpr auto required = Parameter::Need::required;
    static const std::vector<LightType> types = {
        {{"diffuse_area",
          {colour("radiance", "radiance leaving the front, W / (sr m^2), linear Rec. 709")},
          {}},
         Kind::diffuse_area,
         "radiance"},
        {{"point", {colour("intensity", "radiant intensity, W / sr, linear Rec. 709")}, {}},
         Kind::point,
         "intensity"},
        {{"spot",
          {colour("intensity", "radiant intensity on the axis, W / sr, linear Rec. 709"),
           {"inner_degrees", "angle from the axis within which the intensity is full, degrees", 0.0,
            required, half},
           {"outer_degrees", "angle from the axis beyond which the intensity is zero, degrees", 0.0,
            required, half}},
          check_cones},
         Kind::spot,
         "intensity"},
        {{"directional",
          {colour("irradiance",
                  "irradiance of a plane facing the light, W / m^2, linear Rec. 709")},
          {}},
         Kind::directional,
         "irradiance"},
        {{"dome",
          {colour("radiance", "radiance from all directions, W / (sr m^2), linear Rec. 709")},
          {}},
         Kind::dome,
         "radiance"},
        {{"environment",
          {{"scale", "factor of the image", Eigen::Vector3d(1, 1, 1), Parameter::Need::defaulted,
            ranges::not_negative}},
          {}},
         Kind::environment,
         "scale"},
    };
    return types;
}

LightCore::LightCore(std::string name, const std::string &type, const ParameterValues &values)
    : ParameterCore(std::move(name), static_type<CoreType>(find_type(light_types(), type, "light")),
                    values) {
    if (kind() == Kind::environment) {
        throw input_error("an environment light needs an image");
    }
}

LightCore::LightCore(std::string name, std::shared_ptr<const TextureImage> image,
                     const ParameterValues &values)
    : ParameterCore(std::move(name),
                    static_type<CoreType>(find_type(light_types(), "environment", "light")),
                    values),
      image_(std::move(image)) {
    if (image_ == nullptr || image_->floats.empty()) {
        throw input_error(
            "file: an environment light needs a floating-point image (.hdr, .exr), not an 8-bit "
            "one");
    }
}

Kind LightCore::kind() const {
    return static_cast<const LightType &>(type()).kind;
}

const Eigen::Vector3d &LightCore::radiance() const {
    return parameters().vector3(static_cast<const LightType &>(type()).radiance);
}

}  // namespace rtrays
