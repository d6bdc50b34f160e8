// SPDX-License-Identifier: MIT
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "renderer/scene/cores/parameter_core.h"
#include "renderer/scene/stores.h"

namespace rtrays {

struct LightType : CoreType {
    LightArrays::Kind kind;
    std::string radiance;  ///< the parameter that becomes `LightArrays::radiance`
};

/// All types, in the order of `LightArrays::Kind`.
const std::vector<LightType> &light_types();

/// A light at its node: an area light on the geometry of the same node, or one placed by its
/// transform. What the parameters mean is said in stores.h.
class LightCore : public ParameterCore {
  public:
    /// Throws `Error` (bad input) as `ParameterCore`, and listing the types when `type` is none of
    /// them.
    LightCore(std::string name, const std::string &type, const ParameterValues &values);

    /// An environment light; `image` holds floats.
    LightCore(std::string name, std::shared_ptr<const TextureImage> image,
              const ParameterValues &values);

    CoreRole role() const override { return CoreRole::light; }

    LightArrays::Kind kind() const;
    const Eigen::Vector3d &radiance() const;
    const std::shared_ptr<const TextureImage> &image() const { return image_; }

  private:
    std::shared_ptr<const TextureImage> image_;
};

}  // namespace rtrays
