// SPDX-License-Identifier: MIT
// One term of a composite BSDF: weight * texture * F * f (thesis (3.52)).
#pragma once

#include <optional>
#include <variant>

#include "reference/fresnel.h"
#include "reference/lobes.h"
#include "reference/texture.h"
#include "renderer/scene/stores.h"

namespace rtrays::reference {

/// wo as a component sees it: on the upper side, with the surface's state that belongs to it.
struct Viewpoint {
    Vec3 wo;        ///< wo.z > 0
    bool inverted;  ///< seen from behind a boundary: dielectric indices are 1 / eta
    Eigen::Vector2d uv;
};

struct DeltaEvent {
    Vec3 wi;
    Spectrum coefficient;  ///< of the component: f |cos| without the delta function
};

class Component {
  public:
    /// Throws `Error` (bad input) naming `what` for parameters out of range.
    Component(const BxdfComponent &component, const TextureArrays &textures,
              const std::string &what);

    bool is_delta() const { return delta_; }
    bool transmits() const { return transmits_; }
    double eta() const { return eta_; }  ///< index of refraction behind over that in front

    /// f with all its factors [1/sr]; wi on the side `transmits` says. 0 for delta components.
    Spectrum evaluate(const Vec3 &wi, const Viewpoint &view) const;

    /// Density per solid angle of `sample`. 0 for delta components.
    double pdf_w(const Vec3 &wi, const Viewpoint &view) const;

    std::optional<Vec3> sample(const Viewpoint &view, Rng &rng) const;

    /// Of a delta component; nothing at total internal reflection.
    std::optional<DeltaEvent> scatter(const Viewpoint &view) const;

    /// What the choice among components goes by: mean over the channels of weight * texture *
    /// F(wo.z). The Fresnel term of a rough component is evaluated elsewhere and may exceed that at
    /// wo (it is not 0 where the latter is: rough refraction beyond the critical angle), so there a
    /// twentieth ignores it.
    double importance(const Viewpoint &view) const;

  private:
    using Lobe = std::variant<OrenNayarLobe, BlinnLobe, WardLobe, MicrofacetReflectionLobe,
                              MicrofacetRefractionLobe, IdealReflectionLobe, IdealRefractionLobe>;
    static Lobe make_lobe(const BxdfComponent &component);

    /// Cosine at which a rough component's Fresnel term is evaluated.
    double half_cosine(const Vec3 &wi, const Viewpoint &view) const;
    Spectrum fresnel_factor(const Vec3 &wi, const Viewpoint &view) const;
    Spectrum colour(const Viewpoint &view) const {
        return texture_ ? Spectrum(weight_ * texture_->evaluate(view.uv)) : weight_;
    }
    double eta(const Viewpoint &view) const { return view.inverted ? 1.0 / eta_ : eta_; }

    Spectrum weight_;
    std::optional<Texture> texture_;
    Fresnel fresnel_;
    double eta_;
    bool delta_;
    bool transmits_;
    bool rough_;  ///< Fresnel at the half vector
    bool fresnel_of_wo_;
    Lobe lobe_;
};

}  // namespace rtrays::reference
