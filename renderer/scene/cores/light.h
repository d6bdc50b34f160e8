// SPDX-License-Identifier: MIT
// Light cores: area lights, delta lights and lights at infinity.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "renderer/scene/cores/parameter_core.h"
#include "renderer/scene/stores.h"

namespace rtrays {

struct LightType : CoreType {
    LightArrays::Kind kind;
    std::string radiance;  ///< name of the parameter that becomes `LightArrays::radiance`
};

/// Returns all types, in the order of `LightArrays::Kind`.
const std::vector<LightType> &light_types();

/// The light of a node: an area light on the geometry of the same node, or a light placed by the
/// node's transform. stores.h defines the meaning of the parameters.
class LightCore : public ParameterCore {
  public:
    /// Throws `Error` (bad input) like `ParameterCore`, and for an unknown type, listing the types.
    LightCore(std::string name, const std::string &type, const ParameterValues &values);

    /// Makes an environment light. Throws `Error` (bad input) unless `image` holds floats.
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
