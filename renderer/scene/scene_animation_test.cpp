// SPDX-License-Identifier: MIT
// Tests keyframe animation, and the cost of a step in time.
#include <Eigen/Geometry>
#include <algorithm>
#include <chrono>
#include <cmath>

#include "renderer/base/angles.h"
#include "renderer/import/json/scene_json.h"
#include "renderer/import/load_scene.h"
#include "renderer/scene/cores/animated_transform.h"
#include "renderer/scene/cores/morphed_mesh.h"
#include "renderer/testing/scene_builder.h"

namespace rtrays {
namespace {

using Eigen::Matrix4d;
using Eigen::Vector3d;
using Eigen::Vector3f;

TEST(Animation, KeyframesAreMetToTheBitAndHoldOutside) {
    const Matrix4d a = translation({0.1, 0.2, 0.3}) * rotation({1, 2, 3}, 0.7) * scaling({1, 2, 3});
    const Matrix4d b = rotation({3, 2, 1}, 1.7) * scaling({0.1, 0.7, 0.3});
    const Matrix4d c = scaling({2, 2, 2});
    const AnimatedTransform animated("", {{1, a}, {1.5, b}, {7, c}});
    EXPECT_EQ(animated.matrix(), a) << "at time 0";
    EXPECT_EQ(animated.matrix_at(-1e300), a);
    EXPECT_EQ(animated.matrix_at(1), a);
    EXPECT_EQ(animated.matrix_at(1.5), b);
    EXPECT_EQ(animated.matrix_at(7), c);
    EXPECT_EQ(animated.matrix_at(1e300), c);
    EXPECT_EQ(AnimatedTransform("", {{5, b}}).matrix_at(2), b);
}

TEST(Animation, RotationsTurnEvenlyAndLengthsChangeEvenly) {
    // Half a turn in two steps, with scaling from 1 to 3 along x and translation along y.
    const AnimatedTransform turning(
        "", {{0, Matrix4d::Identity()},
             {2, translation({0, 4, 0}) * rotation({0, 0, 1}, pi / 2) * scaling({3, 1, 1})},
             {4, rotation({0, 0, 1}, pi)}});
    for (const double time : {0.25, 0.5, 1.0, 1.75}) {
        const double s = time / 2;
        const Matrix4d wanted = translation({0, 4 * s, 0}) * rotation({0, 0, 1}, s * pi / 2) *
                                scaling({1 + 2 * s, 1, 1});
        EXPECT_TRUE(turning.matrix_at(time).isApprox(wanted, 1e-14)) << time << '\n'
                                                                     << turning.matrix_at(time);
    }
    EXPECT_TRUE(turning.matrix_at(3).topLeftCorner(3, 3).isApprox(
        (rotation({0, 0, 1}, 0.75 * pi) * scaling({2, 1, 1})).topLeftCorner(3, 3), 1e-14));
    // Interpolation takes the shorter rotation: 340 degrees is -20.
    const AnimatedTransform wide(
        "", {{0, Matrix4d::Identity()}, {1, rotation({0, 0, 1}, 340 * pi / 180)}});
    EXPECT_TRUE(wide.matrix_at(0.5).isApprox(rotation({0, 0, 1}, -10 * pi / 180), 1e-14));
}

TEST(Animation, MirroredObjectsStayMirroredAndInvertible) {
    const AnimatedTransform mirrored(
        "", {{0, scaling({-1, 2, 1})}, {1, rotation({1, 1, 0}, 2) * scaling({1, 1, -5})}});
    for (double time = 0; time <= 1; time += 1.0 / 64) {
        EXPECT_LT(mirrored.matrix_at(time).determinant(), -1) << time;
    }
}

TEST(Animation, ErrorsNameTheKeyframe) {
    const auto scene = [](const std::string &node) {
        return parse_scene_json(R"({"version": 1, "film": {"width": 1, "height": 1}, "nodes": [
            {"name": "eye", "camera": {"type": "pinhole", "fov": 60, "fov_axis": "x"}},
            {"name": "a", )" + node +
                                    "}]}",
                                "in.json", "in");
    };
    struct Case {
        const char *node;
        const char *message;
    };
    for (
        const Case &c : {
            Case{R"("animation": [])", "in.json:3: /nodes/1/animation (in 'a')"},
            Case{R"("animation": [{"time": 0}])",
                 "/nodes/1/animation/0 (in 'a'): missing key 'transform'"},
            Case{R"("animation": [{"time": 0, "transform": []}, {"time": 0, "transform": []}])",
                 "in.json:3: /nodes/1/animation: animation: keyframe 1 is at 0 s, but must be "
                 "later than the previous one at 0 s"},
            Case{
                R"("animation": [{"time": 0, "transform": []}, {"time": 1, "transform": [{"scale": [1, 0, 1]}]}])",
                "/nodes/1/animation/1/transform/0: transform: the matrix is not invertible"},
            Case{
                R"("animation": [{"time": 0, "transform": []}, {"time": 1, "transform": [{"scale": [1, 1, -1]}]}])",
                "keyframe 1 and the previous one must both mirror or both not mirror"},
            Case{
                R"("animation": [{"time": 0, "transform": []}, {"time": 1, "transform": [{"rotate": {"axis": [1, 2, 3], "degrees": 180}}]}])",
                "keyframe 1 is half a turn from the previous one"},
            Case{R"("animation": [{"time": 0, "transform": []}], "transform": [])",
                 "'a' has both a transform and an animation"},
        }) {
        SCOPED_TRACE(c.node);
        expect_input_error(c.message, [&] { scene(c.node); });
    }
    Scene still = scene(R"("animation": [{"time": 0, "transform": []}])");
    expect_input_error("'a.translation': the property is read-only",
                       [&] { still.set_property("a.translation", "1,2,3"); });
}

TEST(Animation, MovesGeometryLightsAndCamerasWithTheirNodes) {
    Scene scene = parse_scene_json(R"({"version": 1, "film": {"width": 1, "height": 1}, "nodes": [
        {"name": "cart", "animation": [{"time": 0, "transform": []}, {"time": 2, "transform": [{"translate": [4, 0, 0]}]}],
         "material": {"type": "lambert", "reflectance": [0, 0, 0]}, "children": [
            {"name": "eye", "camera": {"type": "pinhole", "fov": 60, "fov_axis": "x"}},
            {"name": "ball", "geometry": {"type": "sphere"}},
            {"name": "sheet", "geometry": {"type": "rectangle"}, "transform": [{"translate": [0, 3, 0]}]},
            {"name": "lamp", "light": {"type": "point", "intensity": [1, 1, 1]}}]}]})",
                                   "in.json", "in");
    const std::string hash = scene.hash();
    scene.update(1);
    EXPECT_EQ(scene.cameras().world_from_camera[0](0, 3), 2);
    EXPECT_EQ(scene.arrays().shapes.world_from_object[0](0, 3), 2);
    EXPECT_EQ(scene.meshes().position[0], Vector3f(1, 2, 0));
    EXPECT_EQ(scene.lights().world_from_light[0](0, 3), 2);
    EXPECT_NE(scene.hash(), hash);
    scene.update(9);
    EXPECT_EQ(scene.meshes().position[0], Vector3f(3, 2, 0));
    EXPECT_EQ(scene.graph().visited_nodes(), 5u);
    scene.update(10);
    EXPECT_EQ(scene.graph().visited_nodes(), 0u) << "the last keyframe remains in effect";
    scene.update(0);
    EXPECT_EQ(scene.hash(), hash);
}

/// Returns a keyframe of a triangle with the given second corner and the given normal there.
MorphedMesh::Key corner_at(double time, const Vector3d &corner, const Vector3d &normal) {
    return {time,
            {{{0, 0, 0}, corner, {0, 1, 0}}, {{0, 1, 2}}, {{0, 0, 1}, normal, {0, 0, 1}}, {}}};
}

TEST(Morph, VerticesFollowTheKeyframes) {
    MorphedMesh mesh("m", {corner_at(1, {1, 0, 0}, {0, 0, 1}), corner_at(2, {1, 0, 1}, {1, 0, 0}),
                           corner_at(4, {2, 0, 0}, {-1, 0, 0})});
    const auto corner_of = [&](double time) {
        mesh.update(time);
        EXPECT_EQ(mesh.vertices()[0], Vector3d(0, 0, 0));
        return mesh.vertices()[1];
    };
    for (const double time : {-5.0, 0.0, 1.0}) {
        EXPECT_EQ(corner_of(time), Vector3d(1, 0, 0)) << time;
    }
    EXPECT_EQ(corner_of(1.25), Vector3d(1, 0, 0.25));
    EXPECT_EQ(corner_of(2), Vector3d(1, 0, 1));
    EXPECT_EQ(mesh.normals()[1], Vector3d(1, 0, 0));
    EXPECT_EQ(corner_of(3), Vector3d(1.5, 0, 0.5));
    EXPECT_EQ(mesh.normals()[1], Vector3d(-1, 0, 0))
        << "half-way between opposite normals, that of the next keyframe is used";
    EXPECT_EQ(corner_of(4), Vector3d(2, 0, 0));
    EXPECT_EQ(corner_of(1e300), Vector3d(2, 0, 0));
    EXPECT_EQ(corner_of(1), Vector3d(1, 0, 0));
    mesh.update(1.5);
    EXPECT_TRUE(mesh.normals()[1].isApprox(Vector3d(1, 0, 1).normalized(), 1e-15))
        << "normals must have unit length";
}

TEST(Morph, ComesToTheTimeOfItsScene) {
    Scene scene = load_scene(RTRAYS_SCENES "/cloth/scene.json");
    const std::string hash = scene.hash();
    const std::vector<Triangle> triangles = scene.meshes().triangle;
    scene.update(1.5);
    EXPECT_NE(scene.hash(), hash);
    EXPECT_EQ(scene.meshes().triangle, triangles);
    EXPECT_EQ(scene.graph().visited_nodes(), 1u) << "no other node moves";
    scene.update(7);
    const std::string last = scene.hash();
    scene.update(2);
    EXPECT_EQ(scene.hash(), last);
    scene.update(0);
    EXPECT_EQ(scene.hash(), hash);
}

TEST(Morph, ErrorsNameTheKeyframe) {
    const auto scene = [](const std::string &keyframes) {
        return parse_scene_json(R"({"version": 1, "film": {"width": 1, "height": 1}, "nodes": [
            {"name": "eye", "camera": {"type": "pinhole", "fov": 60, "fov_axis": "x"}},
            {"name": "a", "material": {"type": "lambert", "reflectance": [0, 0, 0]},
             "geometry": {"type": "morph", "keyframes": [)" +
                                    keyframes + "]}}]}",
                                "in.json", "in");
    };
    struct Case {
        const char *keyframes;
        const char *message;
    };
    for (
        const Case &c : {
            Case{"", "/nodes/1/geometry/keyframes (in 'a')"},
            Case{R"({"time": 0, "geometry": {"type": "sphere"}})",
                 "keyframe 0 must be a mesh, file, rectangle or box"},
            Case{
                R"({"time": 1, "geometry": {"type": "box"}}, {"time": 1, "geometry": {"type": "box"}})",
                "mesh 'a': keyframe 1 is at 1 s, but must be later than the previous one at 1 s"},
            Case{
                R"({"time": 0, "geometry": {"type": "box"}}, {"time": 1, "geometry": {"type": "rectangle"}})",
                "mesh 'a': keyframe 1 has 4 vertices and 0 normals, but the first keyframe has 24 "
                "and 0"},
            Case{
                R"({"time": 0, "geometry": {"type": "mesh", "vertices": [[0,0,0],[1,0,0],[0,1,0]], "polygons": [[0,1,2]]}},
                     {"time": 1, "geometry": {"type": "mesh", "vertices": [[0,0,0],[1,0,0],[0,1,0]], "polygons": [[0,2,1]]}})",
                "mesh 'a': keyframe 1 must have the same triangles as the first keyframe"},
        }) {
        SCOPED_TRACE(c.keyframes);
        expect_input_error(c.message, [&] { scene(c.keyframes); });
    }
}

std::shared_ptr<AnimatedTransform> sliding(double x_after_10_seconds) {
    return std::make_shared<AnimatedTransform>(
        "", std::vector<Keyframe>{{0, Matrix4d::Identity()},
                                  {10, translation({x_after_10_seconds, 0, 0})}});
}

TEST(Animation, CoresComeToTheTimeOfTheirGraph) {
    SceneGraph graph;
    graph.root().set_core(grey("grey"));
    Node &node = add_node(graph.root(), "node");
    node.set_core(right_triangle());
    graph.update(5);
    node.set_core(sliding(10));
    graph.update(5);
    EXPECT_EQ(graph.arrays().meshes.position[0], Vector3f(5, 0, 0));
    graph.update(6);
    EXPECT_EQ(graph.arrays().meshes.position[0], Vector3f(6, 0, 0));
    node.remove_core(CoreRole::transform);
    graph.update(7);
    EXPECT_EQ(graph.arrays().meshes.position[0], Vector3f(0, 0, 0));
}

/// Returns the median time in seconds of a step of a scene in which one of `nodes` nodes moves.
double step_seconds(int nodes) {
    SceneGraph graph;
    graph.root().set_core(grey("grey"));
    const auto triangle = right_triangle();
    const auto ball = shape("sphere");
    for (int i = 0; i < nodes; ++i) {
        Node &node = add_node(graph.root(), std::to_string(i));
        node.set_core(i % 2 == 0 ? std::static_pointer_cast<Core>(triangle) : ball);
        node.set_core(moved(2.0 * i, 0, 0));
        if (i % 3 == 0) {
            node.set_core(area_light(Vector3d(1, 1, 1)));
        }
    }
    Node &moving = *graph.find(std::to_string(nodes / 6 * 6));  // an emissive triangle
    moving.set_core(sliding(1000));
    graph.update(0);
    expect_consistent(graph);
    std::vector<double> seconds;
    for (int i = 1; i <= 501; ++i) {
        const auto start = std::chrono::steady_clock::now();
        graph.update(0.01 * i);
        seconds.push_back(
            std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count());
        EXPECT_EQ(graph.visited_nodes(), 1u);
        EXPECT_EQ(graph.mesh_counts().written, 1u);
        EXPECT_EQ(graph.light_counts().written, 1u);
        EXPECT_EQ(graph.shape_counts().written + graph.material_counts().written +
                      graph.camera_counts().written,
                  0u);
    }
    std::nth_element(seconds.begin(), seconds.begin() + 250, seconds.end());
    return seconds[250];
}

TEST(Animation, TheCostOfAStepDoesNotDependOnTheRest) {
    const double small = step_seconds(1000);
    const double large = step_seconds(100000);
    RecordProperty("step_1000_nodes_ns", static_cast<int>(small * 1e9));
    RecordProperty("step_100000_nodes_ns", static_cast<int>(large * 1e9));
    std::printf("one node moved: %.2f us among 1e3, %.2f us among 1e5\n", small * 1e6, large * 1e6);
    // A walk over the graph would take about 100 times as long. Caches account for a small factor.
    EXPECT_LT(large, 10 * small + 5e-6);
}

}  // namespace
}  // namespace rtrays
