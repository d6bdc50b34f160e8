// SPDX-License-Identifier: MIT
#include "renderer/scene/cores/animated_transform.h"

#include <fmt/format.h>

#include <Eigen/SVD>
#include <algorithm>
#include <cmath>
#include <utility>

#include "renderer/base/error.h"

namespace rtrays {

namespace {

/// Returns the matrix of the first keyframe, the initial value of the base class.
const Eigen::Matrix4d &first_matrix(const std::vector<Keyframe> &keyframes) {
    if (keyframes.empty()) {
        throw input_error("animation: there are no keyframes; add at least one");
    }
    return keyframes.front().parent_from_object;
}

/// Makes the error of one keyframe.
Error keyframe_error(size_t index, const std::string &what) {
    return input_error(fmt::format("animation: keyframe {} {}", index, what));
}

}  // namespace

AnimatedTransform::AnimatedTransform(std::string name, const std::vector<Keyframe> &keyframes)
    : TransformCore(std::move(name), first_matrix(keyframes)) {
    // Quaternions of rotations half a turn apart are orthogonal. Below this dot product, rounding
    // would determine the arc.
    constexpr double half_turn = 1e-9;
    for (size_t i = 0; i < keyframes.size(); ++i) {
        const TransformCore checked("", keyframes[i].parent_from_object);
        const Eigen::Matrix3d linear = checked.matrix().topLeftCorner<3, 3>();
        const Eigen::JacobiSVD<Eigen::Matrix3d> svd(linear,
                                                    Eigen::ComputeFullU | Eigen::ComputeFullV);
        // M = (U V^T) (V S V^T). If M mirrors, both factors change sign, so that the first is a
        // rotation.
        const double sign = linear.determinant() < 0 ? -1 : 1;
        const Eigen::Matrix3d rotation = sign * svd.matrixU() * svd.matrixV().transpose();
        const Eigen::Matrix3d stretch =
            sign * svd.matrixV() * svd.singularValues().asDiagonal() * svd.matrixV().transpose();
        const Key key{keyframes[i].time, checked.matrix(),
                      Eigen::Quaterniond(rotation).normalized(), stretch};
        if (!std::isfinite(key.time)) {
            throw keyframe_error(i, "has no finite time");
        }
        if (i > 0) {
            const Key &before = keys_.back();
            if (!(key.time > before.time)) {
                throw keyframe_error(
                    i, fmt::format("is at {} s, but must be later than the previous one at {} s",
                                   key.time, before.time));
            }
            if ((key.stretch.trace() < 0) != (before.stretch.trace() < 0)) {
                throw keyframe_error(i,
                                     "and the previous one must both mirror or both not mirror; in "
                                     "between the object would vanish");
            }
            if (std::abs(key.rotation.dot(before.rotation)) < half_turn) {
                throw keyframe_error(
                    i,
                    "is half a turn from the previous one; add a keyframe between them to define "
                    "the direction of the turn");
            }
        }
        keys_.push_back(key);
    }
    update(0);
}

Eigen::Matrix4d AnimatedTransform::matrix_at(double time) const {
    const auto after = std::upper_bound(keys_.begin(), keys_.end(), time,
                                        [](double t, const Key &key) { return t < key.time; });
    if (after == keys_.begin()) {
        return keys_.front().matrix;
    }
    const Key &from = *(after - 1);
    if (after == keys_.end() || time == from.time) {
        return from.matrix;
    }
    const double s = (time - from.time) / (after->time - from.time);
    Eigen::Matrix4d matrix = Eigen::Matrix4d::Identity();
    // The stretches are both positive or both negative definite, and so is their interpolation:
    // the matrix is invertible.
    matrix.topLeftCorner<3, 3>() = from.rotation.slerp(s, after->rotation).toRotationMatrix() *
                                   ((1 - s) * from.stretch + s * after->stretch);
    matrix.topRightCorner<3, 1>() =
        (1 - s) * from.matrix.topRightCorner<3, 1>() + s * after->matrix.topRightCorner<3, 1>();
    return matrix;
}

void AnimatedTransform::update(double time) {
    const Eigen::Matrix4d now = matrix_at(time);
    if (now != matrix()) {
        set_matrix(now);
    }
}

std::vector<Property> AnimatedTransform::properties() {
    std::vector<Property> all = TransformCore::properties();
    for (Property &property : all) {
        property.help += ", animated";
        property.set = {};
    }
    return all;
}

}  // namespace rtrays
