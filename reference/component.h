// SPDX-License-Identifier: MIT
// Component of a composite BSDF: weight * texture * mix * F * f (thesis (3.52)).
#pragma once

#include <optional>
#include <variant>

#include "reference/coat.h"
#include "reference/fresnel.h"
#include "reference/lobes.h"
#include "reference/texture.h"
#include "renderer/scene/stores.h"

namespace rtrays::reference {

/// The outgoing direction as a component sees it, mirrored to the upper side, with the surface
/// state.
struct Viewpoint {
    Vec3 wo;        ///< wo.z > 0
    bool behind;    ///< wo is behind the surface
    bool inverted;  ///< wo is behind a boundary, so dielectric indices are 1 / eta
    TexturePoint at;
};

/// Direction and coefficient of a delta component.
struct DeltaEvent {
    Vec3 wi;
    Spectrum coefficient;  ///< f |cos(theta_i)| without the delta function
};

/// A BxDF with its weight, texture and Fresnel term.
class Component {
  public:
    /// Throws `Error` (bad input) naming `what` for parameters out of range.
    Component(const BxdfComponent &component, const TextureArrays &textures,
              const std::string &what);

    bool is_delta() const { return delta_; }
    bool transmits() const { return transmits_; }
    /// Index of refraction behind the surface over that in front of it.
    double eta() const { return eta_; }

    /// Returns f with all its factors [1/sr]; 0 for delta components. `wi` must be below the
    /// surface if `transmits()`, above it otherwise.
    Spectrum evaluate(const Vec3 &wi, const Viewpoint &view) const;

    /// Returns the density of `sample` per solid angle; 0 for delta components.
    double pdf_w(const Vec3 &wi, const Viewpoint &view) const;

    /// Samples wi. Returns nothing for delta components, or if the sample is on the wrong side.
    std::optional<Vec3> sample(const Viewpoint &view, Rng &rng) const;

    /// Returns the event of a delta component, or nothing at total internal reflection.
    std::optional<DeltaEvent> scatter(const Viewpoint &view) const;

    /// Returns the importance of this component when `Composite` selects one: the mean over the
    /// channels of weight * texture * F(wo.z).
    ///
    /// The Fresnel term of a rough component is evaluated at the half vector and may exceed
    /// F(wo.z). It can be nonzero where F(wo.z) is 0, in rough refraction beyond the critical
    /// angle. Therefore a twentieth of a rough component's importance ignores F.
    double importance(const Viewpoint &view) const;

  private:
    using Lobe = std::variant<OrenNayarLobe, BlinnLobe, WardLobe, DisneyDiffuseLobe,
                              DisneySheenLobe, DisneyClearcoatLobe, MicrofacetReflectionLobe,
                              MicrofacetRefractionLobe, IdealReflectionLobe, IdealRefractionLobe>;
    static Lobe make_lobe(const BxdfComponent &component);

    /// Calls `visit` with the lobe at the point.
    template <class Visit>
    auto with_lobe(const Viewpoint &view, const Visit &visit) const {
        return roughness_texture_ ? std::visit(visit, textured_lobe(view.at))
                                  : std::visit(visit, lobe_);
    }
    Lobe textured_lobe(const TexturePoint &at) const;

    /// Returns the cosine at which the Fresnel term of a rough component is evaluated.
    double half_cosine(const Vec3 &wi, const Viewpoint &view) const;
    Spectrum fresnel_factor(const Vec3 &wi, const Viewpoint &view) const;
    Spectrum colour(const Viewpoint &view) const {
        using Side = BxdfComponent::Side;
        if (side_ != Side::both && (side_ == Side::back) != view.behind) {
            return Spectrum::Zero();
        }
        const Spectrum albedo =
            texture_ ? Spectrum(weight_ * texture_->evaluate(view.at)) : weight_;
        return (coat_ ? coat_->base(albedo) : albedo) * mix(view.at);
    }
    /// Returns the share of the component in its mixture.
    double mix(const TexturePoint &at) const {
        if (!mix_texture_) {
            return 1.0;
        }
        const double share = mix_factor_ * luminance(mix_texture_->evaluate(at));
        return mix_inverted_ ? 1.0 - share : share;
    }
    double eta(const Viewpoint &view) const { return view.inverted ? 1.0 / eta_ : eta_; }

    Spectrum weight_;
    std::optional<Texture> texture_;
    /// Roughness is scaled by the luminance of this texture, and the lobe made for each point.
    std::optional<Texture> roughness_texture_;
    std::optional<Texture> mix_texture_;
    double mix_factor_;
    bool mix_inverted_;
    BxdfComponent textured_;  ///< what to scale, if roughness_texture_
    Fresnel fresnel_;
    double eta_;
    bool delta_;
    bool transmits_;
    bool rough_;  ///< the Fresnel term is evaluated at the half vector
    bool fresnel_of_wo_;
    BxdfComponent::Side side_;
    std::optional<Coat> coat_;  ///< of coated_lambert
    Lobe lobe_;
};

}  // namespace rtrays::reference
