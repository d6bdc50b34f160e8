// SPDX-License-Identifier: MIT
#include "renderer/scene/cores/mesh.h"

#include <fmt/format.h>

#include <utility>

#include "renderer/base/error.h"

namespace rtrays {

MeshCore::MeshCore(std::string name, std::vector<Eigen::Vector3d> vertices, std::vector<Triangle> triangles)
    : Core(std::move(name)) {
    set_geometry(std::move(vertices), std::move(triangles));
}

void MeshCore::set_geometry(std::vector<Eigen::Vector3d> vertices, std::vector<Triangle> triangles) {
    if (triangles.empty()) {
        throw input_error(fmt::format("mesh '{}' has no triangle", name()));
    }
    for (size_t i = 0; i < vertices.size(); ++i) {
        if (!vertices[i].allFinite()) {
            throw input_error(fmt::format("mesh '{}': vertex {} is not finite: [{}, {}, {}]", name(), i,
                                          vertices[i][0], vertices[i][1], vertices[i][2]));
        }
    }
    for (size_t i = 0; i < triangles.size(); ++i) {
        for (const uint32_t index : triangles[i]) {
            if (index >= vertices.size()) {
                throw input_error(
                    fmt::format("mesh '{}': triangle {} has vertex {}, but there are only {} vertices",
                                name(), i, index, vertices.size()));
            }
        }
    }
    vertices_ = std::move(vertices);
    triangles_ = std::move(triangles);
    changed();
}

std::vector<Property> MeshCore::properties() {
    return {make_property<double>("vertices", "number of vertices",
                                  [this] { return static_cast<double>(vertices_.size()); }),
            make_property<double>("triangles", "number of triangles",
                                  [this] { return static_cast<double>(triangles_.size()); })};
}

}  // namespace rtrays
