// SPDX-License-Identifier: MIT
#include "reference/opacity.h"

#include <algorithm>

#include "reference/rng.h"

namespace rtrays::reference {

Opacity::Opacity(const MaterialOpacity &opacity, const TextureArrays &textures)
    : opaque_(opacity.is_opaque()), value_(opacity.value), cutoff_(opacity.cutoff) {
    if (opacity.texture != no_index) {
        texture_.emplace(textures, opacity.texture);
    }
}

double Opacity::at(const Eigen::Vector2d &uv) const {
    double opacity = value_;
    if (texture_) {
        opacity *= luminance(texture_->evaluate(uv));
    }
    return cutoff_ > 0.0 ? (opacity >= cutoff_ ? 1.0 : 0.0) : opacity;
}

std::vector<Opacity> make_opacities(const MaterialArrays &materials,
                                    const TextureArrays &textures) {
    std::vector<Opacity> opacities;
    for (const MaterialOpacity &opacity : materials.opacity) {
        opacities.emplace_back(opacity, textures);
    }
    const bool all_opaque = std::all_of(opacities.begin(), opacities.end(),
                                        [](const Opacity &o) { return o.is_opaque(); });
    return all_opaque ? std::vector<Opacity>() : opacities;
}

bool is_stopped(double opacity, uint64_t key, uint32_t primitive, uint32_t hit) {
    return Rng(key, primitive, hit).uniform() < opacity;
}

}  // namespace rtrays::reference
