// SPDX-License-Identifier: MIT
#include "renderer/import/scene_options.h"

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <Eigen/Geometry>
#include <charconv>
#include <memory>

#include "renderer/base/error.h"
#include "renderer/base/option_checks.h"
#include "renderer/import/images/texture_file.h"
#include "renderer/import/load_scene.h"
#include "renderer/scene/cores/camera.h"
#include "renderer/scene/cores/light.h"
#include "renderer/scene/cores/transform.h"
#include "renderer/scene/cores/visibility.h"
#include "renderer/scene/graph.h"

namespace rtrays {

namespace {

/// Parses "X,Y,Z".
Eigen::Vector3d parse_point(const std::string &text) {
    Eigen::Vector3d point;
    const char *at = text.data();
    const char *const end = at + text.size();
    for (int i = 0; i < 3; ++i) {
        const auto [next, error] = std::from_chars(at, end, point[i]);
        const bool is_followed = i < 2 ? next != end && *next == ',' : next == end;
        if (error != std::errc() || !is_followed) {
            throw input_error(
                fmt::format("--look-at '{}': expected X,Y,Z, as in --look-at 4,3,6 0,1,0", text));
        }
        at = next + 1;
    }
    return point;
}

/// Returns the axis nearest to `up`, with its sign, that is not along `direction`.
Eigen::Vector3d upright_axis(const Eigen::Vector3d &up, const Eigen::Vector3d &direction) {
    constexpr double along = 0.999;  // cosine
    Eigen::Vector3d found = Eigen::Vector3d::UnitY();
    double nearest = -1;
    for (int i = 0; i < 3; ++i) {
        const bool is_along = std::abs(direction[i]) > along * direction.norm();
        if (std::abs(up[i]) > nearest && !is_along) {
            nearest = std::abs(up[i]);
            found = std::copysign(1.0, up[i]) * Eigen::Vector3d::Unit(i);
        }
    }
    return found;
}

Node &camera_node(Scene &scene) {
    const std::string name = scene.cameras().name.at(static_cast<size_t>(scene.active_camera()));
    Node *node = scene.graph().find(name);
    if (node == nullptr || node->parent() == nullptr) {
        throw input_error("the camera has no name, by which its node would be found");
    }
    return *node;
}

void look_from(Node &camera, const Eigen::Vector3d &eye, const Eigen::Vector3d &target) {
    const Eigen::Matrix4d &world = camera.attributes().get<TransformAttribute>().world_from_object;
    const Eigen::Matrix4d &parent =
        camera.parent()->attributes().get<TransformAttribute>().world_from_object;
    const Eigen::Vector3d up = upright_axis(world.block<3, 1>(0, 1), target - eye);
    try {
        camera.set_core(std::make_shared<TransformCore>(
            camera.name(), parent.inverse() * look_at(eye, target, up)));
    } catch (const Error &error) {
        throw input_error(fmt::format("--look-at: {}", error.what()));
    }
}

void set_fov(Node &camera, double degrees) {
    try {
        camera.core_of<CameraCore>(CoreRole::camera)->set("fov", degrees);
    } catch (const Error &error) {
        throw input_error(fmt::format("--fov: {}", error.what()));
    }
}

/// Gives the scene an environment, on the node "environment".
void set_environment(Scene &scene, const std::string &file) {
    using Kind = LightArrays::Kind;
    std::shared_ptr<LightCore> light;
    try {
        TextureFiles files;
        light = std::make_shared<LightCore>(
            "environment", files.load(file, TextureEncoding::linear), ParameterValues{});
    } catch (const Error &error) {
        throw input_error(fmt::format("--environment: {}", error.what()));
    }
    visit_subtree(scene.graph().root(), [](Node &node) {
        const auto *old = node.core_of<LightCore>(CoreRole::light);
        if (old != nullptr && (old->kind() == Kind::dome || old->kind() == Kind::environment)) {
            node.remove_core(CoreRole::light);
        }
    });
    Node *node = scene.graph().find(light->name());
    if (node == nullptr) {
        node = &scene.graph().root().add_child(std::make_unique<Node>(light->name()));
        node->set_core(std::make_shared<TransformCore>(light->name(), Eigen::Matrix4d::Identity()));
        node->set_core(std::make_shared<VisibilityCore>(light->name(), true));
    }
    node->set_core(light);
}

}  // namespace

void add_scene_options(CLI::App &app, SceneOptions &options) {
    app.add_option("--at", options.time, "scene time in seconds")->capture_default_str();
    app.add_option("--look-at", options.look_at,
                   "view of the camera: eye and target, each X,Y,Z in the scene's coordinates")
        ->expected(2)
        ->allow_extra_args(false);
    app.add_option("--fov", options.fov,
                   "angle of view in degrees, on the axis that the camera names")
        ->check(number_between(0.0, 180.0));
    app.add_option("--environment", options.environment,
                   "image (.hdr, .exr) that lights the scene from infinity, instead of its own")
        ->check(CLI::ExistingFile);
    app.add_option("--define", options.defines,
                   "value of a <default> parameter of a Mitsuba scene: NAME=VALUE; may be repeated")
        ->allow_extra_args(false);
}

bool set_scene_property(Scene &scene, const std::string &assignment) {
    const std::string prefix = "scene.";
    if (assignment.rfind(prefix, 0) != 0) {
        return false;
    }
    const size_t equals = assignment.find('=');
    if (equals == std::string::npos) {
        throw input_error(fmt::format("--set {}: expected NAME=VALUE", assignment));
    }
    scene.set_property(assignment.substr(prefix.size(), equals - prefix.size()),
                       assignment.substr(equals + 1));
    return true;
}

Scene load_scene(const std::string &path, bool quiet, const SceneOptions &options) {
    Scene scene = load_scene(path, quiet, parse_defines(options.defines));
    if (!options.environment.empty()) {
        set_environment(scene, options.environment);
    }
    return scene;
}

void change_view(Scene &scene, const SceneOptions &options) {
    scene.update(options.time);
    if (!options.look_at.empty()) {
        look_from(camera_node(scene), parse_point(options.look_at.at(0)),
                  parse_point(options.look_at.at(1)));
    }
    if (options.fov) {
        set_fov(camera_node(scene), *options.fov);
    }
    scene.update(options.time);
}

}  // namespace rtrays
