// SPDX-License-Identifier: MIT
// A compiled scene with a light of every type, for tests of light paths.
#pragma once

#include <Eigen/Dense>
#include <array>
#include <memory>
#include <numeric>
#include <random>

#include "renderer/base/angles.h"
#include "renderer/compile/compile_scene.h"
#include "renderer/compile/shapes.h"
#include "renderer/import/json/scene_json.h"
#include "renderer/kernels/geometry/surface_point.h"

namespace rtrays {

constexpr double spot_inner = 20 * degree, spot_outer = 35 * degree;

/// Returns the areas of the two triangles of the mesh light.
inline std::array<double, 2> mesh_areas() {
    return {1.0, 1.5};
}

inline const char *light_scene_text() {
    return R"({
    "version": 1,
    "film": {"width": 16, "height": 16},
    "materials": {"black": {"type": "lambert", "reflectance": [0, 0, 0]}, "grey": {"type": "lambert", "reflectance": [0.5, 0.5, 0.5]}},
    "nodes": [
        {
            "name": "camera",
            "transform": [{"look_at": {"origin": [0, 2, 6], "target": [0, 1, 0], "up": [0, 1, 0]}}],
            "camera": {"type": "pinhole", "fov": 45, "fov_axis": "smaller"}
        },
        {
            "name": "floor",
            "geometry": {"type": "rectangle"},
            "material": "grey",
            "transform": [{"scale": [2, 2, 1]}, {"rotate": {"axis": [1, 0, 0], "degrees": -90}}]
        },
        {
            "name": "mesh",
            "geometry": {
                "type": "mesh",
                "vertices": [[-2, 2, 0], [-1, 2, 0], [-2, 2, 2], [-2, 3.5, 0.5]],
                "polygons": [[0, 1, 2], [0, 3, 2]]
            },
            "material": "black",
            "light": {"type": "diffuse_area", "radiance": [3, 2, 1]}
        },
        {
            "name": "disc",
            "geometry": {"type": "disc", "radius": 0.5},
            "material": "black",
            "transform": [{"scale": [1.5, 0.7, 1]}, {"rotate": {"axis": [1, 0.2, 0], "degrees": 130}}, {"translate": [0.3, 1.8, -1.6]}],
            "light": {"type": "diffuse_area", "radiance": [3, 4, 1]}
        },
        {
            "name": "sphere",
            "geometry": {"type": "sphere", "radius": 0.4},
            "material": "black",
            "transform": [{"rotate": {"axis": [1, 2, 0], "degrees": 40}}, {"translate": [1.2, 1.6, -0.8]}],
            "light": {"type": "diffuse_area", "radiance": [3, 3, 1]}
        },
        {"name": "point", "transform": [{"translate": [1.5, 2.5, 1]}], "light": {"type": "point", "intensity": [1, 4, 2]}},
        {
            "name": "spot",
            "transform": [{"look_at": {"origin": [-1, 2.5, -1.5], "target": [0, 0.3, -0.6], "up": [0, 1, 0]}}],
            "light": {"type": "spot", "intensity": [9, 8, 7], "inner_degrees": 20, "outer_degrees": 35}
        },
        {
            "name": "sun",
            "transform": [{"look_at": {"origin": [1, 3, 1], "target": [0, 0, 0], "up": [0, 1, 0]}}],
            "light": {"type": "directional", "irradiance": [1, 0.8, 0.5]}
        },
        {"name": "sky", "light": {"type": "dome", "radiance": [0.5, 0.25, 1]}}
    ]
})";
}

/// Returns an image of 12 x 7 texels, one of which is bright.
inline std::shared_ptr<const TextureImage> small_sky() {
    auto image = std::make_shared<TextureImage>();
    image->width = 12;
    image->height = 7;
    std::mt19937 random(3);
    for (int i = 0; i < image->width * image->height * 3; ++i) {
        image->floats.push_back(i / 3 == 29 ? 6.0f
                                            : static_cast<float>(random() % 1000 + 100) * 1e-3f);
    }
    return image;
}

/// Compiles the scene. Its sky is a dome or a rotated environment.
inline CompiledScene compile_light_scene(LightArrays::Kind infinite = LightArrays::Kind::dome,
                                         LightSelection selection = LightSelection::mixed,
                                         SphereSampling sphere_sampling = SphereSampling::cone) {
    const Scene scene = parse_scene_json(light_scene_text(), "light_scene", "light_scene");
    SceneArrays arrays = scene.arrays();
    if (infinite == LightArrays::Kind::environment) {
        const size_t sky = arrays.lights.kind.size() - 1;
        arrays.lights.kind[sky] = infinite;
        arrays.lights.image[sky] = small_sky();
        arrays.lights.world_from_light[sky].topLeftCorner<3, 3>() =
            Eigen::AngleAxisd(0.8, Eigen::Vector3d(1, 2, 3).normalized()).toRotationMatrix();
    }
    CompileSettings settings;
    settings.light_selection = selection;
    settings.sphere_sampling = sphere_sampling;
    return compile_arrays(
        arrays, compile_camera(arrays.cameras, 0, scene.film_width(), scene.film_height()),
        settings);
}

/// Returns the normal of a light's surface at a point close to the surface.
inline float3 normal_at(const CompiledScene &scene, const LightRecord &light, float3 at) {
    if (light.kind == LIGHT_MESH) {
        const EmitterTriangle *first = &scene.emitter_triangles[light.first_triangle];
        const SurfaceTriangle *best = nullptr;
        float distance = 1e30f;
        for (uint32_t i = 0; i < light.triangle_count; ++i) {
            const SurfaceTriangle &t = scene.surface_triangles[first[i].triangle];
            const float off = fabsf(dot(at - make_float3(t.p0[0], t.p0[1], t.p0[2]),
                                        make_float3(t.normal[0], t.normal[1], t.normal[2])));
            if (off < distance) {
                distance = off;
                best = &t;
            }
        }
        return make_float3(best->normal[0], best->normal[1], best->normal[2]);
    }
    const ShapeRecord &shape = scene.shapes[light.first_triangle];
    const auto &m = shape.world_from_object;
    if (light.kind == LIGHT_DISC) {
        return normalize(
            cross(make_float3(m[0][0], m[1][0], m[2][0]), make_float3(m[0][1], m[1][1], m[2][1])));
    }
    return normalize(at - make_float3(m[0][3], m[1][3], m[2][3]));
}

}  // namespace rtrays
