// SPDX-License-Identifier: MIT
// Textures of materials, and the sRGB curve.
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

/// A colour over the (u, v) plane, shared by any number of materials. The image never changes, but
/// its placement on the plane and its filter can be edited.
class Texture : public PropertyHolder {
  public:
    /// Parameters: filter, wrap, uv_scale, uv_offset, vertex_colours. Throws `Error` (bad input)
    /// like `ParameterSet`.
    Texture(std::string name, std::shared_ptr<const TextureImage> image,
            const ParameterValues &values = {});

    static const ParameterTable &parameter_table();

    const char *type_name() const override { return "texture"; }
    std::vector<Property> properties() override;

    const std::shared_ptr<const TextureImage> &image() const { return image_; }
    /// Largest value of each channel, decoded.
    const Rgb &largest_texel() const { return largest_texel_; }
    /// Returns whether the colours of vertices, which are at most 1, multiply the image.
    bool has_vertex_colours() const { return parameters_.get<bool>("vertex_colours"); }
    const ParameterSet &parameters() const { return parameters_; }
    void set(const std::string &name, const PropertyValue &value);

    /// Counter that grows with every change.
    uint64_t version() const { return version_; }

  private:
    friend class MaterialCore;

    std::shared_ptr<const TextureImage> image_;
    Rgb largest_texel_;
    ParameterSet parameters_;
    std::vector<MaterialCore *> users_;
    uint64_t version_ = 1;
};

/// Returns the names, in the order of `TextureArrays::Wrap`.
const std::vector<std::string> &wrap_names();

/// Returns the image of one white texel, that of textures which consist of vertex colours alone.
const std::shared_ptr<const TextureImage> &white_image();

/// Decodes a value in [0, 1] by the sRGB curve (IEC 61966-2-1) to a linear value.
double srgb_decoded(double value);

/// Returns channel `i` of an image, counted over all texels, as a linear value.
double decoded_channel(const TextureImage &image, size_t i);

/// Returns the Rec. 709 luminance of a linear colour. For a grey, this is exactly its value.
double luminance(const Eigen::Vector3d &rgb);

/// Returns an upper bound of the luminance of a texture's colours: that of the largest channels.
double brightest_luminance(const Texture &texture);

/// Encodes a linear value in [0, 1] by the inverse of the sRGB curve.
double srgb_encoded(double value);

}  // namespace rtrays
