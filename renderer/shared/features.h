// SPDX-License-Identifier: MIT
// Structural facts of a scene and its settings. They decide which code is compiled, which fields of the path
// state exist, which buffers are allocated and which stages are launched; numbers are arguments, never baked in.
//
// Declared once: the host derives the mask, the names and the generated defines FEATURE_<name> (0 or 1) from
// this table.
#pragma once

// X(name, what it says)
#define RTRAYS_FEATURES(X)                                                                       \
    X(implicit_light, "paths that hit an emitter count (strategies implicit, mis)")              \
    X(explicit_light, "paths are joined to light samples (strategies explicit, mis)")            \
    X(lights, "the scene has emitters")                                                          \
    X(many_lights, "more than one light: a selection table is searched")                         \
    X(light_triangles, "a mesh light has more than one triangle: its area table is searched")    \
    X(scattering, "a material reflects: paths go beyond the first hit")                          \
    X(lambert, "diffuse reflection")                                                             \
    X(roulette, "Russian roulette ends paths")                                                   \
    X(adaptive, "paths end below a throughput threshold (biased)")                               \
    X(depth_limit, "max_depth is finite")                                                        \
    X(variance, "the film holds second moments")                                                 \
    X(int64_atomics, "the device adds 64-bit integers atomically")

#ifndef __OPENCL_VERSION__

#include <cstdint>
#include <map>
#include <string>
#include <vector>

namespace rtrays {

enum class Feature : uint32_t {
#define RTRAYS_FEATURE(name, text) name,
    RTRAYS_FEATURES(RTRAYS_FEATURE)
#undef RTRAYS_FEATURE
        count
};

/// A set of features.
class FeatureMask {
  public:
    constexpr FeatureMask() = default;

    static constexpr FeatureMask all() { return FeatureMask((1u << static_cast<uint32_t>(Feature::count)) - 1u); }

    constexpr bool has(Feature feature) const { return (bits_ >> static_cast<uint32_t>(feature) & 1u) != 0; }
    constexpr FeatureMask with(Feature feature, bool on = true) const {
        const uint32_t bit = 1u << static_cast<uint32_t>(feature);
        return FeatureMask(on ? bits_ | bit : bits_ & ~bit);
    }
    constexpr uint32_t bits() const { return bits_; }

    /// Without the features whose requirement is missing (explicit_light needs lights and scattering, ...).
    FeatureMask closed() const;

    /// Names of the features in the set, in table order.
    std::vector<std::string> names() const;

    /// "FEATURE_<name>" -> "0" or "1" for every feature.
    std::map<std::string, std::string> defines() const;

  private:
    constexpr explicit FeatureMask(uint32_t bits) : bits_(bits) {}

    uint32_t bits_ = 0;
};

}  // namespace rtrays

#endif
