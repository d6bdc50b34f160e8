// SPDX-License-Identifier: MIT
#include "reference/film.h"

namespace rtrays::reference {

Image Film::develop() const {
    Image image = Image::rgb(width, height);
    for (const auto &name : rgb_names("variance")) {
        image.add_channel(name);
    }
    image.add_channel("samples").assign(pixels.size(), static_cast<float>(count()));
    if (count() == 0) {
        return image;
    }
    const auto names = rgb_names();
    const auto variance_names = rgb_names("variance");
    for (size_t channel = 0; channel < 3; ++channel) {
        auto &mean = image.channel(names[channel]);
        auto &variance = image.channel(variance_names[channel]);
        for (size_t i = 0; i < pixels.size(); ++i) {
            mean[i] = static_cast<float>(pixels[i].mean(count())[static_cast<Eigen::Index>(channel)]);
            variance[i] =
                static_cast<float>(pixels[i].variance_of_mean(count())[static_cast<Eigen::Index>(channel)]);
        }
    }
    return image;
}

}  // namespace rtrays::reference
