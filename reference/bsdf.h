// SPDX-License-Identifier: MIT
// Scattering at surfaces. Every model is a small value type with the same four members, in the local frame
// of the shading normal (z up, front side z > 0); `wi` and `wo` point away from the surface:
//
//     Spectrum evaluate(wi, wo)   the BSDF f [1/sr], WITHOUT the cosine; 0 for delta components
//     double pdf_w(wi, wo)        density of sample() per solid angle of wi; 0 for delta components
//     std::optional<BsdfSample> sample(wo, rng)   nothing when the path is absorbed
//     bool is_delta()             true when evaluate() is 0 everywhere: light sampling is of no use
//
// A new model is one more alternative of the variant `Bsdf`: the compiler names every place that must know.
#pragma once

#include <optional>
#include <variant>
#include <vector>

#include "reference/math.h"
#include "reference/rng.h"
#include "reference/sampling.h"
#include "renderer/scene/stores.h"

namespace rtrays::reference {

struct BsdfSample {
    Vec3 wi;
    Spectrum weight;  ///< f |cos(theta_i)| / pdf_w; for a delta event its coefficient over its probability
    double pdf_w;     ///< per solid angle; not used for a delta event
    bool delta;
};

/// Ideal diffuse reflection of both sides (thesis (3.31)).
class Lambert {
  public:
    explicit Lambert(const Spectrum &albedo) : albedo_(albedo) {}

    Spectrum evaluate(const Vec3 &wi, const Vec3 &wo) const {
        return same_side(wi, wo) ? Spectrum(albedo_ * inv_pi) : Spectrum::Zero();
    }

    double pdf_w(const Vec3 &wi, const Vec3 &wo) const {
        return same_side(wi, wo) ? std::abs(wi.z()) * inv_pi : 0.0;
    }

    std::optional<BsdfSample> sample(const Vec3 &wo, Rng &rng) const {
        Vec3 wi = sample_cosine_hemisphere(rng);
        const double pdf = wi.z() * inv_pi;
        if (!(pdf > 0.0)) {
            return std::nullopt;  // exactly in the surface: an event of probability 2^-53
        }
        wi.z() = std::copysign(wi.z(), wo.z());
        return BsdfSample{wi, albedo_, pdf, false};
    }

    bool is_delta() const { return false; }

  private:
    static bool same_side(const Vec3 &wi, const Vec3 &wo) { return wi.z() * wo.z() > 0.0; }

    Spectrum albedo_;
};

/// The closed set of models.
class Bsdf {
  public:
    template <class Model>
    Bsdf(const Model &model) : model_(model) {}  // NOLINT: an implicit conversion is the point

    Spectrum evaluate(const Vec3 &wi, const Vec3 &wo) const {
        return std::visit([&](const auto &model) { return model.evaluate(wi, wo); }, model_);
    }
    double pdf_w(const Vec3 &wi, const Vec3 &wo) const {
        return std::visit([&](const auto &model) { return model.pdf_w(wi, wo); }, model_);
    }
    std::optional<BsdfSample> sample(const Vec3 &wo, Rng &rng) const {
        return std::visit([&](const auto &model) { return model.sample(wo, rng); }, model_);
    }
    bool is_delta() const {
        return std::visit([](const auto &model) { return model.is_delta(); }, model_);
    }

  private:
    std::variant<Lambert> model_;
};

/// One BSDF per material. Throws `Error` (bad input) for an albedo outside [0, 1], naming the material.
std::vector<Bsdf> make_bsdfs(const MaterialArrays &materials);

}  // namespace rtrays::reference
