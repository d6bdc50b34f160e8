// SPDX-License-Identifier: MIT
// Small scene graphs for tests.
#pragma once

#include <memory>
#include <string>

#include "renderer/scene/cores/camera.h"
#include "renderer/scene/cores/light.h"
#include "renderer/scene/cores/material.h"
#include "renderer/scene/cores/mesh.h"
#include "renderer/scene/cores/transform.h"
#include "renderer/scene/cores/visibility.h"
#include "renderer/scene/graph.h"
#include "renderer/tests/errors.h"

namespace rtrays {

inline Node &add_node(Node &parent, const std::string &name) {
    return parent.add_child(std::make_unique<Node>(name));
}

inline std::shared_ptr<LambertMaterial> grey(const std::string &name, double reflectance = 0.5) {
    return std::make_shared<LambertMaterial>(name, Eigen::Vector3d::Constant(reflectance));
}

/// The right triangle (0,0,0), (1,0,0), (0,1,0), facing +z; area 1/2.
inline std::shared_ptr<MeshCore> right_triangle(const std::string &name = "triangle") {
    return std::make_shared<MeshCore>(name, std::vector<Eigen::Vector3d>{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}},
                                      std::vector<Triangle>{{0, 1, 2}});
}

/// The unit square in the xy plane, facing +z.
inline std::shared_ptr<MeshCore> unit_square(const std::string &name = "square") {
    return std::make_shared<MeshCore>(
        name, std::vector<Eigen::Vector3d>{{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}},
        std::vector<Triangle>{{0, 1, 2}, {0, 2, 3}});
}

inline std::shared_ptr<TransformCore> moved(double x, double y, double z) {
    return std::make_shared<TransformCore>("", translation({x, y, z}));
}

/// Every index of the serialized scene is valid and every record belongs to one object: what readers rely on.
inline void expect_consistent(const SceneGraph &graph) {
    const MeshArrays &meshes = graph.arrays().meshes;
    const LightArrays &lights = graph.arrays().lights;
    uint32_t triangles = 0;
    uint32_t vertices = 0;
    for (uint32_t mesh = 0; mesh < meshes.name.size(); ++mesh) {
        ASSERT_EQ(meshes.first_triangle[mesh], triangles);
        ASSERT_EQ(meshes.first_vertex[mesh], vertices);
        triangles += meshes.triangle_count[mesh];
        vertices += meshes.vertex_count[mesh];
        ASSERT_LT(meshes.material[mesh], graph.arrays().materials.name.size());
        if (meshes.light[mesh] != no_index) {
            ASSERT_LT(meshes.light[mesh], lights.mesh.size());
            ASSERT_EQ(lights.mesh[meshes.light[mesh]], mesh);
        }
    }
    ASSERT_EQ(meshes.triangle.size(), triangles);
    ASSERT_EQ(meshes.triangle_mesh.size(), triangles);
    ASSERT_EQ(meshes.position.size(), vertices);
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
    for (uint32_t light = 0; light < lights.mesh.size(); ++light) {
        ASSERT_LT(lights.mesh[light], meshes.name.size());
        ASSERT_EQ(meshes.light[lights.mesh[light]], light);
        ASSERT_GT(lights.area[light], 0);
    }
}

}  // namespace rtrays
