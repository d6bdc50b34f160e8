// SPDX-License-Identifier: MIT
#include "reference/first_hit_classifier.h"

#include <algorithm>
#include <vector>

namespace rtrays::reference {

namespace {

/// A path from the camera through delta events that is still to be followed.
struct Branch {
    Ray ray;
    int events;
    double share;  ///< of the energy
};

}  // namespace

FirstHit FirstHitClassifier::of_ray(const Ray &camera_ray, Rng &rng) const {
    const Geometry &geometry = world_.geometry;
    std::vector<Branch> branches{{camera_ray, 0, 1.0}};
    FirstHit found = FirstHit::other;
    while (!branches.empty()) {
        const Branch branch = branches.back();
        branches.pop_back();
        SurfacePoint hit;
        const uint64_t key = geometry.is_opaque() ? 0 : rng.next_bits();
        const Vec3 wo = -branch.ray.direction;
        const bool is_hit = geometry.intersect(branch.ray, Coherence::incoherent, hit, key);
        if (branch.events > 0) {
            const uint32_t light = is_hit ? geometry.light(hit) : no_index;
            const Spectrum radiance =
                !is_hit
                    ? world_.lights.from_infinity(branch.ray.direction, [](double) { return 1.0; })
                : light != no_index ? world_.lights.emitted(geometry, light, hit, wo)
                                    : Spectrum(Spectrum::Zero());
            if ((radiance > 0.0).any()) {
                return FirstHit::light_behind_delta;
            }
        }
        if (!is_hit || branch.events == most_events) {
            continue;
        }
        const uint32_t material = geometry.material(hit);
        const Bsdf &bsdf = world_.bsdfs[material];
        const Shading shading =
            make_shading(geometry, hit, wo, bsdf.needs_parametrization(),
                         world_.tilts != nullptr ? &(*world_.tilts)[material] : nullptr);
        for (const BsdfSample &event : bsdf.delta_events(shading.frame.to_local(wo), shading.at)) {
            const Vec3 direction = shading.frame.to_world(event.wi);
            const double share =
                branch.share * event.weight.maxCoeff() * event.expansion * shading.share(direction);
            if (!(share > smallest_share) || !shading.agrees(direction, event.wi)) {
                continue;
            }
            found = FirstHit::delta;
            branches.push_back(
                {{geometry.spawn_point(hit, direction), direction}, branch.events + 1, share});
        }
    }
    return found;
}

FirstHit FirstHitClassifier::of_pixel(uint64_t x, uint64_t y, uint64_t index) const {
    FirstHit strongest = FirstHit::other;
    for (int i = 0; i < grid * grid && strongest != FirstHit::light_behind_delta; ++i) {
        Rng rng(0, index, static_cast<uint64_t>(i));
        const double film_x = static_cast<double>(x) + (i % grid + 0.5) / grid;
        const double film_y = static_cast<double>(y) + (i / grid + 0.5) / grid;
        strongest = std::min(strongest, of_ray(camera_.ray(film_x, film_y, rng), rng));
    }
    return strongest;
}

}  // namespace rtrays::reference
