// SPDX-License-Identifier: MIT
// Tests nodes, cores, attributes and properties of the scene graph.
#include <cmath>

#include "renderer/testing/scene_builder.h"

namespace rtrays {
namespace {

using Eigen::Vector3d;
using Eigen::Vector3f;

TEST(Attributes, AccumulateByTypeAndLeaveSiblingsAlone) {
    SceneGraph graph;
    Node &parent = add_node(graph.root(), "parent");
    Node &first = add_node(parent, "first");
    Node &second = add_node(parent, "second");
    const auto red = grey("red");
    const auto blue = grey("blue");
    parent.set_core(std::make_shared<TransformCore>("", scaling({2, 2, 2})));
    parent.set_core(red);
    first.set_core(moved(1, 0, 0));
    first.set_core(blue);
    second.set_core(std::make_shared<VisibilityCore>("", false));
    Node &below = add_node(second, "below");
    below.set_core(std::make_shared<VisibilityCore>("", true));
    graph.update(0);

    // Transforms multiply, so the parent scales the child's translation.
    const auto transform = [](const Node &node) {
        return node.attributes().get<TransformAttribute>().world_from_object;
    };
    EXPECT_EQ(transform(first), scaling({2, 2, 2}) * translation({1, 0, 0}));
    EXPECT_EQ(transform(second), scaling({2, 2, 2}));
    EXPECT_EQ(transform(graph.root()), Eigen::Matrix4d::Identity());
    // A child's material replaces that of its parent.
    EXPECT_EQ(first.attributes().get<MaterialAttribute>().material, blue.get());
    EXPECT_EQ(second.attributes().get<MaterialAttribute>().material, red.get());
    EXPECT_EQ(graph.root().attributes().get<MaterialAttribute>().material, nullptr);
    // Visibility is a logical AND.
    EXPECT_TRUE(first.attributes().get<VisibilityAttribute>().visible);
    EXPECT_FALSE(second.attributes().get<VisibilityAttribute>().visible);
    EXPECT_FALSE(below.attributes().get<VisibilityAttribute>().visible);
}

TEST(Attributes, ARemovedCoreNoLongerCounts) {
    SceneGraph graph;
    Node &parent = add_node(graph.root(), "parent");
    Node &child = add_node(parent, "child");
    parent.set_core(moved(1, 2, 3));
    graph.update(0);
    parent.remove_core(CoreRole::transform);
    graph.update(0);
    EXPECT_EQ(child.attributes().get<TransformAttribute>().world_from_object,
              Eigen::Matrix4d::Identity());
}

TEST(Attributes, DefaultCloneAndMergeAreThoseOfTheThesis) {
    TransformAttribute scale;
    scale.world_from_object = scaling({2, 3, 4});
    const std::unique_ptr<NodeAttribute> copy = scale.clone();
    TransformAttribute offset;
    offset.world_from_object = translation({1, 1, 1});
    copy->merge(offset);
    EXPECT_EQ(static_cast<const TransformAttribute &>(*copy).world_from_object,
              scaling({2, 3, 4}) * translation({1, 1, 1}));
    EXPECT_EQ(scale.world_from_object, scaling({2, 3, 4}));
    EXPECT_EQ(static_cast<const TransformAttribute &>(*copy->default_value()).world_from_object,
              Eigen::Matrix4d::Identity());
}

TEST(Graph, NamesAreUnique) {
    SceneGraph graph;
    Node &a = add_node(graph.root(), "a");
    expect_input_error("two nodes have the name 'a'", [&] { add_node(graph.root(), "a"); });
    auto branch = std::make_unique<Node>("b");
    add_node(*branch, "c");
    add_node(*branch, "a");
    expect_input_error("two nodes have the name 'a'", [&] { a.add_child(std::move(branch)); });
    EXPECT_EQ(graph.find("b"), nullptr) << "a refused branch must not leave names behind";
    EXPECT_EQ(graph.find("a"), &a);
    graph.root().remove_child(a);
    EXPECT_EQ(graph.find("a"), nullptr);
    EXPECT_NO_THROW(add_node(graph.root(), "a"));
}

TEST(Graph, ABranchCanBeTakenOutAndPutBackElsewhere) {
    SceneGraph graph;
    graph.root().set_core(grey("grey"));
    Node &left = add_node(graph.root(), "left");
    Node &right = add_node(graph.root(), "right");
    right.set_core(moved(5, 0, 0));
    Node &leaf = add_node(left, "leaf");
    leaf.set_core(right_triangle());
    graph.update(0);
    std::unique_ptr<Node> taken = left.remove_child(leaf);
    graph.update(0);
    EXPECT_TRUE(graph.arrays().meshes.name.empty());
    leaf.set_core(right_triangle("other"));  // edits outside a graph are allowed
    right.add_child(std::move(taken));
    graph.update(0);
    ASSERT_EQ(graph.arrays().meshes.name.size(), 1u);
    EXPECT_EQ(graph.arrays().meshes.position[0], Vector3f(5, 0, 0));
    expect_consistent(graph);
}

TEST(Graph, DepthIsNotLimitedByTheCallStack) {
    SceneGraph graph;
    Node *node = &graph.root();
    constexpr int depth = 200000;
    for (int i = 0; i < depth; ++i) {
        node = &add_node(*node, "");
    }
    node->set_core(grey("grey"));
    node->set_core(right_triangle());
    graph.root().set_core(moved(0, 0, 7));
    graph.update(0);
    EXPECT_EQ(graph.arrays().meshes.position[0], Vector3f(0, 0, 7));
}

TEST(Transform, LookAtPointsMinusZAtTheTarget) {
    const Eigen::Matrix4d pose = look_at({1, 2, 3}, {1, 2, 13}, {0, 5, 0});
    Eigen::Matrix4d expected;
    expected << -1, 0, 0, 1, 0, 1, 0, 2, 0, 0, -1, 3, 0, 0, 0, 1;
    EXPECT_TRUE(pose.isApprox(expected, 1e-15)) << pose;
    expect_input_error("look_at: origin and target", [] {
        look_at({1, 2, 3}, {1, 2, 3}, {0, 1, 0});
    });
    expect_input_error("look_at: up must not be parallel", [] {
        look_at({0, 0, 0}, {0, 1e-3, 0}, {0, 9, 0});
    });
    expect_input_error("look_at: up has no direction", [] {
        look_at({0, 0, 0}, {0, 0, 1}, {0, 0, 0});
    });
}

TEST(Transform, RefusesWhatCannotBeInverted) {
    const double inf = std::numeric_limits<double>::infinity();
    const auto core = [](const Eigen::Matrix4d &m) { return TransformCore("", m); };
    expect_input_error("not invertible", [&] { core(scaling({1, 0, 1})); });
    Eigen::Matrix4d sheared = Eigen::Matrix4d::Identity();
    sheared.col(1) = sheared.col(0);
    expect_input_error("not invertible", [&] { core(sheared); });
    expect_input_error("not finite", [&] { core(translation({inf, 0, 0})); });
    expect_input_error("not finite", [&] { core(scaling({std::nan(""), 1, 1})); });
    Eigen::Matrix4d projective = Eigen::Matrix4d::Identity();
    projective(3, 2) = 1;
    expect_input_error("not affine", [&] { core(projective); });
    EXPECT_NO_THROW(core(scaling({1e-200, 1e200, -1})));
}

TEST(Properties, AreListedReadAndSetByName) {
    SceneGraph graph;
    Node &lamp = add_node(graph.root(), "lamp");
    const auto camera = pinhole(40, "smaller");
    const auto light = area_light(Vector3d(1, 2, 3));
    const auto material = grey("white");
    lamp.set_core(camera);
    lamp.set_core(light);
    lamp.set_core(material);
    lamp.set_core(unit_square());
    lamp.set_core(moved(1, 2, 3));
    lamp.set_core(std::make_shared<VisibilityCore>("", true));
    graph.share("materials.white", material);

    graph.set_property("lamp.radiance", "4,5,6");
    EXPECT_EQ(light->radiance(), Vector3d(4, 5, 6));
    graph.set_property("lamp.radiance", "[7, 8, 9e0]");
    EXPECT_EQ(light->radiance(), Vector3d(7, 8, 9));
    graph.set_property("materials.white.reflectance", "0.1,0.2,0.3");
    EXPECT_EQ(material->parameters().vector3("reflectance"), Vector3d(0.1, 0.2, 0.3));
    graph.set_property("lamp.fov", "0.5");
    EXPECT_EQ(camera->parameters().number("fov"), 0.5);
    graph.set_property("lamp.fov_axis", "y");
    EXPECT_EQ(camera->parameters().choice<FovAxis>("fov_axis"), FovAxis::y);
    graph.set_property("lamp.visible", "false");
    graph.set_property("lamp.transform", "[[1,0,0,9],[0,1,0,8],[0,0,1,7],[0,0,0,1]]");
    graph.set_property("lamp.translation", "3,2,1");
    graph.update(0);
    EXPECT_EQ(lamp.attributes().get<TransformAttribute>().world_from_object,
              translation({3, 2, 1}));
    EXPECT_FALSE(lamp.attributes().get<VisibilityAttribute>().visible);

    graph.set_property("lamp.radiance", "0.3");
    EXPECT_EQ(light->radiance(), Vector3d(0.3, 0.3, 0.3));

    std::map<std::string, std::string> properties;
    std::vector<std::string> uses;
    graph.visit_properties(
        [&](const std::string &owner, const Property &property) {
            const bool is_new =
                properties.emplace(owner + "." + property.name, property.text()).second;
            EXPECT_TRUE(is_new) << owner << "." << property.name << " is listed twice";
        },
        [&](const std::string &of, const std::string &shared) {
            uses.push_back(of + " " + shared);
        });
    EXPECT_EQ(properties.at("lamp.radiance"), "[0.3, 0.3, 0.3]");
    EXPECT_EQ(properties.at("materials.white.reflectance"), "[0.1, 0.2, 0.3]");
    EXPECT_EQ(properties.at("lamp.fov_axis"), "y");
    EXPECT_EQ(properties.at("lamp.visible"), "false");
    EXPECT_EQ(properties.at("lamp.triangles"), "2");
    EXPECT_EQ(properties.count("lamp.reflectance"), 0u) << "of a shared material";
    EXPECT_EQ(uses, std::vector<std::string>{"lamp materials.white"});
}

TEST(Properties, FloatsAreWrittenWithTheirOwnDigits) {
    EXPECT_EQ(property_text(static_cast<double>(0.6f)), "0.6");
    EXPECT_EQ(property_text(0.6), "0.6");
    EXPECT_EQ(property_text(0.1234567890123), "0.1234567890123");
    EXPECT_EQ(property_text(Eigen::Vector3d(0.25, static_cast<double>(1e-20f), -3)),
              "[0.25, 1e-20, -3]");
}

TEST(Properties, ErrorsNameAddressAndAlternatives) {
    SceneGraph graph;
    Node &node = add_node(graph.root(), "box");
    node.set_core(grey("white"));
    node.set_core(unit_square());
    node.set_core(pinhole(40, "x"));
    node.set_core(std::make_shared<VisibilityCore>("", true));
    node.set_core(moved(0, 0, 0));
    graph.share("materials.white", grey("white"));
    const auto set = [&](const char *address, const char *text) {
        return [&graph, address, text] { graph.set_property(address, text); };
    };
    expect_input_error(
        "'lamp.fov': unknown node or shared object 'lamp'; the scene has: box, materials.white",
        set("lamp.fov", "1"));
    expect_input_error(
        "'box.size': 'box' has no property 'size'; properties are: bump_map, emission, fov, "
        "fov_axis, map_follows_v, map_mirrored_back, map_shadowing, normal_map, opacity, "
        "opacity_cutoff, "
        "reflectance, ",
        set("box.size", "1"));
    expect_input_error("expected NODE.PROPERTY", set("fov", "1"));
    expect_input_error("'box.fov': 'wide' is not a value of type number", set("box.fov", "wide"));
    for (const char *text : {"", "1,2", "1 2", "nan", "1e999", "[1", "true"}) {
        expect_input_error("is not a value of type number", set("box.fov", text));
    }
    for (const char *fov : {"0", "180", "-1", "1e308"}) {
        expect_input_error("is not within (0, 180) (full angle of view along fov_axis, degrees)",
                           set("box.fov", fov));
    }
    expect_input_error("'box.fov_axis': 'z' is not one of: x, y, smaller, larger",
                       set("box.fov_axis", "z"));
    expect_input_error("is not a value of type three numbers", set("box.reflectance", "1,2"));
    expect_input_error("is not within [0, 1]", set("box.reflectance", "0,0,1.0000001"));
    expect_input_error("is not a value of type boolean", set("box.visible", "1"));
    expect_input_error("'box.vertices': the property is read-only", set("box.vertices", "3"));
    expect_input_error("not invertible", set("box.transform", "0,0,0,0,0,1,0,0,0,0,1,0,0,0,0,1"));
}

TEST(Cores, RefuseValuesOutOfRange) {
    const double nan = std::nan("");
    expect_input_error("reflectance", [&] { grey("", nan); });
    expect_input_error("reflectance", [&] { grey("", -1e-9); });
    expect_input_error("radiance", [&] { area_light(Vector3d(0, nan, 0)); });
    expect_input_error("radiance", [&] { area_light(Vector3d(0, 1e39, 0)); });
    expect_input_error("radiance", [&] { area_light(Vector3d(0, 0, -1)); });
    expect_input_error("mesh 'm': vertex 2 is not finite", [&] {
        MeshCore("m", {{0, 0, 0}, {1, 0, 0}, {0, nan, 0}}, {{0, 1, 2}});
    });
    expect_input_error("mesh 'm': triangle 1 refers to vertex 3, but there are only 3 vertices",
                       [&] {
                           MeshCore("m", {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}, {{0, 1, 2}, {0, 1, 3}});
                       });
    expect_input_error("mesh 'm' has no triangle", [&] { MeshCore("m", {{0, 0, 0}}, {}); });
}

}  // namespace
}  // namespace rtrays
