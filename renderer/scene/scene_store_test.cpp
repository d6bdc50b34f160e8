// SPDX-License-Identifier: MIT
// Tests serialization: the contents of the stores after updates, and the cost of updates.
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <random>

#include "renderer/scene/scene.h"
#include "renderer/testing/scene_builder.h"

namespace rtrays {
namespace {

using Eigen::Vector3d;
using Eigen::Vector3f;

/// Returns a graph of `count` triangles "0", "1", ... side by side under a node "all". Every third
/// triangle is a light.
std::unique_ptr<SceneGraph> row_of_triangles(int count) {
    auto graph = std::make_unique<SceneGraph>();
    Node &all = add_node(graph->root(), "all");
    all.set_core(grey("grey"));
    const auto triangle = right_triangle();
    for (int i = 0; i < count; ++i) {
        Node &node = add_node(all, std::to_string(i));
        node.set_core(triangle);
        node.set_core(moved(2.0 * i, 0, 0));
        if (i % 3 == 0) {
            node.set_core(area_light(Vector3d(i, 1, 1)));
        }
    }
    return graph;
}

template <typename T>
T &core_at(SceneGraph &graph, const std::string &name, CoreRole role) {
    return *graph.find(name)->core_of<T>(role);
}

TEST(Stores, HoldTheSceneInWorldSpace) {
    const auto graph = row_of_triangles(4);
    graph->update(0);
    const MeshArrays &meshes = graph->arrays().meshes;
    EXPECT_EQ(meshes.name, (std::vector<std::string>{"0", "1", "2", "3"}));
    EXPECT_EQ(meshes.position[7], Vector3f(5, 0, 0));
    EXPECT_EQ(meshes.triangle[2], (Triangle{6, 7, 8}));
    EXPECT_EQ(meshes.light, (std::vector<uint32_t>{0, no_index, no_index, 1}));
    EXPECT_EQ(graph->arrays().lights.mesh, (std::vector<uint32_t>{0, 3}));
    EXPECT_EQ(graph->arrays().lights.radiance[1], Vector3f(3, 1, 1));
    EXPECT_DOUBLE_EQ(graph->arrays().lights.area[1], 0.5);
    EXPECT_EQ(graph->arrays().materials.name, (std::vector<std::string>{"grey"}));
    EXPECT_EQ(graph->mesh_counts().allocated, 4u);
    EXPECT_EQ(graph->mesh_counts().written, 4u);
    EXPECT_EQ(graph->material_counts().written, 1u) << "a shared material has one record";
    expect_consistent(*graph);
}

TEST(Stores, NothingDirtyNothingWritten) {
    const auto graph = row_of_triangles(10);
    graph->update(0);
    graph->update(0);
    graph->update(1);
    EXPECT_EQ(graph->visited_nodes(), 0u);
    for (const StoreCounts &counts : {graph->mesh_counts(), graph->light_counts(),
                                      graph->material_counts(), graph->camera_counts()}) {
        EXPECT_EQ(counts.allocated + counts.freed + counts.written + counts.moved, 0u);
    }
}

TEST(Stores, OnlyWhatChangedIsRewritten) {
    const auto graph = row_of_triangles(10);
    graph->update(0);
    core_at<TransformCore>(*graph, "4", CoreRole::transform).set_translation({0, 0, 9});
    graph->update(0);
    EXPECT_EQ(graph->mesh_counts().written, 1u);
    EXPECT_EQ(graph->light_counts().written + graph->material_counts().written, 0u);
    EXPECT_EQ(graph->arrays().meshes.position[12], Vector3f(0, 0, 9));

    core_at<MaterialCore>(*graph, "all", CoreRole::material).set("reflectance", Vector3d(1, 0, 0));
    graph->update(0);
    EXPECT_EQ(graph->material_counts().written, 1u);
    EXPECT_EQ(graph->mesh_counts().written, 0u) << "meshes reference a material and do not copy it";
    EXPECT_EQ(graph->arrays().materials.component[0].weight, Vector3f(1, 0, 0));

    graph->find("all")->set_core(grey("other"));
    graph->update(0);
    EXPECT_EQ(graph->arrays().materials.name, (std::vector<std::string>{"other"}));
    EXPECT_EQ(graph->mesh_counts().written, 10u);
    expect_consistent(*graph);
}

TEST(Stores, RevisionTellsWhichPartChanged) {
    const auto graph = row_of_triangles(10);
    graph->update(0);
    SceneRevision before = graph->revision();
    // Compares, as a word of five letters, which parts differ from the last call.
    const auto changes = [&] {
        graph->update(0);
        const SceneRevision after = graph->revision();
        EXPECT_EQ(after.scene, before.scene);
        const std::string word = {after.materials != before.materials ? 'M' : '-',
                                  after.geometry != before.geometry ? 'G' : '-',
                                  after.surfaces != before.surfaces ? 'S' : '-',
                                  after.shapes != before.shapes ? 'H' : '-',
                                  after.lights != before.lights ? 'L' : '-'};
        before = after;
        return word;
    };
    EXPECT_EQ(changes(), "-----");
    core_at<TransformCore>(*graph, "4", CoreRole::transform).set_translation({0, 0, 9});
    EXPECT_EQ(changes(), "-G---");
    core_at<TransformCore>(*graph, "4", CoreRole::transform).set_translation({0, 0, 9});
    EXPECT_EQ(changes(), "-----");
    core_at<MaterialCore>(*graph, "all", CoreRole::material).set("reflectance", Vector3d(1, 0, 0));
    EXPECT_EQ(changes(), "M----");
    core_at<LightCore>(*graph, "3", CoreRole::light).set("radiance", Vector3d(1, 2, 3));
    EXPECT_EQ(changes(), "----L") << "the mesh that emits is written, but with equal values";
    graph->find("all")->set_core(grey("other"));
    EXPECT_EQ(changes(), "M-SHL") << "indices of materials may have moved";
    EXPECT_NE(row_of_triangles(10)->revision().scene, before.scene);
}

TEST(Stores, SeveralEditsOfOneNodeAreWrittenOnce) {
    const auto graph = row_of_triangles(10);
    graph->update(0);
    for (int i = 0; i < 5; ++i) {
        core_at<TransformCore>(*graph, "3", CoreRole::transform).set_translation({0, 0, 1.0 * i});
        core_at<LightCore>(*graph, "3", CoreRole::light).set("radiance", Vector3d(1, 1, 1.0 * i));
    }
    graph->find("all")->set_core(moved(1, 0, 0));
    graph->update(0);
    EXPECT_EQ(graph->visited_nodes(), 11u);
    EXPECT_EQ(graph->mesh_counts().written, 10u);
    EXPECT_EQ(graph->light_counts().written, 4u);
    EXPECT_EQ(graph->arrays().meshes.position[9], Vector3f(1, 0, 4));
}

TEST(Stores, HiddenObjectsLeaveNoHole) {
    const auto graph = row_of_triangles(7);
    graph->update(0);
    graph->find("0")->set_core(std::make_shared<VisibilityCore>("", false));
    graph->find("4")->set_core(std::make_shared<VisibilityCore>("", false));
    graph->update(0);
    EXPECT_EQ(graph->arrays().meshes.name, (std::vector<std::string>{"1", "2", "3", "5", "6"}));
    EXPECT_EQ(graph->arrays().meshes.position[6], Vector3f(6, 0, 0));
    EXPECT_EQ(graph->arrays().lights.name, (std::vector<std::string>{"3", "6"}));
    EXPECT_EQ(graph->mesh_counts().freed, 2u);
    EXPECT_EQ(graph->mesh_counts().moved, 5u);
    EXPECT_EQ(graph->mesh_counts().written, 0u);
    expect_consistent(*graph);

    core_at<VisibilityCore>(*graph, "0", CoreRole::visibility).set_visible(true);
    graph->update(0);
    EXPECT_EQ(graph->arrays().meshes.name.back(), "0");
    EXPECT_EQ(graph->mesh_counts().written, 1u);
    expect_consistent(*graph);
}

TEST(Stores, RemovedNodesAndCoresDisappear) {
    const auto graph = row_of_triangles(5);
    graph->update(0);
    Node &all = *graph->find("all");
    all.remove_child(*graph->find("1"));
    graph->find("3")->remove_core(CoreRole::light);
    graph->find("0")->remove_core(CoreRole::light);
    graph->find("0")->remove_core(CoreRole::geometry);
    graph->update(0);
    EXPECT_EQ(graph->arrays().meshes.name, (std::vector<std::string>{"2", "3", "4"}));
    EXPECT_TRUE(graph->arrays().lights.name.empty());
    EXPECT_EQ(graph->arrays().meshes.light, (std::vector<uint32_t>(3, no_index)));
    EXPECT_EQ(graph->mesh_counts().freed, 2u);
    expect_consistent(*graph);
}

TEST(Stores, AMeshThatGrowsGetsANewRecord) {
    const auto graph = row_of_triangles(3);
    graph->update(0);
    graph->find("1")->set_core(unit_square());
    graph->update(0);
    const MeshArrays &meshes = graph->arrays().meshes;
    EXPECT_EQ(meshes.name, (std::vector<std::string>{"0", "2", "1"}));
    EXPECT_EQ(meshes.position.size(), 10u);
    expect_consistent(*graph);
    // Changes the geometry through the core, which three nodes then share.
    const auto square = std::dynamic_pointer_cast<MeshCore>(right_triangle());
    for (const char *name : {"0", "1", "2"}) {
        graph->find(name)->set_core(square);
    }
    graph->update(0);
    square->set_geometry({unit_square()->vertices(), unit_square()->triangles()});
    graph->update(0);
    EXPECT_EQ(meshes.position.size(), 12u);
    EXPECT_EQ(graph->mesh_counts().written, 3u);
    expect_consistent(*graph);
}

/// Returns a mesh with or without normals, texture coordinates and colours, or a shape that may
/// emit.
std::shared_ptr<Core> any_geometry(unsigned choice) {
    if (choice >= 4) {
        return shape(choice % 2 == 0 ? "sphere" : "disc");
    }
    MeshCore::Geometry geometry{right_triangle()->vertices(), right_triangle()->triangles()};
    if (choice % 2 == 1) {
        geometry.normals.assign(3, Vector3d(0, 0, 1));
    }
    if (choice >= 2) {
        geometry.uvs = {{0, 0}, {1, 0}, {0, 1}};
    }
    if (choice == 1 || choice == 2) {
        geometry.colours.assign(3, Vector3d(1, 0.25 * choice, 0));
    }
    return choice == 0 ? unit_square() : std::make_shared<MeshCore>("", geometry);
}

/// Returns a material of one or two components. It may emit, or have its own texture or a shared
/// one.
std::shared_ptr<MaterialCore> any_material(unsigned choice,
                                           const std::shared_ptr<Texture> &shared) {
    ParameterValues values{{"reflectance", Vector3d(0.5, 0.5, 0.5)}};
    if (choice % 4 == 0) {
        values["emission"] = Vector3d(1, 2, 3);
    }
    ParameterTextures textures;
    if (choice % 4 == 1) {
        textures["reflectance"] =
            choice >= 4 ? shared : std::make_shared<Texture>("own", shared->image());
    }
    if (choice % 2 == 0) {
        values["eta"] = 1.5;
    }
    return std::make_shared<MaterialCore>("", choice % 2 == 0 ? "plastic" : "lambert", values,
                                          textures);
}

/// Returns a description of all parts of the arrays that an image depends on, for comparison.
std::vector<std::string> described(const SceneArrays &arrays) {
    std::vector<std::string> all;
    const auto add = [&](const auto &...values) {
        all.push_back(fmt::format("{}", fmt::join(std::vector<std::string>{values...}, " ")));
    };
    const auto component = [&](uint32_t material) {
        const BxdfComponent &c =
            arrays.materials.component[arrays.materials.first_component[material]];
        return c.texture == no_index ? std::string("plain") : arrays.textures.name[c.texture];
    };
    const auto light = [&](uint32_t index) {
        return index == no_index ? 0.0
                                 : arrays.lights.radiance[index].sum() * arrays.lights.area[index];
    };
    for (uint32_t i = 0; i < arrays.meshes.name.size(); ++i) {
        const uint32_t v = arrays.meshes.first_vertex[i] + 1;
        add(arrays.meshes.name[i], component(arrays.meshes.material[i]),
            fmt::format("{}", light(arrays.meshes.light[i])),
            fmt::format("{}", arrays.meshes.position[v].x()),
            fmt::format("{}", arrays.meshes.has_normals[i]),
            fmt::format("{}", arrays.meshes.has_uv[i] != 0 ? arrays.meshes.uv[v].x() : 0),
            fmt::format("{}", arrays.meshes.colour.empty() ? 1 : arrays.meshes.colour[v].y()));
    }
    for (uint32_t i = 0; i < arrays.shapes.name.size(); ++i) {
        add(arrays.shapes.name[i], component(arrays.shapes.material[i]),
            fmt::format("{}", light(arrays.shapes.light[i])),
            fmt::format("{}", arrays.shapes.world_from_object[i](0, 3)));
    }
    for (uint32_t i = 0; i < arrays.lights.name.size(); ++i) {
        add(arrays.lights.name[i], fmt::format("{}", arrays.lights.world_from_light[i](0, 3)));
    }
    std::sort(all.begin(), all.end());
    return all;
}

TEST(Stores, StayConsistentUnderRandomEdits) {
    const auto graph = row_of_triangles(40);
    const auto image = std::make_shared<TextureImage>(TextureImage{1, 1, false, {1, 2, 3}, {}});
    const auto shared = std::make_shared<Texture>("shared", image);
    std::minstd_rand random(1);
    const auto give_light = [](Node &node, const std::shared_ptr<LightCore> &light) {
        node.set_core(grey("dark"));  // geometry with an emissive material accepts no light
        node.set_core(light);
    };
    for (int round = 0; round < 400; ++round) {
        for (int edit = 0; edit < 4; ++edit) {
            Node *node = graph->find(std::to_string(random() % 40));
            if (node == nullptr) {
                continue;
            }
            switch (random() % 9) {
                case 0:
                    node->set_core(std::make_shared<VisibilityCore>("", random() % 2 == 0));
                    break;
                case 1:
                    node->set_core(moved(static_cast<double>(random() % 100), 0, 0));
                    break;
                case 2:
                    node->set_core(any_geometry(static_cast<unsigned>(random() % 6)));
                    break;
                case 3:
                    give_light(*node, area_light(Vector3d(1, 1, 1)));
                    break;
                case 4:
                    give_light(*node,
                               std::make_shared<LightCore>(
                                   "", "point", ParameterValues{{"intensity", Vector3d(1, 1, 1)}}));
                    break;
                case 5:
                    node->remove_core(CoreRole::light);
                    break;
                case 6:
                    node->remove_core(CoreRole::light);
                    node->set_core(any_material(static_cast<unsigned>(random() % 8), shared));
                    break;
                case 7:
                    shared->set("uv_scale", Eigen::Vector2d(static_cast<double>(round), 1));
                    break;
                default: {
                    // Removes the node and adds it under another parent.
                    Node &parent = *node->parent();
                    graph->root().set_core(grey("fallback"));
                    graph->root().add_child(parent.remove_child(*node));
                }
            }
        }
        graph->update(0);
        expect_consistent(*graph);
        if (testing::Test::HasFatalFailure()) {
            return;
        }
        const TextureArrays &textures = graph->arrays().textures;
        for (size_t i = 0; i < textures.name.size(); ++i) {
            if (textures.name[i] == "shared") {
                EXPECT_EQ(textures.uv_scale[i],
                          shared->parameters().get<Eigen::Vector2d>("uv_scale"));
            }
        }
    }
    EXPECT_GT(graph->arrays().shapes.name.size(), 3u);
    EXPECT_GT(graph->arrays().textures.name.size(), 1u);
    // The result of the edits must equal that of an update of everything.
    const std::vector<std::string> edited = described(graph->arrays());
    const std::vector<Vector3f> positions = graph->arrays().meshes.position;
    const std::vector<Triangle> triangles = graph->arrays().meshes.triangle;
    graph->root().mark(Dirty::subtree);
    graph->update(0);
    EXPECT_EQ(described(graph->arrays()), edited);
    EXPECT_EQ(graph->arrays().meshes.position, positions);
    EXPECT_EQ(graph->arrays().meshes.triangle, triangles);
}

TEST(Stores, InstancesShareACoreAndHaveRecordsOfTheirOwn) {
    SceneGraph graph;
    graph.root().set_core(grey("grey"));
    const auto triangle = right_triangle();
    Node &first = add_node(graph.root(), "first");
    Node &second = add_node(graph.root(), "second");
    first.set_core(triangle);
    second.set_core(triangle);
    second.set_core(std::make_shared<TransformCore>("", scaling({3, 1, 1})));
    graph.update(0);
    EXPECT_EQ(triangle->nodes().size(), 2u);
    EXPECT_EQ(graph.arrays().meshes.position[1], Vector3f(1, 0, 0));
    EXPECT_EQ(graph.arrays().meshes.position[4], Vector3f(3, 0, 0));
    triangle->set_geometry({{{0, 0, 0}, {2, 0, 0}, {0, 1, 0}}, {{0, 1, 2}}});
    graph.update(0);
    EXPECT_EQ(graph.mesh_counts().written, 2u);
    EXPECT_EQ(graph.arrays().meshes.position[4], Vector3f(6, 0, 0));
}

TEST(Stores, AMirrorKeepsTheFrontOfASurface) {
    SceneGraph graph;
    graph.root().set_core(grey("grey"));
    Node &node = add_node(graph.root(), "node");
    node.set_core(right_triangle());
    // Mirrored in x, the triangle must still face +z. Mirrored in z, its front faces -z.
    for (const auto &[factors, facing] :
         {std::pair{Vector3d(-1, 1, 1), 1.0f}, std::pair{Vector3d(1, 1, -1), -1.0f}}) {
        node.set_core(std::make_shared<TransformCore>("", scaling(factors)));
        graph.update(0);
        const MeshArrays &meshes = graph.arrays().meshes;
        const Triangle &t = meshes.triangle[0];
        const Vector3f a = meshes.position[t[0]];
        EXPECT_EQ((meshes.position[t[1]] - a).cross(meshes.position[t[2]] - a),
                  Vector3f(0, 0, facing));
    }
}

TEST(Stores, CamerasAreRigid) {
    SceneGraph graph;
    Node &parent = add_node(graph.root(), "parent");
    Node &node = add_node(parent, "camera");
    node.set_core(pinhole(90, "y"));
    node.set_core(std::make_shared<TransformCore>("", look_at({0, 0, 4}, {4, 0, 4}, {0, 1, 0})));
    parent.set_core(std::make_shared<TransformCore>("", scaling({10, 10, 10})));
    graph.update(0);
    const Eigen::Matrix4d &pose = graph.arrays().cameras.world_from_camera[0];
    EXPECT_TRUE(pose.isApprox(look_at({0, 0, 40}, {1, 0, 40}, {0, 1, 0}), 1e-14)) << pose;
    EXPECT_DOUBLE_EQ(graph.arrays().cameras.fov[0], std::acos(-1.0) / 2);
    parent.set_core(std::make_shared<TransformCore>("", scaling({-1, 1, 1})));
    expect_input_error("camera 'camera': its transform mirrors", [&] { graph.update(0); });
    parent.set_core(std::make_shared<TransformCore>("", scaling({1, 2, 1})));
    expect_input_error("camera 'camera': its transform shears", [&] { graph.update(0); });
    parent.remove_core(CoreRole::transform);
    EXPECT_NO_THROW(graph.update(0));
}

TEST(Stores, WhatCannotBeRepresentedIsAnErrorUntilItIsMended) {
    SceneGraph graph;
    Node &node = add_node(graph.root(), "node");
    node.set_core(right_triangle());
    expect_input_error("mesh 'node' has no material", [&] { graph.update(0); });
    node.set_core(grey("grey"));
    node.set_core(std::make_shared<TransformCore>("", scaling({1e39, 1, 1})));
    expect_input_error("mesh 'node': vertex 1, [1, 0, 0], is beyond the range of float",
                       [&] { graph.update(0); });
    node.set_core(std::make_shared<TransformCore>("", scaling({1e-30, 1e-30, 1})));
    node.set_core(area_light(Vector3d(1, 1, 1)));
    graph.update(0);
    EXPECT_NEAR(graph.arrays().lights.area[0] / 0.5e-60, 1, 1e-6);
    node.set_core(std::make_shared<MeshCore>("line", std::vector<Vector3d>{{0, 0, 0}, {1, 1, 1}},
                                             std::vector<Triangle>{{0, 1, 1}}));
    expect_input_error("light 'node': its mesh has no area", [&] { graph.update(0); });
    expect_input_error("light 'node': its mesh has no area", [&] { graph.update(0); });
    node.remove_core(CoreRole::geometry);
    expect_input_error("light 'node': an area light needs geometry", [&] { graph.update(0); });
    node.set_core(right_triangle());
    EXPECT_NO_THROW(graph.update(0));
    expect_consistent(graph);
}

TEST(Stores, AFarOriginCostsNoPrecision) {
    SceneGraph graph;
    graph.root().set_core(grey("grey"));
    Node &node = add_node(graph.root(), "node");
    node.set_core(std::make_shared<TransformCore>(
        "", translation({1e6, 1e6, 1e6}) * scaling({1e-3, 1e-3, 1e-3})));
    node.set_core(right_triangle());
    graph.update(0);
    EXPECT_EQ(graph.arrays().meshes.position[0], graph.arrays().meshes.position[1])
        << "an ulp of 1e6 is 1/16";
    graph.set_origin({1e6, 1e6, 1e6});
    graph.update(0);
    EXPECT_NEAR(graph.arrays().meshes.position[1].x(), 1e-3, 1e-9);
}

}  // namespace
}  // namespace rtrays
