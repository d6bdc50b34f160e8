// SPDX-License-Identifier: MIT
#include "renderer/scene/cores/morphed_mesh.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "renderer/base/error.h"

namespace rtrays {

namespace {

/// Returns the mesh of the first keyframe, the initial value of the base class.
MeshCore::Geometry first_mesh(const std::string &name, const std::vector<MorphedMesh::Key> &keys) {
    if (keys.empty()) {
        throw input_error(fmt::format("mesh '{}': there are no keyframes; add at least one", name));
    }
    return keys.front().geometry;
}

std::vector<Eigen::Vector3d> interpolate(const std::vector<Eigen::Vector3d> &a,
                                         const std::vector<Eigen::Vector3d> &b, double weight) {
    std::vector<Eigen::Vector3d> between(a.size());
    std::transform(a.begin(), a.end(), b.begin(), between.begin(),
                   [&](const Eigen::Vector3d &x, const Eigen::Vector3d &y) {
                       return Eigen::Vector3d((1 - weight) * x + weight * y);
                   });
    return between;
}

/// Interpolates unit vectors. Where two are opposite, returns that of the nearer keyframe.
std::vector<Eigen::Vector3d> interpolate_normals(const std::vector<Eigen::Vector3d> &a,
                                                 const std::vector<Eigen::Vector3d> &b,
                                                 double weight) {
    std::vector<Eigen::Vector3d> between = interpolate(a, b, weight);
    for (size_t i = 0; i < between.size(); ++i) {
        // The direction of a shorter vector is determined by rounding.
        constexpr double opposite = 1e-9;
        between[i] = between[i].norm() > opposite ? between[i].normalized()
                     : weight < 0.5               ? a[i]
                                                  : b[i];
    }
    return between;
}

}  // namespace

MorphedMesh::MorphedMesh(std::string name, std::vector<Key> keys)
    : MeshCore(name, first_mesh(name, keys)) {
    const auto fail = [&](size_t index, const std::string &what) {
        throw input_error(fmt::format("mesh '{}': keyframe {} {}", name, index, what));
    };
    for (size_t i = 0; i < keys.size(); ++i) {
        if (!std::isfinite(keys[i].time)) {
            fail(i, "has no finite time");
        }
        if (i > 0 && !(keys[i].time > keys[i - 1].time)) {
            fail(i, fmt::format("is at {} s, but must be later than the previous one at {} s",
                                keys[i].time, keys[i - 1].time));
        }
        MeshCore checked(fmt::format("{}, keyframe {}", name, i), std::move(keys[i].geometry));
        if (checked.vertices().size() != vertices().size() ||
            checked.normals().size() != normals().size()) {
            fail(i,
                 fmt::format("has {} vertices and {} normals, but the first keyframe has {} and {}",
                             checked.vertices().size(), checked.normals().size(), vertices().size(),
                             normals().size()));
        }
        if (checked.triangles() != triangles()) {
            fail(i, "must have the same triangles as the first keyframe");
        }
        keys_.push_back({keys[i].time, checked.vertices(), checked.normals()});
    }
    time_ = keys_.front().time;
    update(0);
}

void MorphedMesh::update(double time) {
    const double held = std::clamp(time, keys_.front().time, keys_.back().time);
    if (held == time_) {
        return;
    }
    time_ = held;
    const auto after = std::upper_bound(keys_.begin() + 1, keys_.end() - 1, held,
                                        [](double t, const Vertices &key) { return t < key.time; });
    const Vertices &a = *(after - 1), &b = *after;
    const double weight = (held - a.time) / (b.time - a.time);
    if (weight == 0 || weight == 1) {
        set_vertices(weight == 0 ? a.positions : b.positions, weight == 0 ? a.normals : b.normals);
    } else {
        set_vertices(interpolate(a.positions, b.positions, weight),
                     interpolate_normals(a.normals, b.normals, weight));
    }
}

}  // namespace rtrays
