// SPDX-License-Identifier: MIT
#include "renderer/import/json/transform.h"

#include <fmt/format.h>

#include <vector>

#include "renderer/base/angles.h"
#include "renderer/scene/cores/animated_transform.h"

namespace rtrays {

namespace {

Eigen::Matrix4d operation(const Json &value) {
    const std::string name = value.begin().key();
    const Json &argument = value.begin().value();
    if (name == "translate") {
        return translation(vector3(argument));
    }
    if (name == "scale") {
        return scaling(vector3(argument));
    }
    if (name == "rotate") {
        return rotation(vector3(argument.at("axis")),
                        argument.at("degrees").get<double>() * degree);
    }
    if (name == "look_at") {
        return look_at(vector3(argument.at("origin")), vector3(argument.at("target")),
                       vector3(argument.at("up")));
    }
    Eigen::Matrix4d matrix;  // the only other operation that the schema permits
    for (int row = 0; row < 4; ++row) {
        for (int column = 0; column < 4; ++column) {
            matrix(row, column) = argument[row][column];
        }
    }
    return matrix;
}

/// Returns the product of a list of operations, the first one applied first.
Eigen::Matrix4d read_operations(const Json &operations, const SceneSource &source,
                                const std::string &path) {
    Eigen::Matrix4d matrix = Eigen::Matrix4d::Identity();
    for (size_t i = 0; i < operations.size(); ++i) {
        source.located(fmt::format("{}/{}", path, i), [&] {
            // Checked one by one, so that the message names the faulty operation.
            const TransformCore checked("", operation(operations[i]));
            matrix = checked.matrix() * matrix;
        });
    }
    return matrix;
}

std::shared_ptr<TransformCore> read_animation(const Json &keyframes, const std::string &name,
                                              const SceneSource &source, const std::string &path) {
    std::vector<Keyframe> keys;
    for (size_t i = 0; i < keyframes.size(); ++i) {
        keys.push_back(
            {keyframes[i].at("time"), read_operations(keyframes[i].at("transform"), source,
                                                      fmt::format("{}/{}/transform", path, i))});
    }
    return source.located(path, [&] { return std::make_shared<AnimatedTransform>(name, keys); });
}

}  // namespace

std::shared_ptr<TransformCore> read_transform(const Json &node, const std::string &name,
                                              const SceneSource &source, const std::string &path) {
    if (node.contains("animation")) {
        if (node.contains("transform")) {
            source.located(path, [&]() -> void {
                throw input_error(fmt::format(
                    "'{}' has both a transform and an animation; move the transform to a parent or "
                    "child node",
                    name));
            });
        }
        return read_animation(node.at("animation"), name, source, path + "/animation");
    }
    const std::string at = path + "/transform";
    const Eigen::Matrix4d matrix =
        read_operations(node.value("transform", Json::array()), source, at);
    return source.located(at, [&] { return std::make_shared<TransformCore>(name, matrix); });
}

}  // namespace rtrays
