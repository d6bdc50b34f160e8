// SPDX-License-Identifier: MIT
// BSDFs: the interface of surface scattering models, and the two models, Lambert and composite.
//
// Directions are in the local frame of the shading normal: z is up, z > 0 is the front side, and x
// is along the tangent. `wi` and `wo` point away from the surface. Every model has these members:
//
//     Spectrum evaluate(wi, wo, at)
//         BSDF value f [1/sr], WITHOUT the cosine; 0 for delta components.
//     double pdf_w(wi, wo, at)
//         Density of `sample` per solid angle of wi; 0 for delta components.
//     std::optional<BsdfSample> sample(wo, at, rng)
//         Samples wi; returns nothing if the path is absorbed.
//     std::vector<BsdfSample> delta_events(wo, at)
//         All delta events. Their weights are coefficients, without a probability.
//     bool is_delta()
//         Whether `evaluate` is 0 everywhere, so that light sampling is useless.
//     bool needs_parametrization()
//         Whether the results depend on `at` or on the tangent.
//
// Refraction multiplies radiance by (eta_o / eta_i)^2, because paths start at the camera.
//
// The integrator handles shading normals that differ from the geometric normal. It discards every
// sampled or evaluated direction that is on different sides of the two (see shading.h).
#pragma once

#include <optional>
#include <variant>
#include <vector>

#include "reference/component.h"
#include "reference/math.h"
#include "reference/rng.h"
#include "reference/sampling.h"
#include "renderer/scene/stores.h"

namespace rtrays::reference {

/// A sampled direction and its weight.
struct BsdfSample {
    Vec3 wi;
    Spectrum weight;  ///< f |cos(theta_i)| / pdf_w; delta events: coefficient / probability
    double pdf_w;     ///< per solid angle; unused for delta events
    bool delta;
    /// (eta_i / eta_o)^2 for a refraction, 1 otherwise. `weight` times `expansion` is the energy
    /// throughput.
    double expansion = 1.0;
};

/// Ideal diffuse reflection on both sides (thesis (3.31)): the fast path for the most common
/// material.
class Lambert {
  public:
    explicit Lambert(const Spectrum &albedo) : albedo_(albedo) {}

    Spectrum evaluate(const Vec3 &wi, const Vec3 &wo, const TexturePoint &) const {
        return same_side(wi, wo) ? Spectrum(albedo_ * inv_pi) : Spectrum::Zero();
    }

    double pdf_w(const Vec3 &wi, const Vec3 &wo, const TexturePoint &) const {
        return same_side(wi, wo) ? std::abs(wi.z()) * inv_pi : 0.0;
    }

    std::optional<BsdfSample> sample(const Vec3 &wo, const TexturePoint &, Rng &rng) const {
        Vec3 wi = sample_cosine_hemisphere(rng);
        const double pdf = wi.z() * inv_pi;
        if (!(pdf > 0.0)) {
            return std::nullopt;  // wi is in the surface plane, with probability 2^-53
        }
        wi.z() = std::copysign(wi.z(), wo.z());
        return BsdfSample{wi, albedo_, pdf, false};
    }

    std::vector<BsdfSample> delta_events(const Vec3 &, const TexturePoint &) const { return {}; }
    bool is_delta() const { return false; }
    bool needs_parametrization() const { return false; }

  private:
    static bool same_side(const Vec3 &wi, const Vec3 &wo) { return wi.z() * wo.z() > 0.0; }

    Spectrum albedo_;
};

/// Weighted sum of components (thesis (3.51)).
///
/// `sample` selects one component with a probability proportional to its `importance`, which does
/// not depend on wi. The density is the sum over all components that are not delta. Thesis, section
/// 2.7.4, uses the density of the selected component alone, which has higher variance.
///
/// A material with a refracting component is a boundary: its index ratio is eta from the front and
/// 1 / eta from behind. A two-sided material without such a component looks the same from both
/// sides. Any other material is black from behind.
class Composite {
  public:
    Composite(std::vector<Component> components, bool two_sided);

    Spectrum evaluate(const Vec3 &wi, const Vec3 &wo, const TexturePoint &at) const;
    double pdf_w(const Vec3 &wi, const Vec3 &wo, const TexturePoint &at) const;
    std::optional<BsdfSample> sample(const Vec3 &wo, const TexturePoint &at, Rng &rng) const;
    std::vector<BsdfSample> delta_events(const Vec3 &wo, const TexturePoint &at) const;
    bool is_delta() const { return delta_; }
    bool needs_parametrization() const { return true; }

    static constexpr size_t most_components = 16;

  private:
    bool is_black(const Vec3 &wo) const { return !visible_from_behind_ && !(wo.z() > 0.0); }
    Viewpoint viewpoint(const Vec3 &wo, const TexturePoint &at) const;
    double density(const Vec3 &wi, const Viewpoint &view) const;
    Spectrum sum(const Vec3 &wi, const Viewpoint &view) const;

    double expansion(const Vec3 &wi, const Viewpoint &view) const;

    std::vector<Component> components_;
    double eta_;  ///< index ratio of the first refracting component
    bool boundary_;
    bool visible_from_behind_;
    bool delta_;
};

/// A BSDF of any model. The set of models is closed.
class Bsdf {
  public:
    template <class Model>
    Bsdf(const Model &model) : model_(model) {}  // NOLINT: the conversion is meant to be implicit

    Spectrum evaluate(const Vec3 &wi, const Vec3 &wo, const TexturePoint &at) const {
        return std::visit([&](const auto &model) { return model.evaluate(wi, wo, at); }, model_);
    }
    double pdf_w(const Vec3 &wi, const Vec3 &wo, const TexturePoint &at) const {
        return std::visit([&](const auto &model) { return model.pdf_w(wi, wo, at); }, model_);
    }
    std::optional<BsdfSample> sample(const Vec3 &wo, const TexturePoint &at, Rng &rng) const {
        return std::visit([&](const auto &model) { return model.sample(wo, at, rng); }, model_);
    }
    std::vector<BsdfSample> delta_events(const Vec3 &wo, const TexturePoint &at) const {
        return std::visit([&](const auto &model) { return model.delta_events(wo, at); }, model_);
    }
    bool is_delta() const {
        return std::visit([](const auto &model) { return model.is_delta(); }, model_);
    }
    bool needs_parametrization() const {
        return std::visit([](const auto &model) { return model.needs_parametrization(); }, model_);
    }

  private:
    std::variant<Lambert, Composite> model_;
};

/// Builds one BSDF per material. Throws `Error` (bad input) naming material and component for
/// parameters out of range.
std::vector<Bsdf> make_bsdfs(const MaterialArrays &materials, const TextureArrays &textures);

}  // namespace rtrays::reference
