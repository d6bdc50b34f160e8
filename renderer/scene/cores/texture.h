// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "renderer/scene/parameters.h"
#include "renderer/scene/property_holder.h"
#include "renderer/scene/stores.h"

namespace rtrays {

class MaterialCore;

/// A colour over the (u, v) plane, shared by any number of materials. The image never changes; how
/// it is laid over the plane and filtered does.
class Texture : public PropertyHolder {
  public:
    /// Parameters: filter, wrap, uv_scale, uv_offset. Throws `Error` (bad input) as `ParameterSet`.
    Texture(std::string name, std::shared_ptr<const TextureImage> image,
            const ParameterValues &values = {});

    static const ParameterTable &parameter_table();

    const char *type_name() const override { return "texture"; }
    std::vector<Property> properties() override;

    const std::shared_ptr<const TextureImage> &image() const { return image_; }
    const Rgb &largest_texel() const { return largest_texel_; }  ///< of each channel, decoded
    const ParameterSet &parameters() const { return parameters_; }
    void set(const std::string &name, const PropertyValue &value);

    /// Grows with every change.
    uint64_t version() const { return version_; }

  private:
    friend class MaterialCore;

    std::shared_ptr<const TextureImage> image_;
    Rgb largest_texel_;
    ParameterSet parameters_;
    std::vector<MaterialCore *> users_;
    uint64_t version_ = 1;
};

/// The sRGB curve (IEC 61966-2-1) from an encoded value in [0, 1] to a linear one.
double srgb_decoded(double value);

}  // namespace rtrays
