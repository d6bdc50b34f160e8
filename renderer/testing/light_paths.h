// SPDX-License-Identifier: MIT
// Device code of lights with all features, and helpers that start light paths, for tests.
#pragma once

// Must precede all device code.
#include "testing/all_features.h"

#include <cmath>

#include "renderer/base/angles.h"
#include "renderer/kernels/geometry/intersect_shapes.h"
#include "renderer/kernels/light/emission.h"
#include "renderer/kernels/sampling/random.h"
#include "renderer/testing/light_scene.h"
#include "renderer/testing/scene_view.h"
#include "renderer/testing/shapes_double.h"

namespace rtrays {

using test::to_double;
using test::to_float3;

inline uint4 words(uint32_t i, uint32_t block) {
    return random_words(13, STREAM_CAMERA, i, 0, block);
}

inline double green(float3 v) {
    return static_cast<double>(v.y);
}

inline EmissionSample emit(const CompiledScene &scene, uint32_t i) {
    const SceneView view = view_of(scene);
    return sample_emission(&view, words(i, 0), words(i, 1));
}

/// Samples emission from a given light: replaces the random word that selects the light with a word
/// from the light's range.
inline EmissionSample emit_from(const CompiledScene &scene, uint32_t light, uint32_t i) {
    uint4 a = words(i, 0);
    a.x = scene.lights[light].selection_end - 1u;
    const SceneView view = view_of(scene);
    return sample_emission(&view, a, words(i, 1));
}

inline uint32_t light_of(const CompiledScene &scene, uint32_t kind) {
    for (uint32_t i = 0; i < scene.lights.size(); ++i) {
        if (scene.lights[i].kind == kind) {
            return i;
        }
    }
    throw std::logic_error("no such light");
}

/// Mean of the added values, and its standard error.
struct Estimate {
    double sum = 0, squares = 0;
    uint32_t count = 0;
    void add(double value) {
        sum += value;
        squares += value * value;
        ++count;
    }
    double mean() const { return sum / count; }
    double error() const {
        return std::sqrt(std::max(squares / count - mean() * mean(), 0.0) / count);
    }
};

}  // namespace rtrays
