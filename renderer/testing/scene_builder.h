// SPDX-License-Identifier: MIT
// Helpers that build small scene graphs, and checks of serialized scenes.
#pragma once

#include <algorithm>
#include <memory>
#include <string>

#include "renderer/scene/cores/camera.h"
#include "renderer/scene/cores/light.h"
#include "renderer/scene/cores/material.h"
#include "renderer/scene/cores/mesh.h"
#include "renderer/scene/cores/shape.h"
#include "renderer/scene/cores/transform.h"
#include "renderer/scene/cores/visibility.h"
#include "renderer/scene/graph.h"
#include "renderer/testing/errors.h"

namespace rtrays {

/// Fixture of tests that read images. Builds without textures skip them.
class WithImages : public testing::Test {
  protected:
    void SetUp() override {
        if (!RTRAYS_TEXTURES) {
            GTEST_SKIP() << "built without RTRAYS_TEXTURES";
        }
    }
};

inline Node &add_node(Node &parent, const std::string &name) {
    return parent.add_child(std::make_unique<Node>(name));
}

inline std::shared_ptr<MaterialCore> grey(const std::string &name, double reflectance = 0.5) {
    return std::make_shared<MaterialCore>(
        name, "lambert",
        ParameterValues{{"reflectance", Eigen::Vector3d(Eigen::Vector3d::Constant(reflectance))}});
}

inline std::shared_ptr<LightCore> area_light(const Eigen::Vector3d &radiance) {
    return std::make_shared<LightCore>("", "diffuse_area", ParameterValues{{"radiance", radiance}});
}

inline std::shared_ptr<CameraCore> pinhole(double fov_degrees, const std::string &fov_axis) {
    return std::make_shared<CameraCore>(
        "", "pinhole", ParameterValues{{"fov", fov_degrees}, {"fov_axis", fov_axis}});
}

inline std::shared_ptr<ShapeCore> shape(const std::string &type,
                                        const ParameterValues &values = {}) {
    return std::make_shared<ShapeCore>(type, type, values);
}

/// Returns the right triangle (0,0,0), (1,0,0), (0,1,0), which faces +z and has area 1/2.
inline std::shared_ptr<MeshCore> right_triangle(const std::string &name = "triangle") {
    return std::make_shared<MeshCore>(name,
                                      std::vector<Eigen::Vector3d>{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}},
                                      std::vector<Triangle>{{0, 1, 2}});
}

/// Returns the unit square in the xy plane, which faces +z.
inline std::shared_ptr<MeshCore> unit_square(const std::string &name = "square") {
    return std::make_shared<MeshCore>(
        name, std::vector<Eigen::Vector3d>{{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}},
        std::vector<Triangle>{{0, 1, 2}, {0, 2, 3}});
}

inline std::shared_ptr<TransformCore> moved(double x, double y, double z) {
    return std::make_shared<TransformCore>("", translation({x, y, z}));
}

/// Checks the indices of one light: an area light belongs to exactly one geometry, other lights to
/// none.
inline void expect_consistent_light(const SceneArrays &arrays, uint32_t light) {
    const LightArrays &lights = arrays.lights;
    if (lights.kind[light] != LightArrays::Kind::diffuse_area) {
        ASSERT_EQ(lights.mesh[light], no_index);
        ASSERT_EQ(lights.shape[light], no_index);
        ASSERT_EQ(lights.area[light], 0);
        ASSERT_TRUE((lights.kind[light] == LightArrays::Kind::environment) ==
                    (lights.image[light] != nullptr));
        return;
    }
    ASSERT_GT(lights.area[light], 0);
    ASSERT_NE(lights.mesh[light] == no_index, lights.shape[light] == no_index);
    if (lights.mesh[light] != no_index) {
        ASSERT_LT(lights.mesh[light], arrays.meshes.name.size());
        ASSERT_EQ(arrays.meshes.light[lights.mesh[light]], light);
    } else {
        ASSERT_LT(lights.shape[light], arrays.shapes.name.size());
        ASSERT_EQ(arrays.shapes.light[lights.shape[light]], light);
    }
}

/// Checks what readers of a serialized scene rely on: every index is valid, and every record
/// belongs to one object.
inline void expect_consistent(const SceneGraph &graph) {
    const SceneArrays &arrays = graph.arrays();
    const MeshArrays &meshes = arrays.meshes;
    uint32_t triangles = 0;
    uint32_t vertices = 0;
    for (uint32_t mesh = 0; mesh < meshes.name.size(); ++mesh) {
        ASSERT_EQ(meshes.first_triangle[mesh], triangles);
        ASSERT_EQ(meshes.first_vertex[mesh], vertices);
        triangles += meshes.triangle_count[mesh];
        vertices += meshes.vertex_count[mesh];
        ASSERT_LT(meshes.material[mesh], arrays.materials.name.size());
        if (meshes.light[mesh] != no_index) {
            ASSERT_LT(meshes.light[mesh], arrays.lights.mesh.size());
            ASSERT_EQ(arrays.lights.mesh[meshes.light[mesh]], mesh);
        }
        for (uint32_t vertex = meshes.first_vertex[mesh];
             vertex < vertices && !meshes.normal.empty(); ++vertex) {
            ASSERT_NEAR(meshes.normal[vertex].norm(), meshes.has_normals[mesh] != 0 ? 1 : 0, 1e-6)
                << meshes.name[mesh];
        }
    }
    ASSERT_EQ(meshes.triangle.size(), triangles);
    ASSERT_EQ(meshes.triangle_mesh.size(), triangles);
    ASSERT_EQ(meshes.position.size(), vertices);
    const auto has = [](const std::vector<uint8_t> &flags) {
        return std::find(flags.begin(), flags.end(), 1) != flags.end();
    };
    ASSERT_EQ(meshes.normal.size(), has(meshes.has_normals) ? vertices : 0);
    ASSERT_EQ(meshes.uv.size(), has(meshes.has_uv) ? vertices : 0);
    ASSERT_EQ(meshes.colour.size(), has(meshes.has_colour) ? vertices : 0);
    for (uint32_t triangle = 0; triangle < triangles; ++triangle) {
        const uint32_t mesh = meshes.triangle_mesh[triangle];
        ASSERT_LT(mesh, meshes.name.size());
        ASSERT_GE(triangle, meshes.first_triangle[mesh]);
        ASSERT_LT(triangle, meshes.first_triangle[mesh] + meshes.triangle_count[mesh]);
        for (const uint32_t vertex : meshes.triangle[triangle]) {
            ASSERT_GE(vertex, meshes.first_vertex[mesh]);
            ASSERT_LT(vertex, meshes.first_vertex[mesh] + meshes.vertex_count[mesh]);
        }
    }
    for (uint32_t shape = 0; shape < arrays.shapes.name.size(); ++shape) {
        ASSERT_LT(arrays.shapes.material[shape], arrays.materials.name.size());
        if (arrays.shapes.light[shape] != no_index) {
            ASSERT_LT(arrays.shapes.light[shape], arrays.lights.shape.size());
            ASSERT_EQ(arrays.lights.shape[arrays.shapes.light[shape]], shape);
        }
    }
    for (uint32_t light = 0; light < arrays.lights.name.size(); ++light) {
        expect_consistent_light(arrays, light);
    }
    uint32_t components = 0;
    for (uint32_t material = 0; material < arrays.materials.name.size(); ++material) {
        ASSERT_EQ(arrays.materials.first_component[material], components);
        components += arrays.materials.component_count[material];
    }
    ASSERT_EQ(arrays.materials.component.size(), components);
    std::vector<bool> used(arrays.textures.name.size());
    const auto mark = [&](uint32_t texture) {
        if (texture != no_index) {
            ASSERT_LT(texture, used.size());
            used[texture] = true;
        }
    };
    for (const BxdfComponent &component : arrays.materials.component) {
        mark(component.texture);
        mark(component.roughness_texture);
        mark(component.mix_texture);
    }
    ASSERT_EQ(arrays.materials.opacity.size(), arrays.materials.name.size());
    for (const MaterialOpacity &opacity : arrays.materials.opacity) {
        mark(opacity.texture);
    }
    ASSERT_EQ(arrays.materials.normal_map.size(), arrays.materials.name.size());
    for (const NormalMap &map : arrays.materials.normal_map) {
        ASSERT_EQ(map.texture == no_index, map.kind == NormalMap::Kind::none);
        mark(map.texture);
    }
    ASSERT_EQ(arrays.materials.emission_texture.size(), arrays.materials.name.size());
    for (const uint32_t texture : arrays.materials.emission_texture) {
        mark(texture);
    }
    ASSERT_EQ(std::count(used.begin(), used.end(), false), 0) << "textures that no material uses";
}

}  // namespace rtrays
