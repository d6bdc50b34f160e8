// SPDX-License-Identifier: MIT
// Triangulation of polygons.
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <vector>

#include "renderer/scene/stores.h"

namespace rtrays {

/// Splits a simple, nearly planar polygon into `corners.size() - 2` triangles of the same
/// orientation. A convex polygon becomes a fan from its first corner, any other is split by ear
/// clipping. A polygon of zero area becomes a fan of triangles of zero area. Throws `Error` (bad
/// input) if the polygon crosses itself, has fewer than three corners, or has an invalid index.
std::vector<Triangle> triangulate(const std::vector<Eigen::Vector3d> &vertices,
                                  const std::vector<uint32_t> &corners);

}  // namespace rtrays
