// SPDX-License-Identifier: MIT
#pragma once

#include <string>
#include <vector>

#include "renderer/scene/scene.h"
#include "renderer/shared/features.h"
#include "renderer/shared/scene_records.h"

namespace rtrays {

/// How a light is chosen for an explicit path (thesis 2.7.3). `independent`: all of them, one after
/// the other.
enum class LightSelection { uniform, power, mixed, independent };

/// What of the settings decides records.
struct CompileSettings {
    int width = 0;  ///< of the film, pixels
    int height = 0;
    LightSelection light_selection = LightSelection::mixed;
    bool spheres_by_area =
        false;  ///< sphere lights are sampled by area instead of by the cone they subtend
    bool every_array = false;  ///< corner normals and coordinates even if the scene has none
    bool headlight = false;    ///< a scene without lights is lit from the camera
};

/// A scene as the device reads it, and the structural facts about it. Arrays are named as in
/// shared/scene_buffers.h.
struct CompiledScene {
    CameraRecord camera{};
    std::vector<SurfaceTriangle> surface_triangles;
    std::vector<TriangleNormals> triangle_normals;
    std::vector<TriangleUv> triangle_uvs;
    std::vector<ShapeRecord> shapes;
    std::vector<ShapeBounds> shape_bounds;
    std::vector<MaterialRecord> materials;
    std::vector<BxdfRecord> components;
    std::vector<TextureRecord> textures;
    std::vector<uint32_t> texels;
    std::vector<LightRecord> lights;
    std::vector<EmitterTriangle> emitter_triangles;
    std::vector<float> environment_texels;
    std::vector<uint32_t> environment_ends;
    LightingRecord lighting{};
    FeatureMask features;  ///< of the scene; the integrator adds its own
};

/// Translates the scene's arrays at its current time. Throws `Error` (bad input) for a scene that
/// the device cannot hold.
CompiledScene compile_scene(const Scene &scene, const CompileSettings &settings);

/// The camera's record for a film of that size.
CameraRecord compile_camera(const CameraArrays &cameras, size_t index, int width, int height);

// The parts of `compile_scene`, in the order in which they are called; each adds its features.
void compile_materials(const SceneArrays &scene, CompiledScene &compiled);
void compile_triangles(const SceneArrays &scene, bool every_array, CompiledScene &compiled);
void compile_lights(const SceneArrays &scene, const CompileSettings &settings,
                    CompiledScene &compiled);

/// Texels and tables of an environment (kernels/light/environment.h), and the integral of its
/// radiance over all directions, mean of the channels, each cell taken for the mean of its corners:
/// what selection goes by.
double compile_environment(const TextureImage &image, CompiledScene &compiled);

/// Ends of a table searched by 32-bit words, and the probability each entry then has, for weights
/// >= 0 that are not all zero. Probabilities are exact multiples of 2^-32 and add up to 1.
struct SelectionTable {
    std::vector<uint32_t> end;
    std::vector<double> probability;
};
SelectionTable selection_table(const std::vector<double> &weights);

/// Copies three numbers into a record.
template <typename Vector>
void copy3(const Vector &from, float (&to)[3]) {
    for (int i = 0; i < 3; ++i) {
        to[i] = static_cast<float>(from[i]);
    }
}

}  // namespace rtrays
