// SPDX-License-Identifier: MIT
#include "renderer/compile/compile_scene.h"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <numeric>
#include <utility>

#include "renderer/compile/shapes.h"
#include "renderer/kernels/geometry/surface_point.h"

namespace rtrays {

namespace {

/// Compiles the corner normals of all triangles. A corner without a normal gets the geometric
/// normal if other corners of its triangle have one.
void compile_normals(const MeshArrays &meshes, CompiledScene &compiled) {
    compiled.triangle_normals.resize(meshes.triangle.size());
    for (size_t i = 0; i < meshes.triangle.size() && !meshes.normal.empty(); ++i) {
        TriangleNormals &corners = compiled.triangle_normals[i];
        for (size_t corner = 0; corner < 3; ++corner) {
            const Eigen::Vector3f &normal = meshes.normal[meshes.triangle[i][corner]];
            if (normal.isZero()) {
                std::copy_n(compiled.surface_triangles[i].normal, 3, corners.normal[corner]);
            } else {
                copy3(normal, corners.normal[corner]);
                corners.is_smooth = 1;
            }
        }
    }
}

/// Compiles the corner colours of all triangles, which are white without stored ones.
void compile_colours(const MeshArrays &meshes, CompiledScene &compiled) {
    for (const Triangle &t : meshes.triangle) {
        TriangleColours &corners = compiled.triangle_colours.emplace_back();
        for (size_t corner = 0; corner < 3; ++corner) {
            copy3(meshes.colour.empty() ? Rgb(Rgb::Ones()) : meshes.colour[t[corner]],
                  corners.colour[corner]);
        }
    }
}

/// Returns whether a texture or a tangent uses the texture coordinates of meshes.
bool reads_uv(const CompiledScene &compiled) {
    return compiled.material_features.has(Feature::textures) ||
           compiled.material_features.has(Feature::tangents);
}

/// Marks all triangles as not emitting.
void clear_emitters(CompiledScene &compiled) {
    for (const EmitterTriangle &emitter : compiled.emitter_triangles) {
        compiled.surface_triangles[emitter.triangle].emitter = NO_EMITTER;
    }
}

bool same_triangles(const std::vector<EmitterTriangle> &a, const std::vector<EmitterTriangle> &b) {
    return std::equal(a.begin(), a.end(), b.begin(), b.end(),
                      [](const EmitterTriangle &x, const EmitterTriangle &y) {
                          return x.triangle == y.triangle;
                      });
}

bool are_equal(const TextureArrays &a, const TextureArrays &b) {
    return a.image == b.image && a.filter == b.filter && a.wrap == b.wrap &&
           a.uv_scale == b.uv_scale && a.uv_offset == b.uv_offset &&
           a.vertex_colours == b.vertex_colours;
}

}  // namespace

SelectionTable selection_table(const std::vector<double> &weights) {
    const double total = std::accumulate(weights.begin(), weights.end(), 0.0);
    constexpr double scale = 0x1p32;
    SelectionTable table;
    double sum = 0;
    double previous = 0;
    for (size_t i = 0; i < weights.size(); ++i) {
        sum += weights[i];
        // All ends except the last stay below 2^32. The last end is 2^32, stored as 2^32 - 1.
        const double end = i + 1 == weights.size()
                               ? scale
                               : std::min(std::round(sum / total * scale), scale - 1.0);
        table.probability.push_back((end - previous) / scale);
        table.end.push_back(static_cast<uint32_t>(std::min(end, scale - 1.0)));
        previous = end;
    }
    return table;
}

CameraRecord compile_camera(const CameraArrays &cameras, size_t index, int width, int height) {
    const Eigen::Matrix4d &world = cameras.world_from_camera[index];
    const Eigen::Vector3d right = world.block<3, 1>(0, 0);
    const Eigen::Vector3d up = world.block<3, 1>(0, 1);
    const Eigen::Vector3d forward = -world.block<3, 1>(0, 2);
    using FovAxis = CameraArrays::FovAxis;
    const FovAxis axis = cameras.fov_axis[index];
    const bool along_x = axis == FovAxis::x || (axis == FovAxis::smaller && width <= height) ||
                         (axis == FovAxis::larger && width >= height);
    const bool orthographic = cameras.is_orthographic(index);
    const double extent =
        orthographic ? cameras.view_size[index] : 2.0 * std::tan(0.5 * cameras.fov[index]);
    // Pixels are square; `pixel` is their size on the film, or on the plane at unit distance.
    const double pixel = extent / (along_x ? width : height);

    CameraRecord camera{};
    camera.width = static_cast<uint32_t>(width);
    camera.height = static_cast<uint32_t>(height);
    camera.full_width = camera.width;
    camera.full_height = camera.height;
    camera.pixel_area = static_cast<float>(pixel * pixel);
    copy3(Eigen::Vector3d(world.block<3, 1>(0, 3)), camera.position);
    const Eigen::Vector3d to_plane = orthographic ? Eigen::Vector3d(0, 0, 0) : forward;
    copy3(Eigen::Vector3d(to_plane - 0.5 * pixel * width * right + 0.5 * pixel * height * up),
          camera.corner);
    camera.orthographic = orthographic ? 1u : 0u;
    copy3(Eigen::Vector3d(pixel * right), camera.step_x);
    copy3(Eigen::Vector3d(-pixel * up), camera.step_y);
    copy3(right, camera.axis_x);
    copy3(up, camera.axis_y);
    camera.aperture_radius = static_cast<float>(cameras.aperture_radius[index]);
    // A pinhole's image is in focus everywhere; with distance 1 the lens code gives the same bits
    // as a pinhole.
    camera.focus_distance =
        camera.aperture_radius > 0.0f ? static_cast<float>(cameras.focus_distance[index]) : 1.0f;
    return camera;
}

float camera_start_distance(const CameraRecord &camera, const SceneExtent &extent) {
    if (camera.orthographic != 0u) {
        return 0.0f;  // `set_camera_start` moves the film instead
    }
    // From the nearest point that the lens may have, in whatever direction it looks.
    const double distance =
        (Eigen::Vector3f(camera.position).cast<double>() - extent.centre).norm() - extent.radius -
        static_cast<double>(camera.aperture_radius);
    const bool is_far =
        extent.radius > 0 && extent.bounded && extent.encloses && distance > 1000 * extent.radius;
    // The margin covers the rounding of the position.
    return is_far ? static_cast<float>(distance * (1.0 - 0x1p-22)) : 0.0f;
}

void set_camera_start(const CameraArrays &cameras, size_t index, const SceneExtent &extent,
                      CameraRecord &camera) {
    const Eigen::Matrix4d &world = cameras.world_from_camera[index];
    const Eigen::Vector3d forward = -world.block<3, 1>(0, 2);
    if (camera.orthographic != 0u) {
        // Rays are parallel, so the film may move along them.
        const Eigen::Vector3d position = world.block<3, 1>(0, 3);
        const double distance = (extent.centre - position).dot(forward) - extent.radius;
        if (extent.radius > 0 && extent.bounded && extent.encloses &&
            distance > 1000 * extent.radius) {
            copy3(Eigen::Vector3d(position + distance * (1.0 - 0x1p-22) * forward),
                  camera.position);
        }
        return;
    }
    camera.start_distance = camera_start_distance(camera, extent);
    if (camera.start_distance == 0.0f) {
        return;
    }
    copy3(Eigen::Vector3d(world.block<3, 1>(0, 3) +
                          static_cast<double>(camera.start_distance) * forward),
          camera.start);
    const double pixel = std::sqrt(static_cast<double>(camera.pixel_area));
    copy3(Eigen::Vector3d(-0.5 * pixel * camera.full_width * world.block<3, 1>(0, 0) +
                          0.5 * pixel * camera.full_height * world.block<3, 1>(0, 1)),
          camera.start_corner);
}

void compile_triangles(const SceneArrays &scene, bool every_array, CompiledScene &compiled) {
    const MeshArrays &meshes = scene.meshes;
    compiled.surface_triangles.reserve(meshes.triangle.size());
    for (size_t i = 0; i < meshes.triangle.size(); ++i) {
        const Triangle &t = meshes.triangle[i];
        SurfaceTriangle surface{};
        copy3(meshes.position[t[0]], surface.p0);
        copy3(meshes.position[t[1]], surface.p1);
        copy3(meshes.position[t[2]], surface.p2);
        const float3 p0 = make_float3(surface.p0[0], surface.p0[1], surface.p0[2]);
        const float3 p1 = make_float3(surface.p1[0], surface.p1[1], surface.p1[2]);
        const float3 p2 = make_float3(surface.p2[0], surface.p2[1], surface.p2[2]);
        const float3 normal = triangle_normal(p0, p1, p2);
        copy3(Eigen::Vector3f(normal.x, normal.y, normal.z), surface.normal);
        surface.extent = triangle_extent(p0, p1, p2);
        surface.material = meshes.material[meshes.triangle_mesh[i]];
        surface.emitter = NO_EMITTER;
        compiled.surface_triangles.push_back(surface);
    }
    const auto any = [](const std::vector<uint8_t> &flags) {
        return std::find(flags.begin(), flags.end(), 1) != flags.end();
    };
    compiled.triangle_features =
        FeatureMask()
            .with(Feature::triangles, !meshes.triangle.empty())
            .with(Feature::smooth_normals,
                  any(meshes.has_normals) || compiled.material_features.has(Feature::normal_maps))
            .with(Feature::texture_coordinates, reads_uv(compiled) && any(meshes.has_uv));
    if (every_array || compiled.triangle_features.has(Feature::smooth_normals)) {
        compile_normals(meshes, compiled);
    }
    if (every_array || compiled.material_features.has(Feature::vertex_colours)) {
        compile_colours(meshes, compiled);
    }
    if (every_array || compiled.triangle_features.has(Feature::texture_coordinates)) {
        for (const Triangle &t : meshes.triangle) {
            TriangleUv &uvs = compiled.triangle_uvs.emplace_back();
            for (size_t corner = 0; corner < 3; ++corner) {
                if (!meshes.uv.empty()) {
                    std::copy_n(meshes.uv[t[corner]].data(), 2, uvs.uv[corner]);
                }
            }
        }
    }
}

CompiledScene recompile(const SceneArrays &scene, const CameraRecord &camera,
                        const CompileSettings &settings, SceneParts &parts,
                        CompiledScene &compiled) {
    const bool camera_moved = !std::equal(camera.position, camera.position + 3,
                                          compiled.camera.position, compiled.camera.position + 3);
    CompiledScene former;
    compiled.camera = camera;
    if (parts.materials) {
        const bool had_textures = compiled.material_features.has(Feature::textures);
        const bool read_uv = reads_uv(compiled);
        const bool had_maps = compiled.material_features.has(Feature::normal_maps);
        const bool had_colours = compiled.material_features.has(Feature::vertex_colours);
        former.materials = std::exchange(compiled.materials, {});
        former.components = std::exchange(compiled.components, {});
        former.normal_maps = std::exchange(compiled.normal_maps, {});
        former.mixes = std::exchange(compiled.mixes, {});
        former.coat_transmittances = std::exchange(compiled.coat_transmittances, {});
        compile_materials(scene, compiled);
        const bool has_textures = compiled.material_features.has(Feature::textures);
        parts.textures |=
            has_textures != had_textures || !are_equal(compiled.texture_sources, scene.textures);
        parts.triangles |= reads_uv(compiled) != read_uv ||
                           compiled.material_features.has(Feature::normal_maps) != had_maps ||
                           compiled.material_features.has(Feature::vertex_colours) != had_colours;
        parts.opacity |=
            compiled.opacity_sources != scene.materials.opacity ||
            (!compiled.opacities.empty() && !are_equal(compiled.texture_sources, scene.textures));
        // The selection of lights and triangles depends on texels.
        parts.lights |= compiled.emission_sources != scene.materials.emission_texture ||
                        (compiled.material_features.has(Feature::emission_textures) &&
                         !are_equal(compiled.texture_sources, scene.textures));
        compiled.texture_sources = scene.textures;
        compiled.opacity_sources = scene.materials.opacity;
        compiled.emission_sources = scene.materials.emission_texture;
    }
    parts.shapes |= parts.opacity && !scene.shapes.kind.empty();  // they hold their opacity
    if (parts.textures) {
        former.textures = std::exchange(compiled.textures, {});
        former.texels = std::exchange(compiled.texels, {});
        if (compiled.material_features.has(Feature::textures)) {
            compile_textures(scene.textures, compiled);
        }
    }
    const bool moved = parts.triangles || parts.shapes;
    const bool follows_camera = compiled.has_headlight || !compiled.extent.bounded;
    parts.lights |= moved || (camera_moved && follows_camera);
    parts.shapes |= parts.lights;  // records of shapes hold the index of their light
    if (parts.triangles) {
        former.surface_triangles = std::exchange(compiled.surface_triangles, {});
        former.triangle_normals = std::exchange(compiled.triangle_normals, {});
        former.triangle_uvs = std::exchange(compiled.triangle_uvs, {});
        former.triangle_colours = std::exchange(compiled.triangle_colours, {});
        compile_triangles(scene, settings.every_array, compiled);
    } else if (parts.lights) {
        clear_emitters(compiled);
    }
    if (parts.shapes) {
        former.shapes = std::exchange(compiled.shapes, compile_shapes(scene.shapes));
        former.shape_bounds = std::exchange(compiled.shape_bounds, bound_shapes(compiled.shapes));
    }
    parts.opacity |= parts.triangles || parts.shapes;
    if (parts.opacity) {
        former.triangle_masks = std::exchange(compiled.triangle_masks, {});
        former.masked_triangles = std::exchange(compiled.masked_triangles, {});
        former.opacities = std::exchange(compiled.opacities, {});
        former.opacity_texels = std::exchange(compiled.opacity_texels, {});
        compile_opacity(scene, settings.every_array, compiled);
    }
    if (parts.lights) {
        former.lights = std::exchange(compiled.lights, {});
        former.emitter_triangles = std::exchange(compiled.emitter_triangles, {});
        const auto environment = compiled.environment_image;
        if (moved || !compiled.extent.bounded) {
            compiled.extent = compile_extent(scene, compiled);
        }
        compile_lights(scene, settings, compiled);
        parts.environment |= compiled.environment_image != environment;
        parts.triangles |= !same_triangles(former.emitter_triangles, compiled.emitter_triangles);
    } else {
        compile_distances(compiled);
    }
    const bool lens =
        camera.aperture_radius > 0.0f || compiled.lighting.camera_start_distance > 0.0f;
    compiled.features = FeatureMask()
                            .with(Feature::lens, lens)
                            .with(Feature::orthographic, camera.orthographic != 0u) |
                        compiled.material_features | compiled.triangle_features |
                        shape_features(scene.shapes) | compiled.light_features |
                        compiled.opacity_features;
    return former;
}

CompiledScene compile_arrays(const SceneArrays &scene, const CameraRecord &camera,
                             const CompileSettings &settings) {
    CompiledScene compiled;
    SceneParts parts = SceneParts::all();
    recompile(scene, camera, settings, parts, compiled);
    return compiled;
}

CompiledScene compile_scene(const Scene &scene, const CompileSettings &settings) {
    return compile_arrays(
        scene.arrays(),
        compile_camera(scene.cameras(), static_cast<size_t>(scene.active_camera()),
                       scene.film_width(), scene.film_height()),
        settings);
}

}  // namespace rtrays
