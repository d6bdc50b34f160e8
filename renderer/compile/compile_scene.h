// SPDX-License-Identifier: MIT
// Compiles a scene into the records and arrays that the device reads.
#pragma once

#include <Eigen/Core>
#include <array>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <tuple>
#include <vector>

#include "renderer/base/named.h"
#include "renderer/scene/scene.h"
#include "renderer/shared/features.h"
#include "renderer/shared/scene_records.h"

namespace rtrays {

/// Selection of a light for next-event estimation (thesis 2.7.3). With `independent`, every light
/// is sampled, one after the other.
enum class LightSelection { uniform, power, mixed, independent };
inline constexpr Named<LightSelection> light_selections[] = {
    {LightSelection::uniform, "uniform"},
    {LightSelection::power, "power"},
    {LightSelection::mixed, "mixed"},
    {LightSelection::independent, "independent"}};

/// Sampling of sphere lights: in the cone that the sphere subtends, or on its surface.
enum class SphereSampling { cone, area };
inline constexpr Named<SphereSampling> sphere_samplings[] = {{SphereSampling::cone, "cone"},
                                                             {SphereSampling::area, "area"}};

/// Settings that decide the compiled scene.
struct CompileSettings {
    LightSelection light_selection = LightSelection::mixed;
    SphereSampling sphere_sampling = SphereSampling::cone;
    /// Corner normals and texture coordinates are compiled even if the scene has none.
    bool every_array = false;
    /// A scene without lights is lit by a point light at the camera.
    bool headlight = false;
};

inline bool operator==(const CompileSettings &a, const CompileSettings &b) {
    return a.light_selection == b.light_selection && a.sphere_sampling == b.sphere_sampling &&
           a.every_array == b.every_array && a.headlight == b.headlight;
}

/// A set of parts of a compiled scene. Each part can be compiled again by itself.
struct SceneParts {
    bool materials = false;  ///< `materials`, `components`
    bool textures = false;   ///< `textures`, `texels`
    /// `surface_triangles`, `triangle_normals`, `triangle_uvs`, `triangle_colours`
    bool triangles = false;
    bool shapes = false;       ///< `shapes`, `shape_bounds`
    bool lights = false;       ///< `lights`, `emitter_triangles`, `lighting`
    bool environment = false;  ///< `environment_texels`, `environment_ends`
    /// `triangle_masks`, `masked_triangles`, `opacities`, `opacity_texels`
    bool opacity = false;

    static SceneParts all() { return {true, true, true, true, true, true, true}; }
};

/// Sphere around all bounded surfaces of a scene.
struct SceneExtent {
    Eigen::Vector3d centre = Eigen::Vector3d::Zero();
    double radius = 0;
    bool bounded = true;   ///< false: the scene has only planes; the sphere is around the camera
    bool encloses = true;  ///< false: the scene has planes, which the sphere does not enclose
};

/// Index of refraction, roughness and distribution.
using CoatKey = std::tuple<double, double, BxdfComponent::Distribution>;

/// Integrals of a coat. Each is computed when a component first needs it.
struct CoatIntegrals {
    std::optional<double> inner_reflectance;
    std::vector<float> transmittances;
};

/// A scene in the form that the device reads. Arrays have the names of shared/scene_buffers.h.
struct CompiledScene {
    CameraRecord camera{};  ///< for the film size of the scene
    std::vector<SurfaceTriangle> surface_triangles;
    std::vector<TriangleNormals> triangle_normals;
    std::vector<TriangleUv> triangle_uvs;
    std::vector<TriangleColours> triangle_colours;
    std::vector<ShapeRecord> shapes;
    std::vector<ShapeBounds> shape_bounds;
    std::vector<MaterialRecord> materials;
    std::vector<BxdfRecord> components;
    std::vector<NormalMapRecord> normal_maps;
    std::vector<MixRecord> mixes;
    std::vector<float> coat_transmittances;
    std::vector<TextureRecord> textures;
    std::vector<uint32_t> texels;
    std::vector<uint32_t> triangle_masks;
    std::vector<MaskedTriangle> masked_triangles;
    std::vector<OpacityRecord> opacities;
    std::vector<float> opacity_texels;
    std::vector<LightRecord> lights;
    std::vector<EmitterTriangle> emitter_triangles;
    std::vector<float> environment_texels;
    std::vector<uint32_t> environment_ends;
    LightingRecord lighting{};
    FeatureMask features;  ///< features of the scene, without those of the integrator

    // Inputs of later compilations of single parts.
    FeatureMask material_features, triangle_features, light_features, opacity_features;
    SceneExtent extent;
    TextureArrays texture_sources;
    std::vector<MaterialOpacity> opacity_sources;
    std::vector<uint32_t> emission_sources;
    /// By the parameters of the coat. Each takes milliseconds, so that edits keep them.
    std::map<CoatKey, CoatIntegrals> coat_integrals;
    bool has_headlight = false;
    std::shared_ptr<const TextureImage> environment_image;  ///< source of the environment's arrays
    double environment_integral = 0;                        ///< `compile_environment` of that image
};

/// Compiles the scene at its current time. Throws `Error` (bad input) for a scene that the device
/// cannot represent.
CompiledScene compile_scene(const Scene &scene, const CompileSettings &settings);

/// As `compile_scene`, from arrays. `camera` is the record of the camera.
CompiledScene compile_arrays(const SceneArrays &scene, const CameraRecord &camera,
                             const CompileSettings &settings);

/// Compiles the camera, `parts`, and the parts that depend on what changed, which it adds to
/// `parts`. The result holds former arrays of these parts, for comparison; an array that it does
/// not hold has changed entirely. When this throws, `compiled` must be compiled from scratch.
CompiledScene recompile(const SceneArrays &scene, const CameraRecord &camera,
                        const CompileSettings &settings, SceneParts &parts,
                        CompiledScene &compiled);

/// Returns the record of camera `index` for a film of the given size in pixels.
CameraRecord compile_camera(const CameraArrays &cameras, size_t index, int width, int height);

/// Returns the distance from the lens to the scene, rounded down, if it exceeds 1000 radii of the
/// scene. Returns 0 otherwise, and if planes may be nearer. Rays of such a camera begin at that
/// distance: float resolves a distance of 1000 radii to 6e-5 radii, a few hundredths of a pixel
/// that shows 1/512 of the scene.
float camera_start_distance(const CameraRecord &camera, const SceneExtent &extent);

/// Moves the start of the rays of a camera that is far from the scene, or the film of an
/// orthographic one.
void set_camera_start(const CameraArrays &cameras, size_t index, const SceneExtent &extent,
                      CameraRecord &camera);

// Steps of `recompile`, which empties the arrays of a part before.

/// Compiles materials into `materials`, `components` and `coat_transmittances`. Sets
/// `material_features`.
void compile_materials(const SceneArrays &scene, CompiledScene &compiled);

/// Compiles the images of all textures into `textures` and `texels`.
void compile_textures(const TextureArrays &textures, CompiledScene &compiled);

/// Compiles triangles without their emitters. Reads `material_features`, sets `triangle_features`.
void compile_triangles(const SceneArrays &scene, bool every_array, CompiledScene &compiled);

/// Compiles the opacities of materials, and of the triangles and shapes that have them. Sets
/// `opacity_features`.
void compile_opacity(const SceneArrays &scene, bool every_array, CompiledScene &compiled);

/// Returns whether `index` is the index of a texture that is mirrored beyond its edges.
bool is_mirrored(const TextureArrays &textures, uint32_t index);

/// Returns the texture of an area light, or `no_index`.
uint32_t emission_texture(const SceneArrays &scene, size_t light);

/// The distribution of the power of a textured area light, by the means of its texels.
class EmissionMeans {
  public:
    /// `radiance` multiplies the texels.
    EmissionMeans(const TextureArrays &textures, uint32_t texture, const Rgb &radiance);

    /// Returns the mean of the full image, over texels and channels.
    double of_image() const;

    /// Returns a mean for a triangle with these texture coordinates: that of all texels in a
    /// rectangle that encloses those which lookups on the triangle read. It is positive wherever
    /// the emission is: the mean of a rectangle with a positive texel is at least a thousandth of
    /// the mean of the image.
    double of_triangle(const std::array<Eigen::Vector2f, 3> &uv) const;

  private:
    const TextureArrays &textures_;
    uint32_t texture_;
    size_t width_, height_;
    // Sums over the texels below and to the left of each corner; rows begin at the bottom.
    std::vector<double> sums_;
    std::vector<uint32_t> positive_;  ///< numbers of texels that are not black
};

/// Returns the record of texture `index` without the place of its texels.
TextureRecord texture_record(const TextureArrays &textures, size_t index);

/// Compiles lights, and the emitters of triangles and shapes. Reads `extent` and `camera`, sets
/// `light_features`.
void compile_lights(const SceneArrays &scene, const CompileSettings &settings,
                    CompiledScene &compiled);

/// Sets the fields of `lighting` that depend on the position of the camera. Reads `extent`.
void compile_distances(CompiledScene &compiled);

/// Returns the sphere around a bounded shape.
SceneExtent extent_of_shape(const ShapeRecord &record);

/// Returns the sphere around the bounded surfaces, with a margin for the rounding of points on them
/// and a radius above 0. Reads `shapes` and `camera`.
SceneExtent compile_extent(const SceneArrays &scene, const CompiledScene &compiled);

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
