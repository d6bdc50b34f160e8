// SPDX-License-Identifier: MIT
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <vector>

#include "renderer/scene/stores.h"

namespace rtrays {

/// Splits a simple polygon (in the order of its corners, nearly planar) into `corners.size() - 2`
/// triangles of the same orientation: a fan from the first corner when it is convex, ears
/// otherwise. A polygon without area becomes a fan of triangles without area. Throws `Error` (bad
/// input) when it crosses itself, has fewer than three corners or an index is out of range.
std::vector<Triangle> triangulate(const std::vector<Eigen::Vector3d> &vertices,
                                  const std::vector<uint32_t> &corners);

}  // namespace rtrays
