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
            mean[i] =
                static_cast<float>(pixels[i].mean(count())[static_cast<Eigen::Index>(channel)]);
            variance[i] = static_cast<float>(
                pixels[i].variance_of_mean(count())[static_cast<Eigen::Index>(channel)]);
        }
    }
    return image;
}

Film Film::of(const Image &developed, uint64_t first_sample, uint64_t end_sample) {
    Film film(developed.width(), developed.height(), first_sample);
    film.end = end_sample;
    const auto names = rgb_names(), variance_names = rgb_names("variance");
    for (size_t i = 0; i < film.pixels.size(); ++i) {
        Spectrum mean, variance;
        for (size_t channel = 0; channel < 3; ++channel) {
            mean[static_cast<Eigen::Index>(channel)] =
                static_cast<double>(developed.channel(names[channel])[i]);
            variance[static_cast<Eigen::Index>(channel)] =
                static_cast<double>(developed.channel(variance_names[channel])[i]);
        }
        film.pixels[i] = PixelMoments::of(mean, variance, film.count());
    }
    return film;
}

}  // namespace rtrays::reference
