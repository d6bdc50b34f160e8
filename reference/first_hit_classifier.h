// SPDX-License-Identifier: MIT
// Finds the class of a pixel (`FirstHit`) by camera rays that follow all delta events.
#pragma once

#include <cstdint>

#include "reference/bsdf.h"
#include "reference/camera.h"
#include "reference/first_hit.h"
#include "reference/integrator.h"
#include "reference/light.h"
#include "reference/rng.h"

namespace rtrays::reference {

/// Finds the class of a pixel from a fixed grid of camera rays.
///
/// Each ray follows all delta events, reflections as well as refractions. A path through at least
/// one event that meets an emitter, or a light at infinity, makes the pixel `light_behind_delta`. A
/// first hit with a delta component makes it `delta`. The strongest class of its rays is the
/// pixel's: a light that covers a part of a pixel causes most of the variance there.
///
/// Lens positions and the surfaces that let a ray pass are random numbers of pixel and ray, so that
/// the class is deterministic.
class FirstHitClassifier {
  public:
    FirstHitClassifier(const World<Bsdf, LightSet> &world, const Camera &camera)
        : world_(world), camera_(camera) {}

    FirstHit of_pixel(uint64_t x, uint64_t y, uint64_t index) const;

    static constexpr int grid = 4;  ///< rays along each side of a pixel
    /// Paths end after this number of events, as total reflection in a solid never ends.
    static constexpr int most_events = 32;
    /// Paths end where this share of the energy remains. A twofold reflection inside glass has
    /// about 0.002.
    static constexpr double smallest_share = 1e-3;

  private:
    FirstHit of_ray(const Ray &ray, Rng &rng) const;

    World<Bsdf, LightSet> world_;
    const Camera &camera_;
};

}  // namespace rtrays::reference
