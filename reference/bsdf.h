// SPDX-License-Identifier: MIT
// Scattering at surfaces, in the local frame of the shading normal (z up, front side z > 0; x along
// the tangent); `wi` and `wo` point away from the surface. A model has the members
//
//     Spectrum evaluate(wi, wo, uv)   the BSDF f [1/sr], WITHOUT the cosine; 0 for delta components
//     double pdf_w(wi, wo, uv)        density of sample() per solid angle of wi; 0 for delta
//     components std::optional<BsdfSample> sample(wo, uv, rng)   nothing when the path is absorbed
//     bool is_delta()                 true when evaluate() is 0 everywhere: light sampling is of no
//     use bool needs_parametrization()    whether uv or the tangent change anything
//
// Radiance through a refraction carries the factor (eta_o / eta_i)^2: paths start at the camera.
//
// Where the shading normal is not the geometric one (interpolated normals), the integrator decides:
// a direction whose sides of the two differ scatters nothing, sampled or evaluated (see shading.h).
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

struct BsdfSample {
    Vec3 wi;
    Spectrum weight;  ///< f |cos(theta_i)| / pdf_w; for a delta event its coefficient over its
                      ///< probability
    double pdf_w;     ///< per solid angle; not used for a delta event
    bool delta;
    double expansion = 1.0;  ///< (eta_i / eta_o)^2 of a refraction: `weight` times it is energy
};

/// Ideal diffuse reflection of both sides (thesis (3.31)): the plain case, made for speed.
class Lambert {
  public:
    explicit Lambert(const Spectrum &albedo) : albedo_(albedo) {}

    Spectrum evaluate(const Vec3 &wi, const Vec3 &wo, const Eigen::Vector2d &) const {
        return same_side(wi, wo) ? Spectrum(albedo_ * inv_pi) : Spectrum::Zero();
    }

    double pdf_w(const Vec3 &wi, const Vec3 &wo, const Eigen::Vector2d &) const {
        return same_side(wi, wo) ? std::abs(wi.z()) * inv_pi : 0.0;
    }

    std::optional<BsdfSample> sample(const Vec3 &wo, const Eigen::Vector2d &, Rng &rng) const {
        Vec3 wi = sample_cosine_hemisphere(rng);
        const double pdf = wi.z() * inv_pi;
        if (!(pdf > 0.0)) {
            return std::nullopt;  // exactly in the surface: an event of probability 2^-53
        }
        wi.z() = std::copysign(wi.z(), wo.z());
        return BsdfSample{wi, albedo_, pdf, false};
    }

    bool is_delta() const { return false; }
    bool needs_parametrization() const { return false; }

  private:
    static bool same_side(const Vec3 &wi, const Vec3 &wo) { return wi.z() * wo.z() > 0.0; }

    Spectrum albedo_;
};

/// Weighted sum of components (thesis (3.51)). One is chosen with a probability proportional to its
/// `importance`, which depends on the local geometry alone; the density is the sum over all
/// components that are not delta (departure from thesis 2.7.4, which takes the chosen one's: higher
/// variance).
///
/// A material with a refracting component is a boundary, seen from both sides with eta or 1 / eta.
/// Any other looks the same from both sides, or is black from behind when it is not two-sided.
class Composite {
  public:
    Composite(std::vector<Component> components, bool two_sided);

    Spectrum evaluate(const Vec3 &wi, const Vec3 &wo, const Eigen::Vector2d &uv) const;
    double pdf_w(const Vec3 &wi, const Vec3 &wo, const Eigen::Vector2d &uv) const;
    std::optional<BsdfSample> sample(const Vec3 &wo, const Eigen::Vector2d &uv, Rng &rng) const;
    bool is_delta() const { return delta_; }
    bool needs_parametrization() const { return true; }

    static constexpr size_t most_components = 16;

  private:
    bool is_black(const Vec3 &wo) const { return !visible_from_behind_ && !(wo.z() > 0.0); }
    Viewpoint viewpoint(const Vec3 &wo, const Eigen::Vector2d &uv) const;
    double density(const Vec3 &wi, const Viewpoint &view) const;
    Spectrum sum(const Vec3 &wi, const Viewpoint &view) const;

    double expansion(const Vec3 &wi, const Viewpoint &view) const;

    std::vector<Component> components_;
    double eta_;  ///< of the first refracting component
    bool boundary_;
    bool visible_from_behind_;
    bool delta_;
};

/// The closed set of models.
class Bsdf {
  public:
    template <class Model>
    Bsdf(const Model &model) : model_(model) {}  // NOLINT: an implicit conversion is the point

    Spectrum evaluate(const Vec3 &wi, const Vec3 &wo, const Eigen::Vector2d &uv) const {
        return std::visit([&](const auto &model) { return model.evaluate(wi, wo, uv); }, model_);
    }
    double pdf_w(const Vec3 &wi, const Vec3 &wo, const Eigen::Vector2d &uv) const {
        return std::visit([&](const auto &model) { return model.pdf_w(wi, wo, uv); }, model_);
    }
    std::optional<BsdfSample> sample(const Vec3 &wo, const Eigen::Vector2d &uv, Rng &rng) const {
        return std::visit([&](const auto &model) { return model.sample(wo, uv, rng); }, model_);
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

/// One BSDF per material. Throws `Error` (bad input) for parameters out of range, naming material
/// and component.
std::vector<Bsdf> make_bsdfs(const MaterialArrays &materials, const TextureArrays &textures);

}  // namespace rtrays::reference
