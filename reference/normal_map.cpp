// SPDX-License-Identifier: MIT
#include "reference/normal_map.h"

#include <algorithm>
#include <cmath>

namespace rtrays::reference {

namespace {

/// Returns `tilted` with its part perpendicular to `untilted` reversed.
Vec3 reversed(const Vec3 &tilted, const Vec3 &untilted) {
    return 2.0 * tilted.dot(untilted) * untilted - tilted;
}

double squared_tangent(double cosine) {
    return 1.0 / square(cosine) - 1.0;
}

}  // namespace

NormalTilt::NormalTilt(const NormalMap &map, const TextureArrays &textures) : map_(map) {
    if (map.kind != NormalMap::Kind::none) {
        texture_.emplace(textures, map.texture);
    }
}

Vec3 NormalTilt::normal_of_texel(const Parametrization &surface) const {
    const Vec3 value = 2.0 * texture_->evaluate(surface.uv).matrix() - Vec3::Ones();
    Vec3 local(map_.scale * value.x(), map_.scale * value.y(), value.z());
    const Vec3 &n = surface.shading_normal;
    const Frame frame(n, surface.tangent);
    if (map_.follows_v && surface.derivatives &&
        surface.tangent.cross(surface.along_v).dot(n) < 0) {
        local.y() = -local.y();
    }
    return frame.to_world(local);
}

Vec3 NormalTilt::normal_of_heights(const Parametrization &surface, const Vec3 &ng) const {
    const Vec3 &n = surface.shading_normal;
    if (!surface.derivatives) {
        return n;
    }
    // p(u, v) + h(u, v) n has these derivatives, in the plane of n and along n.
    const Eigen::Vector2d slope = map_.scale * texture_->luminance_gradient(surface.uv);
    const auto displaced = [&](const Vec3 &along, double rise) -> Vec3 {
        return along + (rise - along.dot(n)) * n;
    };
    const Vec3 product =
        displaced(surface.tangent, slope.x()).cross(displaced(surface.along_v, slope.y()));
    return product.dot(ng) < 0.0 ? Vec3(-product) : product;
}

Vec3 NormalTilt::normal(const Parametrization &surface, const Vec3 &ng) const {
    const Vec3 tilted = map_.kind == NormalMap::Kind::heights ? normal_of_heights(surface, ng)
                                                              : normal_of_texel(surface);
    const double length = tilted.stableNorm();
    return length > 0.0 && std::isfinite(length) ? Vec3(tilted / length) : surface.shading_normal;
}

Vec3 NormalTilt::normal_for(const Parametrization &surface, const Vec3 &ng, const Vec3 &wo) const {
    const Vec3 tilted = normal(surface, ng), other = reversed(tilted, surface.shading_normal);
    const double side = ng.dot(wo) >= 0.0 ? 1.0 : -1.0;
    const bool starts_reversed = side < 0.0 && map_.mirrored_back;
    const Vec3 &first = starts_reversed ? other : tilted;
    const Vec3 &second = starts_reversed ? tilted : other;
    if (side * first.dot(wo) > 0.0) {
        return first;
    }
    return side * second.dot(wo) > 0.0 ? second : ng;
}

double NormalTilt::shadowing(const Vec3 &tilted, const Vec3 &untilted, const Vec3 &wi) const {
    if (!map_.shadowing) {
        return 1.0;
    }
    const double alpha2 = std::min(0.125 * squared_tangent(tilted.dot(untilted)), 1.0);
    return 2.0 / (1.0 + std::sqrt(1.0 + std::max(alpha2, 0.0) *
                                            std::max(squared_tangent(untilted.dot(wi)), 0.0)));
}

std::vector<NormalTilt> make_normal_tilts(const MaterialArrays &materials,
                                          const TextureArrays &textures) {
    std::vector<NormalTilt> tilts;
    for (const NormalMap &map : materials.normal_map) {
        tilts.emplace_back(map, textures);
    }
    const bool none = std::all_of(tilts.begin(), tilts.end(),
                                  [](const NormalTilt &tilt) { return tilt.is_none(); });
    return none ? std::vector<NormalTilt>() : tilts;
}

}  // namespace rtrays::reference
