// SPDX-License-Identifier: MIT
// Path tracing (thesis (2.59)-(2.68); Kajiya 1986; Veach 1997, chapters 9 and 10).
//
// The integrator is a template over the BSDF and light models, so that tests can run the production
// code with models that are wrong on purpose.
#pragma once

#include <algorithm>
#include <cstdint>
#include <optional>
#include <vector>

#include "reference/geometry.h"
#include "reference/math.h"
#include "reference/rng.h"
#include "reference/sampling.h"
#include "reference/settings.h"
#include "reference/shading.h"

namespace rtrays::reference {

/// Numbers of rays cast.
struct RayCounts {
    uint64_t camera = 0;
    uint64_t bounce = 0;
    uint64_t shadow = 0;

    RayCounts &operator+=(const RayCounts &other) {
        camera += other.camera;
        bounce += other.bounce;
        shadow += other.shadow;
        return *this;
    }
};

/// The parts of a scene that the integrator uses.
template <class BsdfModel, class Lights>
struct World {
    const Geometry &geometry;
    const std::vector<BsdfModel> &bsdfs;  ///< indexed by material
    const Lights &lights;
    const std::vector<NormalTilt> *tilts = nullptr;  ///< indexed by material; nullptr: no maps
};

/// Upper bound of the survival probability in Russian roulette.
///
/// The survival probability is the largest channel of the throughput, as energy. It excludes the
/// compression of radiance by refraction, which is undone when the path leaves the glass. This
/// keeps the path weight near 1 for any albedo below 1.
///
/// The bound ends paths between walls that absorb nothing, after about a million bounces. With a
/// lower bound, weights would grow by albedo / bound per bounce. The variance would be infinite if
/// albedo^2 >= bound.
constexpr double roulette_cap = 1.0 - 0x1p-20;

/// Estimates the radiance along camera rays.
template <class BsdfModel, class Lights>
class PathIntegrator {
  public:
    /// `joinable_only`, `roulette`: see `ReferenceSettings`.
    PathIntegrator(const World<BsdfModel, Lights> &world, Strategies strategies, uint32_t max_depth,
                   const std::optional<JoinableLight> &joinable_only = {}, bool roulette = true)
        : world_(world),
          samples_lights_(strategies != Strategies::implicit_only && !world.lights.empty()),
          counts_hits_(strategies != Strategies::explicit_only),
          max_depth_(max_depth),
          joinable_only_(joinable_only),
          roulette_(roulette) {}

    /// Estimates the radiance arriving along a camera ray [W / (sr m^2)], including directly
    /// visible emitters. The estimate is unbiased for every choice of strategies, except that
    /// implicit_only cannot see point, spot and directional lights. Every strategy counts emission
    /// that is hit after a delta event.
    Spectrum radiance(Ray ray, Rng &rng, RayCounts &counts) const {
        Spectrum result = Spectrum::Zero();
        Spectrum throughput = Spectrum::Ones();
        double expansion = 1.0;  // product of eta^2 over all refractions, which compress radiance
        Vec3 previous = Vec3::Zero();   // position of the previous vertex
        double pdf_of_direction = 0.0;  // density per solid angle at the previous vertex
        // Whether the previous vertex could have sampled this light explicitly.
        bool light_sampled_too = false;
        ++counts.camera;

        for (uint32_t depth = 0;; ++depth) {
            SurfacePoint hit;
            if (!world_.geometry.intersect(ray,
                                           depth == 0 ? Coherence::coherent : Coherence::incoherent,
                                           hit, key_of_ray(rng))) {
                if (world_.lights.reach_to_infinity() && !(joinable_only_ && depth == 0)) {
                    result += throughput * escaped_radiance(previous, ray.direction,
                                                            light_sampled_too, pdf_of_direction);
                }
                return result;
            }
            const uint32_t light = world_.geometry.light(hit);
            const Vec3 wo = -ray.direction;

            if (light != no_index) {
                const Spectrum emitted = world_.lights.emitted(world_.geometry, light, hit, wo);
                if ((emitted > 0.0).any()) {
                    const double pdf_w =
                        light_sampled_too
                            ? world_.lights.pdf_w(world_.geometry, light, previous, hit)
                            : 0.0;
                    result += throughput * emitted *
                              implicit_weight(light_sampled_too, pdf_of_direction, pdf_w);
                }
            }
            if (max_depth_ != 0 && depth == max_depth_) {
                return result;
            }

            const uint32_t material = world_.geometry.material(hit);
            const BsdfModel &bsdf = world_.bsdfs[material];
            const Shading shading =
                make_shading(world_.geometry, hit, wo, bsdf.needs_parametrization(),
                             world_.tilts != nullptr ? &(*world_.tilts)[material] : nullptr);
            const Vec3 wo_local = shading.frame.to_local(wo);
            light_sampled_too = samples_lights_ && !bsdf.is_delta();
            if (light_sampled_too) {
                result += throughput * direct_light(bsdf, shading, wo_local, hit, rng, counts);
            }

            const auto sample = bsdf.sample(wo_local, shading.at, rng);
            if (!sample) {
                return result;
            }
            ray.direction = shading.frame.to_world(sample->wi);
            if (!shading.agrees(ray.direction, sample->wi)) {
                return result;
            }
            if (joinable_only_ && depth == 0 && sample->delta) {
                return result;
            }
            light_sampled_too = light_sampled_too && !sample->delta;
            if (depth + 1 == max_depth_ && light_sampled_too && !counts_hits_) {
                return result;  // emission hit by the last ray would not count
            }
            throughput *= sample->weight * shading.share(ray.direction);
            expansion *= sample->expansion;
            if (roulette_) {
                const double survival = std::min(throughput.maxCoeff() * expansion, roulette_cap);
                if (rng.uniform() >= survival) {
                    return result;
                }
                throughput /= survival;
            }

            pdf_of_direction = sample->pdf_w;
            previous = hit.position;
            ray.origin = world_.geometry.spawn_point(hit, ray.direction);
            ++counts.bounce;
        }
    }

  private:
    /// Returns the MIS weight of emission hit along a direction that the BSDF samples with density
    /// `pdf_of_direction` and light sampling with density `pdf_of_light`. All densities omit
    /// Russian roulette.
    double implicit_weight(bool light_sampled_too, double pdf_of_direction,
                           double pdf_of_light) const {
        if (!light_sampled_too) {
            return 1.0;
        }
        return counts_hits_ ? power_heuristic(pdf_of_direction, pdf_of_light) : 0.0;
    }

    /// Returns the random number of a ray, which decides whether surfaces let it pass. Scenes whose
    /// surfaces are all opaque draw none.
    uint64_t key_of_ray(Rng &rng) const {
        return world_.geometry.is_opaque() ? 0 : rng.next_bits();
    }

    /// Returns the weighted radiance from infinity as seen from a vertex. It is not inlined,
    /// because the fast case is a path that hits surfaces.
    [[gnu::noinline]] Spectrum escaped_radiance(const Vec3 &from, const Vec3 &direction,
                                                bool light_sampled_too,
                                                double pdf_of_direction) const {
        if (joinable_only_ && !joinable_only_->reaches(from, direction)) {
            return Spectrum::Zero();
        }
        return world_.lights.from_infinity(direction, [&](double pdf_w) {
            return implicit_weight(light_sampled_too, pdf_of_direction, pdf_w);
        });
    }

    /// Returns the weighted contribution of one explicit connection: f Le |cos| / pdf_w.
    [[gnu::always_inline]] inline Spectrum direct_light(const BsdfModel &bsdf,
                                                        const Shading &shading,
                                                        const Vec3 &wo_local,
                                                        const SurfacePoint &point, Rng &rng,
                                                        RayCounts &counts) const {
        const auto light = world_.lights.sample(world_.geometry, point.position, rng);
        if (!light || (joinable_only_ && light->infinite &&
                       !joinable_only_->reaches(point.position, light->wi))) {
            return Spectrum::Zero();
        }
        const Vec3 wi_local = shading.frame.to_local(light->wi);
        if (!shading.agrees(light->wi, wi_local)) {
            return Spectrum::Zero();
        }
        const Spectrum f = bsdf.evaluate(wi_local, wo_local, shading.at);
        if (!(f > 0.0).any()) {
            return Spectrum::Zero();
        }
        ++counts.shadow;
        const Vec3 from = world_.geometry.spawn_point(point, light->wi);
        const uint64_t key = key_of_ray(rng);
        if (light->infinite ? world_.geometry.occluded({from, light->wi}, key)
                            : world_.geometry.occluded(from, light->target, key)) {
            return Spectrum::Zero();
        }
        const double weight =
            counts_hits_ && !light->delta
                ? power_heuristic(light->pdf_w, bsdf.pdf_w(wi_local, wo_local, shading.at))
                : 1.0;
        return f * light->radiance *
               (weight * shading.share(light->wi) * std::abs(wi_local.z()) / light->pdf_w);
    }

    World<BsdfModel, Lights> world_;
    bool samples_lights_;
    bool counts_hits_;
    uint32_t max_depth_;
    std::optional<JoinableLight> joinable_only_;
    bool roulette_;
};

}  // namespace rtrays::reference
