// SPDX-License-Identifier: MIT
// Compiles a scene into the records and arrays that the device reads.
#pragma once

#include <string>
#include <vector>

#include "renderer/scene/scene.h"
#include "renderer/shared/features.h"
#include "renderer/shared/scene_records.h"

namespace rtrays {

/// Selection of a light for next-event estimation (thesis 2.7.3). With `independent`, every light
/// is sampled, one after the other.
enum class LightSelection { uniform, power, mixed, independent };

/// Settings that decide the compiled scene.
struct CompileSettings {
    int width = 0;   ///< film width in pixels
    int height = 0;  ///< film height in pixels
    LightSelection light_selection = LightSelection::mixed;
    /// Sphere lights are sampled by area instead of in the cone that they subtend.
    bool spheres_by_area = false;
    /// Corner normals and texture coordinates are compiled even if the scene has none.
    bool every_array = false;
    /// A scene without lights is lit by a point light at the camera.
    bool headlight = false;
};

/// A scene in the form that the device reads. Arrays have the names of shared/scene_buffers.h.
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
    FeatureMask features;  ///< features of the scene, without those of the integrator
};

/// Compiles the scene at its current time. Throws `Error` (bad input) for a scene that the device
/// cannot represent.
CompiledScene compile_scene(const Scene &scene, const CompileSettings &settings);

/// Returns the record of camera `index` for a film of the given size in pixels.
CameraRecord compile_camera(const CameraArrays &cameras, size_t index, int width, int height);

// Parts of `compile_scene`, in the order of their calls. Each adds its features to `compiled`.
void compile_materials(const SceneArrays &scene, CompiledScene &compiled);
void compile_triangles(const SceneArrays &scene, bool every_array, CompiledScene &compiled);
void compile_lights(const SceneArrays &scene, const CompileSettings &settings,
                    CompiledScene &compiled);

/// Compiles the texels and selection tables of an environment (kernels/light/environment.h).
/// Returns the integral of its radiance over all directions, averaged over the channels. Each cell
/// counts with the mean of its corners, as in the selection tables.
double compile_environment(const TextureImage &image, CompiledScene &compiled);

/// Selection table of entries with given weights. `end` holds the upper end of each entry's range
/// of random 32-bit words, `probability` the resulting probability of each entry.
struct SelectionTable {
    std::vector<uint32_t> end;
    std::vector<double> probability;
};

/// Returns the table of weights that are at least 0 and not all 0. Probabilities are exact
/// multiples of 2^-32 and add up to 1.
SelectionTable selection_table(const std::vector<double> &weights);

/// Copies three numbers to an array of a record, as floats.
template <typename Vector>
void copy3(const Vector &from, float (&to)[3]) {
    for (int i = 0; i < 3; ++i) {
        to[i] = static_cast<float>(from[i]);
    }
}

}  // namespace rtrays
