// SPDX-License-Identifier: MIT
#pragma once

#include <string>
#include <vector>

#include "renderer/scene/scene.h"
#include "renderer/shared/features.h"
#include "renderer/shared/scene_records.h"

namespace rtrays {

/// How a light is chosen for an explicit path (thesis 2.7.3).
enum class LightSelection { uniform, power, mixed };

/// A scene as the device reads it, and the structural facts about it.
struct CompiledScene {
    CameraRecord camera{};
    std::vector<SurfaceTriangle> surface_triangles;
    std::vector<MaterialRecord> materials;
    std::vector<BxdfRecord> components;
    std::vector<LightRecord> lights;
    std::vector<EmitterTriangle> emitter_triangles;
    FeatureMask features;                   ///< of the scene; the integrator adds its own
};

/// Translates the scene's arrays at its current time. `width` and `height` are the film's, in pixels.
CompiledScene compile_scene(const Scene &scene, int width, int height, LightSelection selection);

/// The camera's record for a film of that size.
CameraRecord compile_camera(const CameraArrays &cameras, size_t index, int width, int height);

/// Ends of a table searched by 32-bit words, and the probability each entry then has, for weights >= 0 that are not
/// all zero. Probabilities are exact multiples of 2^-32 and add up to 1.
struct SelectionTable {
    std::vector<uint32_t> end;
    std::vector<double> probability;
};
SelectionTable selection_table(const std::vector<double> &weights);

}  // namespace rtrays
