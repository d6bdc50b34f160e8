// SPDX-License-Identifier: MIT
// Point, spot and directional lights, which no path can hit. They have the members of area lights
// (area_light.h), but their samples hold an irradiance.
#pragma once

#include <optional>

#include "reference/geometry.h"
#include "reference/light_sample.h"
#include "reference/math.h"
#include "reference/rng.h"

namespace rtrays::reference {

/// Base of the lights that no path can hit: density and emission are zero.
struct Unhittable {
    double pdf_w(const Geometry &, const Vec3 &, const SurfacePoint &) const { return 0.0; }
    Spectrum emitted(const Geometry &, const SurfacePoint &, const Vec3 &) const {
        return Spectrum::Zero();
    }
};

/// Point light of radiant intensity `intensity` [W/sr] in all directions.
class PointLight : public Unhittable {
  public:
    PointLight(const Vec3 &position, const Spectrum &intensity)
        : position_(position), intensity_(intensity) {}

    std::optional<LightSample> sample(const Geometry &geometry, const Vec3 &from, Rng &rng) const;
    double power() const { return 4.0 * pi * intensity_.mean(); }

  private:
    Vec3 position_;
    Spectrum intensity_;
};

/// Point light whose intensity depends on the angle to its axis, as in Mitsuba 3. The intensity is
/// full up to the angle `inner` and falls linearly with the angle to zero at `outer` (radians).
class SpotLight : public Unhittable {
  public:
    SpotLight(const Vec3 &position, const Vec3 &axis, double inner, double outer,
              const Spectrum &intensity)
        : position_(position), axis_(axis), inner_(inner), outer_(outer), intensity_(intensity) {}

    std::optional<LightSample> sample(const Geometry &geometry, const Vec3 &from, Rng &rng) const;

    /// Returns the power of a cone of full intensity up to the mean of both angles. This
    /// approximation is good enough for light selection.
    double power() const {
        return 2.0 * pi * (1.0 - std::cos(0.5 * (inner_ + outer_))) * intensity_.mean();
    }

  private:
    Vec3 position_;
    Vec3 axis_;  ///< unit, the direction in which the light travels
    double inner_, outer_;
    Spectrum intensity_;
};

/// Parallel light of irradiance `irradiance` [W/m^2] on a plane facing it.
class DirectionalLight : public Unhittable {
  public:
    DirectionalLight(const Vec3 &axis, const Spectrum &irradiance, double scene_radius)
        : axis_(axis), irradiance_(irradiance), scene_radius_(scene_radius) {}

    std::optional<LightSample> sample(const Geometry &, const Vec3 &, Rng &) const {
        return LightSample{-axis_, Vec3::Zero(), irradiance_, 1.0, true, true};
    }
    double power() const { return pi * square(scene_radius_) * irradiance_.mean(); }

  private:
    Vec3 axis_;
    Spectrum irradiance_;
    double scene_radius_;
};

}  // namespace rtrays::reference
