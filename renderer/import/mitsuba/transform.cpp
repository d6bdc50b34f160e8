// SPDX-License-Identifier: MIT
// Parser of "transform" elements of Mitsuba scenes.
#include <fmt/format.h>

#include <Eigen/Geometry>
#include <cmath>

#include "renderer/base/angles.h"
#include "renderer/import/mitsuba/object.h"
#include "renderer/scene/cores/transform.h"

namespace rtrays::mitsuba {

namespace {

using Eigen::Matrix4d;
using Eigen::Vector3d;

double one_number(const Element &element, const char *attribute, double initial) {
    if (!element.has(attribute)) {
        return initial;
    }
    const std::vector<double> numbers = parse_numbers(element, element.attribute(attribute));
    if (numbers.size() != 1) {
        throw element.error(fmt::format("{}: expected one number", attribute));
    }
    return numbers[0];
}

Vector3d three_numbers(const Element &element, const char *attribute) {
    const std::vector<double> numbers = parse_numbers(element, element.attribute(attribute));
    if (numbers.size() != 3) {
        throw element.error(fmt::format("{}: expected three numbers", attribute));
    }
    return {numbers[0], numbers[1], numbers[2]};
}

/// Parses value="1", value="1, 2, 3", or the attributes x, y and z.
Vector3d coordinates(const Element &element, double initial) {
    if (!element.has("value")) {
        return {one_number(element, "x", initial), one_number(element, "y", initial),
                one_number(element, "z", initial)};
    }
    if (element.has("x") || element.has("y") || element.has("z")) {
        throw element.error("has both 'value' and x, y or z; give one");
    }
    const std::vector<double> numbers = parse_numbers(element, element.attribute("value"));
    if (numbers.size() == 1) {
        return Vector3d::Constant(numbers[0]);
    }
    return three_numbers(element, "value");
}

Matrix4d rotate(const Element &element) {
    element.check_attributes({"x", "y", "z", "value", "angle"});
    const Vector3d axis = coordinates(element, 0);
    // Mitsuba does not normalise the axis, so an axis of another length gives no rotation.
    if (std::abs(axis.norm() - 1) > 1e-4) {
        throw element.error(fmt::format("the axis must have length 1, not {:.6g}", axis.norm()));
    }
    if (!element.has("angle")) {
        throw element.error("needs an angle in degrees");
    }
    return rotation(axis, one_number(element, "angle", 0) * degree);
}

Matrix4d matrix(const Element &element) {
    element.check_attributes({"value"});
    const std::vector<double> numbers = parse_numbers(element, element.attribute("value"));
    Matrix4d result = Matrix4d::Identity();
    if (numbers.size() == 16) {
        result = Eigen::Map<const Eigen::Matrix<double, 4, 4, Eigen::RowMajor>>(numbers.data());
    } else if (numbers.size() == 9) {
        result.topLeftCorner<3, 3>() =
            Eigen::Map<const Eigen::Matrix<double, 3, 3, Eigen::RowMajor>>(numbers.data());
    } else {
        throw element.error(
            fmt::format("has {} numbers; expected 16 or 9, row by row", numbers.size()));
    }
    return result;
}

/// Parses a "lookat" element. Mitsuba's objects look along +z with +x to the left. Ours look along
/// -z with +x to the right. Without `up`, Mitsuba takes an axis of a frame around the direction.
Matrix4d look_at_element(const Element &element) {
    element.check_attributes({"origin", "target", "up"});
    const Vector3d origin = three_numbers(element, "origin");
    const Vector3d target = three_numbers(element, "target");
    Vector3d up =
        element.attribute("up").empty() ? Vector3d(Vector3d::Zero()) : three_numbers(element, "up");
    if (up.isZero(0) && (target - origin).stableNorm() > 0) {
        up = frame_around((target - origin).stableNormalized()).col(0);
    }
    return look_at(origin, target, up) * scaling({-1, 1, -1});
}

Matrix4d operation(const Element &element) {
    const std::string tag = element.tag();
    if (!element.children().empty()) {
        throw element.error("a transform operation must not contain elements");
    }
    if (tag == "translate" || tag == "scale") {
        element.check_attributes({"x", "y", "z", "value"});
        return tag == "scale" ? scaling(coordinates(element, 1))
                              : translation(coordinates(element, 0));
    }
    if (tag == "rotate") {
        return rotate(element);
    }
    if (tag == "matrix") {
        return matrix(element);
    }
    if (tag == "lookat" || (tag == "lookAt" && element.is_old())) {
        return look_at_element(element);
    }
    throw element.error(
        "unknown transform; transforms are: translate, rotate, scale, matrix, lookat");
}

}  // namespace

Eigen::Matrix3d frame_around(const Vector3d &n) {
    const double sign = std::copysign(1.0, n.z());
    const double a = -1 / (sign + n.z());  // |sign + z| >= 1
    const double b = n.x() * n.y() * a;
    Eigen::Matrix3d frame;
    frame.col(0) = Vector3d(sign * n.x() * n.x() * a + 1, sign * b, -sign * n.x());
    frame.col(1) = Vector3d(b, n.y() * n.y() * a + sign, -n.y());
    frame.col(2) = n;
    return frame;
}

Matrix4d nearest_similarity(const Matrix4d &transform, const std::string &what) {
    constexpr double tolerance = 1e-4;
    constexpr double exact = 1e-12;
    const Eigen::Matrix3d axes = transform.topLeftCorner<3, 3>();
    const double scale = axes.col(0).stableNorm();  // above zero: transforms are invertible
    const Eigen::Matrix3d unit = axes / scale;
    const double error =
        (unit.transpose() * unit - Eigen::Matrix3d::Identity()).cwiseAbs().maxCoeff();
    if (error > 2 * tolerance) {
        const Vector3d scales = axes.colwise().stableNorm();
        throw input_error(fmt::format(
            "{} cannot be sheared or stretched; the transform scales its axes by {:.6g}, "
            "{:.6g} and {:.6g}",
            what, scales[0], scales[1], scales[2]));
    }
    if (error < exact) {
        return transform;
    }
    const double sign = unit.determinant() < 0 ? -1 : 1;
    Matrix4d similarity = transform;
    similarity.topLeftCorner<3, 3>() =
        sign * scale *
        Eigen::Quaterniond(Eigen::Matrix3d(sign * unit)).normalized().toRotationMatrix();
    return similarity;
}

Matrix4d parse_transform(const Element &element) {
    element.check_attributes({"name"});
    Matrix4d transform = Matrix4d::Identity();
    for (const Element &child : element.children()) {
        transform = child.located([&] {
            // Checked one by one, so that the message names the faulty operation.
            return Matrix4d(TransformCore("", operation(child)).matrix() * transform);
        });
    }
    return element.located([&] { return TransformCore("", transform).matrix(); });
}

}  // namespace rtrays::mitsuba
